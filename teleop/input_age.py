"""How old an input is: by the clock, and in simulated time, whichever is more."""

import math

from .drive_command import MAX_AGE

NEWER = 1e-3
"""An input is news when it is newer than the one before by this [s]; less is rounding of what was subtracted."""


class InputAge:
    """Ages of the inputs of one control loop; ask it once a control step.

    A loop that was held up makes the lost time up, and then simulates faster than the clock goes: by the clock alone, a
    lost input would be followed too long in the simulation.
    """

    def __init__(self, period: float) -> None:
        """Nothing has arrived yet.

        Args:
            period: Control period [s].
        """
        self._period = period
        self._stamp = -math.inf
        self._steps = 0

    def of(self, stamp: float, now: float) -> tuple[float, bool]:
        """Age of the input that counts in this step [s], and whether it arrived since the last step.

        Args:
            stamp: When the input was so [s].
            now: The time on the same clock [s].
        """
        arrived = stamp > self._stamp + NEWER
        if arrived:
            self._stamp, self._steps = stamp, 0
        else:
            self._steps += 1
        return max(now - stamp, self._steps * self._period, 0.0), arrived

    def is_lost(self, age: float) -> bool:
        """Whether an input of this age [s] must no longer be followed: braking then begins within `MAX_AGE`.

        A step is on its way for a whole period, so that the one that begins at `MAX_AGE` brakes already.
        """
        return not age < MAX_AGE - 0.5 * self._period
