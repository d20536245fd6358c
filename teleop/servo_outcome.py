"""What became of a step's wishes: asked beside executed, with a reason where they differ."""

from collections.abc import Mapping
from typing import Literal

import numpy as np

from robots import RobotModel
from robots.ik_kernel import compiled
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
        asked, executed, apart, speed = _compared(
            np.ascontiguousarray(intent.jacobian), velocity[robot.slice_of(name)], intent.asked, turn
        )
        reason, detail = notes[name]
        if stopping:
            reason, detail = stop
        elif apart <= AGREE_WITHIN and name not in notes.always:
            reason, detail = DriveReason.NONE, ""
        elif reason is DriveReason.NONE:
            reason = DriveReason.ACCELERATION_LIMIT
        asks |= any(intent.asked.tolist())
        moves |= speed > REST
        if reason is not DriveReason.NONE:
            lines.append(f"{name}: {reason}" + (f" ({detail})" if detail else ""))
        arms[name] = ArmResult(asked, executed, reason, detail)
    driven = robot.drive is not None
    base_twist = velocity[n:] if driven else np.zeros(2)
    base_reason, base_detail = DriveReason.NONE, ""
    rolled, rolling = base_twist.tolist(), base_asked.tolist()
    if max(abs(done - wish) for done, wish in zip(rolled, rolling, strict=True)) > AGREE_WITHIN:
        base_reason, base_detail = notes[BASE]
        if not driven:
            base_reason, base_detail = DriveReason.UNREACHABLE, f"{robot.name} has no wheels"
        elif base_reason is DriveReason.NONE:
            base_reason = DriveReason.ACCELERATION_LIMIT
        lines.append(f"{BASE}: {base_reason}" + (f" ({base_detail})" if base_detail else ""))
    if stopping:
        base_reason, base_detail = stop
        lines = [f"{stop[0]} ({stop[1]})"]
    asks |= any(rolling)
    moves |= max(map(abs, rolled)) > REST
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


@compiled
def _compared(
    jacobian: FloatArray, velocity: FloatArray, asked: FloatArray, turn: FloatArray
) -> tuple[FloatArray, FloatArray, float, float]:
    """An arm's asked and executed twists along the axes of the world, (6,) each, and the largest parts of both.

    Args:
        jacobian: Along the axes of the base, (6, n).
        velocity: Of the joints, (n,).
        asked: Along the axes of the base, (6,).
        turn: Rotation matrix of the base in the world, (3, 3).

    Returns:
        Both twists; the largest part of their difference and of what is executed.
    """
    executed = np.zeros(6)
    apart = speed = 0.0
    for i in range(6):
        for k in range(velocity.size):
            executed[i] += jacobian[i, k] * velocity[k]
        apart = max(apart, abs(executed[i] - asked[i]))
        speed = max(speed, abs(executed[i]))
    turned, done = np.zeros(6), np.zeros(6)
    for i in range(3):
        for k in range(3):
            for part in (0, 3):
                turned[part + i] += turn[i, k] * asked[part + k]
                done[part + i] += turn[i, k] * executed[part + k]
    return turned, done, apart, speed
