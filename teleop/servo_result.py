"""What the servo of a whole robot sees and says."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from robots.pose import FloatArray, Pose, read_only

from .servo_reason import DriveReason


@dataclass(frozen=True, slots=True)
class ServoView:
    """What the servo needs to see.

    Attributes:
        q: Positions of the driven joints of all arms, (n,) [rad]: those that were commanded last, where there is
            a difference, so that nothing winds up when something is pressed.
        dq: Their velocities, (n,) [rad/s]; used at the first step only.
        openings: Gap of the fingers by arm [m].
        pose_base_in_world: Where the base stands; None where the robot was placed.
        held: Ids of what is held, by arm.
        camera_xyzw: Orientation in the world of the camera through which the person looks (optical frame: x right,
            y down, z forward); None takes the robot's first camera.
    """

    q: FloatArray
    dq: FloatArray
    openings: Mapping[str, float] = field(default_factory=dict)
    pose_base_in_world: Pose | None = None
    held: Mapping[str, int | None] = field(default_factory=dict)
    camera_xyzw: FloatArray | None = None

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("q", "dq"):
            object.__setattr__(self, name, read_only(getattr(self, name)))


@dataclass(frozen=True, slots=True)
class ArmResult:
    """One arm's step.

    Attributes:
        asked: The twist wanted of the tool, (6,) [m/s, rad/s], along the axes of the world; zero when all must stop.
        executed: The twist relative to the base that the joints give, (6,), along the axes of the world.
        reason: Why the two differ.
        detail: The joint, pair or fault behind the reason, for people.
    """

    asked: FloatArray
    executed: FloatArray
    reason: DriveReason = DriveReason.NONE
    detail: str = ""

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "asked", read_only(self.asked))
        object.__setattr__(self, "executed", read_only(self.executed))


@dataclass(frozen=True, slots=True)
class RobotServoResult:
    """One step's outcome.

    Attributes:
        joint_velocity: To be executed during the step, (n,) [rad/s].
        base_twist: Speed [m/s] and turning speed [rad/s] of the base, (2,); zero where there is none.
        base_asked: What was wanted of it, (2,).
        openings: Wanted gap of the fingers by arm [m].
        arms: What became of each arm's wish.
        base_reason: Why the base does not do what was asked.
        base_detail: What is behind it.
        state: `ok`; `slowed` when less or other than asked is done; `stopped` when nothing moves though it was asked
            to, or when everything was told to stop.
        reason: The first reason with whose it is and its detail, as one line for people; empty when there is none.
    """

    joint_velocity: FloatArray
    base_twist: FloatArray
    base_asked: FloatArray
    openings: Mapping[str, float]
    arms: Mapping[str, ArmResult]
    base_reason: DriveReason
    base_detail: str
    state: Literal["ok", "slowed", "stopped"]
    reason: str

    def __post_init__(self) -> None:
        """Freeze what it holds."""
        for name in ("joint_velocity", "base_twist", "base_asked"):
            object.__setattr__(self, name, read_only(getattr(self, name)))
        object.__setattr__(self, "openings", MappingProxyType(dict(self.openings)))
        object.__setattr__(self, "arms", MappingProxyType(dict(self.arms)))
