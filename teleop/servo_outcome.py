"""What became of a step's wishes: asked beside executed, with a reason where they differ."""

from collections.abc import Mapping
from typing import Literal

import numpy as np

from robots import RobotModel
from robots.pose import FloatArray

from .arm_servo import ArmIntent
from .servo_notes import BASE, ServoNotes
from .servo_reason import STOPPING, DriveReason
from .servo_result import ArmResult, RobotServoResult

AGREE_WITHIN = 2e-3
"""Asked and executed twists that differ by less are the same [m/s, rad/s]: what holds the tool on its line is less."""
REST = 1e-4
"""Slower than this is standing still [m/s or rad/s]."""


def outcome(
    robot: RobotModel,
    stop: tuple[DriveReason, str],
    base_asked: FloatArray,
    intents: Mapping[str, ArmIntent],
    velocity: FloatArray,
    turn: FloatArray,
    notes: ServoNotes,
    openings: Mapping[str, float],
) -> RobotServoResult:
    """Compare what is done with what was asked.

    Args:
        robot: The robot, with n joints.
        stop: Why everything was told to stop; `NONE` where it was not.
        base_asked: What was wanted of the base, (2,) [m/s, rad/s].
        intents: What each arm would do.
        velocity: What is done: speeds of the joints and of a driven base, (d,).
        turn: Rotation matrix of the base in the world, (3, 3).
        notes: Why.
        openings: Wanted gaps of the fingers by arm [m].
    """
    n = len(robot.joint_names)
    stopping = stop[0] is not DriveReason.NONE
    arms, lines = {}, []
    moves = asks = False
    for name, intent in intents.items():
        executed = intent.jacobian @ velocity[robot.slice_of(name)]
        reason, detail = notes[name]
        if stopping:
            reason, detail = stop
        elif float(np.abs(executed - intent.asked).max()) <= AGREE_WITHIN and name not in notes.always:
            reason, detail = DriveReason.NONE, ""
        elif reason is DriveReason.NONE:
            reason = DriveReason.ACCELERATION_LIMIT
        asks |= bool(intent.asked.any())
        moves |= bool(np.abs(executed).max() > REST)
        if reason is not DriveReason.NONE:
            lines.append(f"{name}: {reason}" + (f" ({detail})" if detail else ""))
        arms[name] = ArmResult(_turned(turn, intent.asked), _turned(turn, executed), reason, detail)
    driven = robot.drive is not None
    base_twist = velocity[n:] if driven else np.zeros(2)
    base_reason, base_detail = DriveReason.NONE, ""
    if np.abs(base_twist - base_asked).max() > AGREE_WITHIN:
        base_reason, base_detail = notes[BASE]
        if not driven:
            base_reason, base_detail = DriveReason.UNREACHABLE, f"{robot.name} has no wheels"
        elif base_reason is DriveReason.NONE:
            base_reason = DriveReason.ACCELERATION_LIMIT
        lines.append(f"{BASE}: {base_reason}" + (f" ({base_detail})" if base_detail else ""))
    if stopping:
        base_reason, base_detail = stop
        lines = [f"{stop[0]} ({stop[1]})"]
    asks |= bool(base_asked.any())
    moves |= bool(np.abs(base_twist).max() > REST)
    state: Literal["ok", "slowed", "stopped"] = "ok"
    if lines:
        state = "stopped" if stop[0] in STOPPING or (asks and not moves) else "slowed"
    return RobotServoResult(
        velocity[:n],
        base_twist,
        base_asked,
        openings,
        arms,
        base_reason,
        base_detail,
        state,
        lines[0] if lines else "",
    )


def _turned(rotation: FloatArray, twist: FloatArray) -> FloatArray:
    return np.concatenate((rotation @ twist[:3], rotation @ twist[3:]))
