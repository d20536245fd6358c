"""What of a command cannot be trusted, and what brings everything to rest."""

import math
from collections.abc import Mapping

from robots import RobotModel

from .drive_command import MAX_AGE, ArmWish, DriveCommand
from .servo import MAX_COMMANDED_SPEED
from .servo_reason import DriveReason

MAX_JOG = 10.0
"""Jogs above this are faults of the input, not wishes [rad/s]."""
_UNIT_WITHIN = 1e-3
_AXES = ("x", "y", "z", "roll", "pitch", "yaw")
_FRAMES = ("world", "base", "tool", "camera")


def why_to_stop(command: DriveCommand, robot: RobotModel) -> tuple[DriveReason, str]:
    """The first reason for which everything must come to rest, with its detail; `NONE` when there is none.

    Never raises: what comes from a device or from a page is judged, not believed.
    """
    if command.stop:
        return DriveReason.STOPPED, "release the stop to go on"
    if fault := command.fault or fault_of(command, robot):
        return DriveReason.BAD_INPUT, fault
    if command.age > MAX_AGE:
        return DriveReason.LOST_INPUT, f"the last input is {command.age:.2f} s old, allowed {MAX_AGE} s"
    if not command.enabled:
        return DriveReason.DISABLED, "hold the enabling button to move"
    return DriveReason.NONE, ""


def fault_of(command: DriveCommand, robot: RobotModel) -> str:
    """Name what is wrong with a command's numbers and names, or return an empty string."""
    if not 0.0 <= command.speed_ratio <= 1.0:
        return f"speed ratio is {command.speed_ratio!r}, allowed 0..1"
    if not command.age >= 0.0:
        return f"age of the input is {command.age!r}, allowed 0 or more"
    for name, value in zip(("speed of the base", "turning speed of the base"), command.base, strict=True):
        if not abs(value) <= MAX_COMMANDED_SPEED:  # NaN fails every comparison
            return f"{name} is {value!r}, allowed -{MAX_COMMANDED_SPEED}..{MAX_COMMANDED_SPEED}"
    if command.camera_xyzw is not None:
        size = math.hypot(*command.camera_xyzw)
        if len(command.camera_xyzw) != 4 or not abs(size - 1.0) <= _UNIT_WITHIN:
            return f"orientation of the picture is {command.camera_xyzw!r}, needs a unit quaternion xyzw"
    return _fault_of_wishes(command.arms, robot)


def _fault_of_wishes(wishes: Mapping[str, ArmWish], robot: RobotModel) -> str:
    for name, wish in wishes.items():
        if name not in robot.arms:
            return f"{robot.name} has no arm {name!r}, use one of {', '.join(robot.arms)}"
        if len(wish.twist) != 6:
            return f"twist of arm {name} has {len(wish.twist)} numbers, needs 6"
        for axis, value in zip(_AXES, wish.twist, strict=True):
            if not abs(value) <= MAX_COMMANDED_SPEED:
                return (
                    f"commanded {axis} speed of arm {name} is {value!r}, "
                    f"allowed -{MAX_COMMANDED_SPEED}..{MAX_COMMANDED_SPEED}"
                )
        if wish.frame not in _FRAMES:
            return f"frame of arm {name} is {wish.frame!r}, use one of {', '.join(_FRAMES)}"
        if wish.jog is not None:
            joint, speed = wish.jog
            count = len(robot.arms[name].joint_names)
            if not (math.isfinite(joint) and 0 <= joint < count and int(joint) == joint):
                return f"jogged joint of arm {name} is {joint!r}, allowed 0..{count - 1}"
            if not abs(speed) <= MAX_JOG:
                return f"jog speed of arm {name} is {speed!r}, allowed -{MAX_JOG}..{MAX_JOG} rad/s"
    return ""
