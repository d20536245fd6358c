"""What the person wants of the whole robot now: the one thing that devices make and the servo takes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

from .gamepad_mapping import GripperWish

TwistFrame = Literal["world", "base", "tool", "camera"]
"""Frames in which a twist may be given; its origin is the tool's always."""
MAX_AGE = 0.1
"""Input older than this counts as lost [s]; as in MoveIt Servo."""


@dataclass(frozen=True, slots=True)
class ArmWish:
    """What the person wants of one arm now.

    Attributes:
        twist: Velocity of the tool, linear [m/s] then angular [rad/s], (6,), along the axes of `frame`.
        frame: The frame whose axes the twist is expressed in.
        gripper: What the gripper should do from now on.
        jog: A single joint's index in the arm and its speed [rad/s]; the twist is then ignored.
    """

    twist: tuple[float, ...] = (0.0,) * 6
    frame: TwistFrame = "world"
    gripper: GripperWish = "keep"
    jog: tuple[int, float] | None = None


@dataclass(frozen=True, slots=True)
class DriveCommand:
    """What the person wants of the whole robot now.

    Attributes:
        arms: Wishes by arm; arms that are not named stand still.
        base: Speed [m/s] and turning speed [rad/s] of a robot on wheels.
        speed_ratio: 0..1, scales everything.
        enabled: The dead-man switch; False brakes smoothly to rest.
        stop: Emergency stop: brakes as hard as the limits allow, and stays until it is released.
        age: How old the input is [s]; above `MAX_AGE` it counts as lost.
        fault: Why the input cannot be trusted; empty when it can.
        camera_xyzw: Orientation in the world of the picture that the person sees (optical frame: x right, y down, z
            forward), for wishes along its axes; None takes the camera that the servo knows of.
    """

    arms: Mapping[str, ArmWish] = field(default_factory=dict)
    base: tuple[float, float] = (0.0, 0.0)
    speed_ratio: float = 1.0
    enabled: bool = True
    stop: bool = False
    age: float = 0.0
    fault: str = ""
    camera_xyzw: tuple[float, float, float, float] | None = None

    def __post_init__(self) -> None:
        """Freeze the wishes."""
        object.__setattr__(self, "arms", MappingProxyType(dict(self.arms)))
