"""Where inverse kinematics starts: a table of known postures with their tool poses."""

import math

import numpy as np
from numpy.typing import NDArray

from .ik_kernel import poses
from .ik_mask import TaskMask
from .ik_posture import short_way
from .kinematics import Chain
from .pose import FloatArray

SIZE = 4000
"""Postures in the table: it is filled in 3 ms, and the nearest of them is found in 5 µs."""
NEAR = 12
"""How many near postures are tried before others."""
_SEED = 0x1CE
"""Not a seed that somebody takes to draw targets: they would be in the table."""
_ONE = np.ones(1)


class PoseTable:
    """Postures spread evenly over the joint ranges, the home posture first.

    Args:
        chain: The arm.
        bounds: Lower and upper limits, (2, n) [rad or m]; joints without limits are spread over a turn.
        home: Home posture, (n,).

    Attributes:
        length: Metres that weigh as much as a radian: half the spread of the tool's positions.
    """

    def __init__(self, chain: Chain, bounds: FloatArray, home: FloatArray) -> None:
        lower, upper = bounds
        self._endless = ~np.isfinite(upper - lower)
        low, high = np.where(np.isfinite(lower), lower, -np.pi), np.where(np.isfinite(upper), upper, np.pi)
        # A fixed generator: the table is a property of the arm, like its limits.
        draws = np.random.default_rng(_SEED).random((SIZE, home.size))
        self._postures = np.concatenate((np.clip(home, lower, upper)[None], low + draws * (high - low)))
        self._poses = poses(chain.joints, chain.tool, self._postures)
        spread = self._poses[:, 9:] - self._poses[:, 9:].mean(axis=0)
        self.length = max(0.5 * math.sqrt(float(np.mean(np.sum(spread**2, axis=1)))), 1e-3)
        # |R - R'|² is 2 (1 - cos) summed over three axes, about 2 angle²: scaled to metres it joins the positions.
        self._scale = np.array([self.length / math.sqrt(2.0)] * 9 + [1.0] * 3)
        self._searched: dict[TaskMask, tuple[NDArray[np.intp], NDArray[np.float32]]] = {}

    def nearest(self, target: FloatArray, mask: TaskMask) -> FloatArray:
        """The posture whose tool pose is nearest to a target pose (12,) over what counts, (1, n)."""
        first = int(self._distances(target, mask).argmin())
        return self._postures[first : first + 1]

    def starts(self, target: FloatArray, mask: TaskMask, count: int, near: FloatArray | None) -> FloatArray:
        """Postures to start from, the most promising first: `NEAR` near ones, then some from all over the range.

        Args:
            target: Pose, (12,).
            mask: What counts.
            count: How many starts are wanted at most.
            near: Posture (n,) to which solutions are to be near: it orders the near ones. None orders them by distance
                from the target.

        Returns:
            Postures, (k, n).
        """
        distances = self._distances(target, mask)
        chosen = np.argpartition(distances, NEAR)[:NEAR]
        keys = distances[chosen]
        if near is not None:
            keys = np.sum(short_way(self._postures[chosen] - near, self._endless) ** 2, axis=1)
        chosen = chosen[np.argsort(keys, kind="stable")]
        others = np.setdiff1d(np.arange(min(max(count, NEAR), len(self._postures))), chosen, assume_unique=True)
        return self._postures[np.concatenate((chosen, others))[:count]]

    def _distances(self, target: FloatArray, mask: TaskMask) -> NDArray[np.float32]:
        """Half the squared distance from a target pose (12,) to every row over what counts, up to a constant, (N,)."""
        columns, table = self._searched.get(mask) or self._searchable(mask)
        query = np.concatenate((target, _ONE))[columns].astype(np.float32)
        return np.asarray(query.dot(table))

    def _searchable(self, mask: TaskMask) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
        """Which entries of a pose and a 1 are compared, (k,), and the table (k, N) to multiply; kept for next time.

        Half the squared distance of x and y is y²/2 - x y and a constant: the 1 adds y²/2. One product with a matrix in
        single precision is the fastest way to find a start.
        """
        counts = np.zeros((4, 3), dtype=bool)
        counts[3] = True
        if mask.frame == "base" or not mask.linear:
            counts[3] = [axis in mask.linear for axis in range(3)]
        if len(mask.angular) == 3:
            counts[:3, :2] = True  # two axes of the tool say where the third is
        elif len(mask.angular) == 2:
            free = 3 - sum(mask.angular)
            # Rotation matrices lie there row by row: a tool's axis is a column, an axis of the base a row.
            if mask.frame == "tool":
                counts[:3, free] = True
            else:
                counts[free] = True
        columns = np.flatnonzero(counts)
        scale = self._scale[columns, None]
        rows = scale * self._poses[:, columns].T
        table = np.concatenate((-scale * rows, 0.5 * np.sum(rows**2, axis=0, keepdims=True)))
        self._searched[mask] = np.append(columns, 12), np.ascontiguousarray(table, dtype=np.float32)
        return self._searched[mask]
