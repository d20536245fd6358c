"""The fingers of one arm on the twin: told a gap, and waited for."""

import numpy as np

from executor.follow import wait
from twin import World

LOOK_AGAIN = 0.1
"""Time [s] between two looks at moving fingers,"""
STILL = 0.0002
"""which have stopped when their gap changed by less than this [m] in between;"""
PRESS = 0.2
"""then they press for this time [s] before anything else moves."""
SLOWEST = 4.0
"""No gripper needs longer [s]."""


class Fingers:
    """What an arm's fingers are told; those of other arms keep what they were told last.

    Args:
        world: The twin.
        arm: Name of the arm.
    """

    def __init__(self, world: World, arm: str) -> None:
        self._world = world
        self._number = list(world.robot.arms).index(arm)
        self._most = world.robot.arms[arm].gripper.max_opening
        self.opening = world.commanded_openings[self._number]

    @property
    def openings(self) -> tuple[float, ...]:
        """Gap that each arm's fingers are to make [m]."""
        told = list(self._world.commanded_openings)
        told[self._number] = self.opening
        return tuple(told)

    def tell(self, opening: float) -> None:
        """Make a gap [m] with the next motion, as far as the fingers can."""
        self.opening = min(opening, self._most)

    def move(self, opening: float) -> None:
        """Make a gap [m] and wait until the fingers stand still and press."""
        self.tell(opening)
        before = np.inf
        for _ in range(round(SLOWEST / LOOK_AGAIN)):
            wait(self._world, LOOK_AGAIN, self.openings)
            now = self._world.state().arms[self._number].gripper_opening
            if abs(now - before) < STILL:
                break
            before = now
        wait(self._world, PRESS, self.openings)
