"""What the fingers are told: to close or to open, but never into anything that they may not touch."""

from collections.abc import Mapping

from robots import RobotModel

from .drive_command import DriveCommand
from .servo_guard import ServoGuard

AHEAD = 0.006
"""Room is looked for so far ahead of where the fingers are [m]: many control periods away."""
STILL = 1e-4
"""Fingers whose gap changed by less than this since they were looked at stand still [m]."""


class FingerServo:
    """Moves all grippers of a robot, each only where there is room a little ahead of its fingers.

    Fingers sweep through space by themselves, so that no look at where they are, or where they will end, is enough:
    open ones may stand on both sides of a mast and close on it, closing ones may be carried around it. They are looked
    at on their way and stop before it; when there is room again they go on.
    """

    def __init__(self, robot: RobotModel) -> None:
        """Know a robot's grippers; nothing was told to them yet."""
        self._widest = {name: arm.gripper.max_opening for name, arm in robot.arms.items()}
        self._wanted: dict[str, float] = {}
        self._told: dict[str, float] = {}
        self._looked: dict[str, float] = {}

    def reset(self) -> None:
        """Forget what was told."""
        for known in (self._wanted, self._told, self._looked):
            known.clear()

    @property
    def told(self) -> Mapping[str, float]:
        """Gap that each gripper is to have now [m]."""
        return self._told

    def measured(self, openings: Mapping[str, float]) -> dict[str, float]:
        """Gaps of all grippers [m]: as measured, else as told, else the widest."""
        return {name: openings.get(name, self._told.get(name, widest)) for name, widest in self._widest.items()}

    def tell(self, command: DriveCommand, openings: Mapping[str, float], guard: ServoGuard) -> dict[str, str]:
        """Take a command, and see whether the fingers may move on.

        Args:
            command: What is wanted.
            openings: Measured gaps [m].
            guard: Knows the posture; see `ServoGuard.look`.

        Returns:
            What keeps fingers from moving, by arm.
        """
        here = self.measured(openings)
        cramped = {}
        for name, gap in here.items():
            wish = command.arms[name].gripper if name in command.arms else "keep"
            before = self._wanted.setdefault(name, gap)
            self._told.setdefault(name, gap)
            if wish != "keep":
                self._wanted[name] = 0.0 if wish == "close" else self._widest[name]
            wanted = self._wanted[name]
            free = self._told[name] == wanted == before
            if free and (wanted == gap or abs(gap - self._looked.get(name, wanted + 1.0)) < STILL):
                continue
            self._looked[name] = gap
            step = min(max(wanted - gap, -AHEAD), AHEAD)
            if guard.has_room(here | {name: gap + step}):
                self._told[name] = wanted
            else:
                self._told[name] = gap
                cramped[name] = f"no room for the fingers to {'close' if wanted < gap else 'open'}"
        return cramped
