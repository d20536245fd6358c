"""What a `robot.toml` says, checked."""

from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from .errors import RobotError
from .validation import read_toml

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1)]
Axis = Literal["x", "y", "z", "-x", "-y", "-z"]
Two = Annotated[tuple[Name, ...], Field(min_length=2, max_length=2)]


class _Section(BaseModel):
    """A table of the file: frozen, and no key that we do not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class PoseSection(_Section):
    """A pose: [m], xyzw."""

    position: tuple[Finite, Finite, Finite] = (0.0, 0.0, 0.0)
    orientation_xyzw: tuple[Finite, Finite, Finite, Finite] = (0.0, 0.0, 0.0, 1.0)

    @model_validator(mode="after")
    def _unit(self) -> "PoseSection":
        length = sum(value * value for value in self.orientation_xyzw) ** 0.5
        if abs(length - 1.0) > 1e-3:
            raise ValueError(f"orientation_xyzw must be a unit quaternion (x, y, z, w), its length is {length:.4g}")
        return self


class CameraSection(PoseSection):
    """A camera mounted on a link: its optical frame (x right, y down, z forward) in the link's frame."""

    link: Name
    sensor: Literal["kinect2", "xtion"] = "xtion"


class GripperSection(_Section):
    """Two fingers: [m], [rad or m] of the joints, [N or Nm], [m/s or rad/s] a finger.

    `closed` and `open` are the joints' positions then; without them the joints are prismatic, 0 when closed and half of
    the gap. With `pads`, two links on the fingers' inner faces, the gap is measured between them; without, every finger
    adds its joint's way to `closed_gap`. `approach` is where the hand points and `closing` where the fingers close, as
    axes of the tool frame. `mounting` shifts each finger outwards on its carriage, as the screws of the real one allow.
    """

    joints: Two
    closed: tuple[Finite, Finite] | None = None
    open: tuple[Finite, Finite] | None = None
    pads: Two | None = None
    closed_gap: Finite = 0.0
    mounting: Finite = 0.0
    max_opening: Positive | None = None
    force: Positive
    closing_speed: Positive
    spinning: Annotated[float, Field(ge=0, allow_inf_nan=False)] = 0.0
    """Arm of a pad's friction against turning about its normal [m]: soft pads touch with more than a point."""
    approach: Axis = "-z"
    closing: Axis = "y"

    @model_validator(mode="after")
    def _consistent(self) -> "GripperSection":
        if self.open is None and self.max_opening is None:
            raise ValueError("give max_opening [m], or the joints' open positions in open")
        if self.approach[-1] == self.closing[-1]:
            raise ValueError(f"approach and closing must be different axes, got {self.approach} and {self.closing}")
        return self


class ArmSection(_Section):
    """The driven joints in order, and one limit per joint: [rad] or [m], per s, s² and s³."""

    name: Name = "arm"
    joints: Annotated[tuple[Name, ...], Field(min_length=1)]
    tool_frame: Name
    home: tuple[Finite, ...]
    velocity: tuple[Positive, ...]
    acceleration: tuple[Positive, ...]
    jerk: tuple[Positive, ...]
    motor_force: tuple[Positive, ...] | None = None
    """Largest force of each joint's drive in physics [N, Nm]; None takes the URDF's effort."""
    gripper: GripperSection

    @model_validator(mode="after")
    def _one_per_joint(self) -> "ArmSection":
        if len(set(self.joints)) != len(self.joints):
            raise ValueError(f"joints must differ from each other, got {', '.join(self.joints)}")
        for key in ("home", "velocity", "acceleration", "jerk", "motor_force"):
            values = getattr(self, key)
            if values is not None and len(values) != len(self.joints):
                raise ValueError(f"{key} must hold one number per joint ({len(self.joints)}), got {len(values)}")
        return self


class DriveSection(_Section):
    """A base on two driven wheels side by side: [m], [m/s], [m/s²], [m/s³] and the same in radians."""

    wheels: Two  # left, right
    wheel_radius: Positive
    track: Positive
    speed: Positive
    acceleration: Positive
    jerk: Positive
    yaw_rate: Positive
    yaw_acceleration: Positive
    yaw_jerk: Positive
    rollers: tuple[Name, ...] = ()
    """Links that slide or roll over the floor without friction: casters."""


class CollisionSection(_Section):
    """Pairs of links that may touch or overlap, besides neighbours in the tree."""

    ignore: tuple[Two, ...] = ()


class RobotFile(_Section):
    """A whole `robot.toml`."""

    name: Name
    description: str = ""
    urdf: Name
    floor: Finite | None = None
    """Height of the floor in the base frame [m] where the robot stands on one; None where it stands on the table."""
    base: PoseSection = PoseSection()
    arms: Annotated[tuple[ArmSection, ...], Field(min_length=1)]
    drive: DriveSection | None = None
    collision: CollisionSection = CollisionSection()
    cameras: dict[Name, CameraSection] = Field(default_factory=dict)
    locked: dict[Name, Finite] = Field(default_factory=dict)
    """Positions of movable joints that nothing drives."""

    @model_validator(mode="after")
    def _arms_differ(self) -> "RobotFile":
        names = [arm.name for arm in self.arms]
        if len(set(names)) != len(names):
            raise ValueError(f"arms: names must differ from each other, got {', '.join(names)}")
        joints = [joint for arm in self.arms for joint in (*arm.joints, *arm.gripper.joints)]
        for joint in joints:
            if joints.count(joint) > 1:
                raise ValueError(f"arms: joint {joint!r} is used more than once; every joint belongs to one arm")
        return self


def read_robot_file(path: Path) -> RobotFile:
    """Read and check a `robot.toml`.

    Raises:
        RobotError: The file cannot be read, is not TOML, or a value is wrong; names file, key and what is allowed.
    """
    return read_toml(path, RobotFile, RobotError)
