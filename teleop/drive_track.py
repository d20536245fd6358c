"""Tracks of robots with several arms or a base: what was wanted, what was executed, where the hands were."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray

from .drive_command import ArmWish, DriveCommand


@dataclass(frozen=True, slots=True)
class DriveTrack:
    """What the person wanted of the robot at each of K control steps.

    Attributes:
        commands: K commands; equal ones that follow each other are the same object, as when they were given.
    """

    commands: tuple[DriveCommand, ...]

    def __len__(self) -> int:
        """Number of control steps, K."""
        return len(self.commands)


@dataclass(frozen=True, slots=True)
class ArmsTrack:
    """What was asked for and executed at each of K control steps, by arm.

    Attributes:
        names: The A arms.
        asked: Tool twists along the axes of the world, (K, A, 6) [m/s, rad/s].
        executed: The same after all limits, (K, A, 6).
        openings: Wanted gaps between the fingers, (K, A) [m].
        reasons: Why asked and executed differ, K times A texts.
        details: The joint, the pair or the fault behind each reason, K times A texts.
        base_asked: Speed and turning speed asked of the base, (K, 2) [m/s, rad/s].
        base_executed: The same after limits, (K, 2).
        states: `ok`, `slowed` or `stopped`, K texts.
        state_reasons: Why it is not ok, K texts.
    """

    names: tuple[str, ...]
    asked: FloatArray
    executed: FloatArray
    openings: FloatArray
    reasons: tuple[tuple[str, ...], ...]
    details: tuple[tuple[str, ...], ...]
    base_asked: FloatArray
    base_executed: FloatArray
    states: tuple[str, ...]
    state_reasons: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class HandsTrack:
    """Hands of all arms at the T moments of the states.

    Attributes:
        names: The A arms.
        tools: Tool frames in the world: position [m] and quaternion xyzw, (T, A, 7).
        openings: Measured gaps between the fingers, (T, A) [m].
        closed: Whether the gripper was told to close, (T, A).
        held: Id of the object between the fingers, -1 for none, (T, A).
        wrist_wrenches: Forces [N] and torques [Nm] at the wrist along the axes of the world, (T, A, 6).
        finger_efforts: Efforts of the two fingers' motors, (T, A, 2) [N or Nm].
    """

    names: tuple[str, ...]
    tools: FloatArray
    openings: FloatArray
    closed: NDArray[np.bool_]
    held: NDArray[np.int64]
    wrist_wrenches: FloatArray
    finger_efforts: FloatArray


def command_to_message(command: DriveCommand) -> dict[str, Any]:
    """The fields of a command as JSON has them."""
    return {
        "arms": {
            name: {"twist": wish.twist, "frame": wish.frame, "gripper": wish.gripper, "jog": wish.jog}
            for name, wish in command.arms.items()
        },
        "base": command.base,
        "speed_ratio": command.speed_ratio,
        "enabled": command.enabled,
        "stop": command.stop,
        "age": command.age,
        "fault": command.fault,
        "camera_xyzw": command.camera_xyzw,
    }


def command_from_message(message: dict[str, Any]) -> DriveCommand:
    """The command that a message holds; what JSON cannot say, such as NaN, comes back as NaN.

    Raises:
        KeyError: A field is missing.
        TypeError: A field is of the wrong kind.
        ValueError: A field has the wrong value.
    """
    arms = {}
    for name, wish in message["arms"].items():
        jog = wish["jog"]
        arms[name] = ArmWish(
            twist=_numbers(wish["twist"]),
            frame=wish["frame"],
            gripper=wish["gripper"],
            jog=None if jog is None else (int(jog[0]), _number(jog[1])),
        )
    speed, turn = _numbers(message["base"])
    camera = message.get("camera_xyzw")  # demos of earlier versions have none
    return DriveCommand(
        arms=arms,
        base=(speed, turn),
        speed_ratio=_number(message["speed_ratio"]),
        enabled=bool(message["enabled"]),
        stop=bool(message["stop"]),
        age=_number(message["age"]),
        fault=str(message["fault"]),
        camera_xyzw=None if camera is None else _quaternion(camera),
    )


def _number(value: Any) -> float:
    return float("nan") if value is None else float(value)


def _quaternion(values: Any) -> tuple[float, float, float, float]:
    x, y, z, w = _numbers(values)
    return x, y, z, w


def _numbers(values: Any) -> tuple[float, ...]:
    return tuple(_number(value) for value in values)
