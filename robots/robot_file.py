"""What a `robot.toml` says, checked."""

from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, model_validator

from .errors import RobotError
from .validation import read_toml

Finite = Annotated[float, Field(allow_inf_nan=False)]
Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1)]


class _Section(BaseModel):
    """A table of the file: frozen, and no key that we do not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class BaseSection(_Section):
    """Where the base link stands in the world unless a scene says otherwise: [m], xyzw."""

    position: tuple[Finite, Finite, Finite] = (0.0, 0.0, 0.0)
    orientation_xyzw: tuple[Finite, Finite, Finite, Finite] = (0.0, 0.0, 0.0, 1.0)

    @model_validator(mode="after")
    def _unit(self) -> "BaseSection":
        length = sum(value * value for value in self.orientation_xyzw) ** 0.5
        if abs(length - 1.0) > 1e-3:
            raise ValueError(f"orientation_xyzw must be a unit quaternion (x, y, z, w), its length is {length:.4g}")
        return self


class ArmSection(_Section):
    """The driven joints in order, and one limit per joint: [rad] or [m], per s, s² and s³."""

    joints: Annotated[tuple[Name, ...], Field(min_length=1)]
    tool_frame: Name
    home: tuple[Finite, ...]
    velocity: tuple[Positive, ...]
    acceleration: tuple[Positive, ...]
    jerk: tuple[Positive, ...]

    @model_validator(mode="after")
    def _one_per_joint(self) -> "ArmSection":
        if len(set(self.joints)) != len(self.joints):
            raise ValueError(f"joints must differ from each other, got {', '.join(self.joints)}")
        for key in ("home", "velocity", "acceleration", "jerk"):
            if len(values := getattr(self, key)) != len(self.joints):
                raise ValueError(f"{key} must hold one number per joint ({len(self.joints)}), got {len(values)}")
        return self


class GripperSection(_Section):
    """Two parallel fingers whose joint positions are each half of the gap: [m], [N], [m/s] a finger."""

    joints: Annotated[tuple[Name, ...], Field(min_length=2, max_length=2)]
    max_opening: Positive
    force: Positive
    closing_speed: Positive


class RobotFile(_Section):
    """A whole `robot.toml`."""

    name: Name
    description: str = ""
    urdf: Name
    base: BaseSection = BaseSection()
    arm: ArmSection
    gripper: GripperSection


def read_robot_file(path: Path) -> RobotFile:
    """Read and check a `robot.toml`.

    Raises:
        RobotError: The file cannot be read, is not TOML, or a value is wrong; names file, key and what is allowed.
    """
    return read_toml(path, RobotFile, RobotError)
