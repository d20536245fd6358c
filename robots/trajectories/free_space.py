"""Checking postures, edges and paths against a geometry that the caller knows."""

from collections.abc import Callable, Iterable
from functools import lru_cache

import numpy as np

from robots.pose import FloatArray

from .errors import MotionError

IsFree = Callable[[FloatArray], bool]
"""Whether the posture, (n,), touches nothing."""


class FreeSpace:
    """A geometry, asked in steps of no joint more than `resolution`.

    Attributes:
        resolution: Largest change of any joint between neighbouring checks [rad].
        checks: How many postures were checked so far.
    """

    def __init__(self, is_free: IsFree, resolution: float) -> None:
        """Wrap the geometry.

        Raises:
            MotionError: The resolution is not positive.
        """
        if not resolution > 0:
            raise MotionError(f"the resolution must be positive; got {resolution} rad")
        self._is_free = is_free
        self.resolution = resolution
        self.checks = 0

    def posture(self, q: FloatArray) -> bool:
        """Whether one posture is free."""
        self.checks += 1
        return bool(self._is_free(q))

    def edge(self, begin: FloatArray, end: FloatArray) -> bool:
        """Whether the straight way is free; `begin` is taken to be, `end` is checked first."""
        step = end - begin
        count = int(np.ceil(np.max(np.abs(step), initial=0.0) / self.resolution))
        return self.posture(end) and all(self.posture(begin + step * part) for part in _bisection(count))

    def path(self, points: Iterable[FloatArray]) -> bool:
        """Whether all given postures are free."""
        return all(self.posture(point) for point in points)


@lru_cache(maxsize=1024)
def _bisection(count: int) -> tuple[float, ...]:
    """1 / count, ..., (count - 1) / count, the middle first, then the quarters: what blocks is met early."""
    order, spans = [], [(0, count)]
    while spans:
        halves = []
        for low, high in spans:
            if high - low > 1:
                middle = (low + high) // 2
                order.append(middle / count)
                halves += [(low, middle), (middle, high)]
        spans = halves
    return tuple(order)
