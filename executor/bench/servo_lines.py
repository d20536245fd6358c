"""Straight lines under the servo: how far the axes that were not commanded drift, and how singular postures get."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np

from robots import ArmModel, CollisionModel, RobotModel, load_robot
from robots.kinematics import rotation_matrix
from robots.manipulability import condition_number
from robots.pose import FloatArray, Pose
from teleop.arm_servo import LENGTH, STOP_AT
from teleop.drive_command import ArmWish, DriveCommand, TwistFrame
from teleop.robot_servo import RobotServo
from teleop.servo_reason import DriveReason
from teleop.servo_result import ServoView

DT = 1.0 / 240.0
SPEEDS = (0.1, 0.2, 0.3)
"""Speeds that are asked for [m/s]."""
LONG = 0.5
"""Length of a line [m]."""
STARTS = 20
"""Starts of each robot, each with a direction of its own; from each, a line at every speed."""
TOGETHER = 4
"""Starts that one task takes."""
PATIENT = 6.0
"""A line is given so many times the time that it would take without slow-downs."""
PATIENCE = 120
"""Steps after which an arm that makes no way has stopped."""
AT_END = 0.02
"""A joint so near to an end of its range has been stopped by it [rad]."""
FREE = 0.02
"""Distance that starts keep [m]."""
_AWAY = frozenset((DriveReason.COLLISION, DriveReason.CONTACT))
"""What lets an arm slide off its line, as it should."""


@dataclass(frozen=True, slots=True)
class Line:
    """What one straight line was like.

    Attributes:
        robot: The robot.
        speed: Speed that was asked for [m/s].
        way: How far it went [m].
        drift: Largest distance from the line [m].
        turned: Largest rotation from the start [rad]; 0 for arms that do not control it.
        condition: How far the condition number went above `STOP_AT`, or above what it began with.
        end: What ended it: `done`, or the reason for which it ended early.
    """

    robot: str
    speed: float
    way: float
    drift: float
    turned: float
    condition: float
    end: str


def tasks(robot: str, seed: int) -> list[tuple[str, int, int, int]]:
    """What `straight_lines` takes, for all starts of a robot."""
    return [(robot, seed, first, min(first + TOGETHER, STARTS)) for first in range(0, STARTS, TOGETHER)]


def straight_lines(task: tuple[str, int, int, int]) -> list[Line]:
    """Drive lines from random postures in random directions, at all speeds, nothing around but the robot itself.

    Args:
        task: The robot, the seed, the first start and where they end.
    """
    robot, seed, first, last = task
    model = load_robot(robot)
    servo, judge = RobotServo(model), CollisionModel(model)
    done = []
    for start in range(first, last):
        rng = np.random.default_rng([seed, start, *robot.encode()])
        name = tuple(model.arms)[int(rng.integers(len(model.arms)))]
        q = free_posture(model, name, judge, rng)
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        frame: TwistFrame = get_args(TwistFrame)[int(rng.integers(3))]  # room, base and tool
        for speed in SPEEDS:
            servo.reset()
            done.append(drive_line(servo, name, q, direction, speed, frame))
    return done


def free_posture(model: RobotModel, name: str, judge: CollisionModel, rng: np.random.Generator) -> FloatArray:
    """A posture (n,) [rad] with one arm anywhere in its range, free and not where the servo would never take it."""
    where, arm = model.slice_of(name), model.arms[name]
    lower = np.where(np.isinf(arm.lower), -np.pi, arm.lower) + 0.1
    upper = np.where(np.isinf(arm.upper), np.pi, arm.upper) - 0.1
    while True:
        q = model.home.copy()
        q[where] = rng.uniform(lower, upper)
        if condition(arm, q[where]) < STOP_AT and judge.nearest(q).distance > FREE:
            return q


def condition(arm: ArmModel, q: FloatArray) -> float:
    """Condition number of what the servo controls of an arm."""
    return condition_number(arm.jacobian(q)[: _rows(arm)], LENGTH)


def drive_line(
    servo: RobotServo,
    name: str,
    q: FloatArray,
    direction: FloatArray,
    speed: float,
    frame: TwistFrame,
) -> Line:
    """Drive a straight line with one arm, let go at its end, and wait until it rests.

    Args:
        servo: Of a robot at rest.
        name: The arm.
        q: Posture of the whole robot, (n,) [rad].
        direction: Along the axes of the frame, a unit vector (3,).
        speed: That is asked for [m/s].
        frame: Which axes these are.
    """
    robot = servo.robot
    arm, where, along = robot.arms[name], robot.slice_of(name), direction
    start = arm.forward_kinematics(q[where])
    if frame == "tool":
        along = rotation_matrix(start.orientation_xyzw) @ along
    elif frame == "base":
        along = rotation_matrix(robot.pose_base_in_world.orientation_xyzw) @ along
    x, y, z = (speed * direction).tolist()
    go, rest = DriveCommand({name: ArmWish((x, y, z, 0.0, 0.0, 0.0), frame)}), DriveCommand()
    drift = turned = gone = 0.0
    first = most = condition(arm, q[where])
    idle, end = 0, ""
    for _ in range(round(PATIENT * LONG / speed / DT)):
        result = servo.step(rest if end else go, ServoView(q, np.zeros(len(q)), {}), DT)
        reason = result.arms[name].reason
        if reason in _AWAY:
            end = end or str(reason)
            break
        q = q + result.joint_velocity * DT
        now = arm.forward_kinematics(q[where])
        moved = now.position - start.position
        way = float(moved @ along)
        if reason is DriveReason.POSITION_LIMIT and _at_end(arm, q[where]):
            end = end or str(reason)
            break
        drift = max(drift, float(np.linalg.norm(moved - way * along)))
        if _rows(arm) == 6:
            turned = max(turned, _angle(start, now))
        most = max(most, condition(arm, q[where]))
        idle = 0 if way > gone + 2e-6 else idle + 1
        gone = max(gone, way)
        if end and servo.at_rest:
            break
        if not end and (gone >= LONG or idle > PATIENCE):
            end = "done" if gone >= LONG else str(reason)
    return Line(robot.name, speed, gone, drift, turned, max(most - max(first, STOP_AT), 0.0), end)


def line_figures(robot: str, found: Sequence[Line]) -> dict[str, float | None]:
    """The worst of all lines of a robot, and of those at each speed."""
    figures: dict[str, float | None] = {}
    for speed in SPEEDS:
        some = [each for each in found if each.speed == speed]
        figures[f"{robot}.drift_mm_at_{speed:g}"] = 1000.0 * max(each.drift for each in some)
        figures[f"{robot}.drift_deg_at_{speed:g}"] = math.degrees(max(each.turned for each in some))
    figures[f"{robot}.drift_mm"] = 1000.0 * max(each.drift for each in found)
    figures[f"{robot}.drift_deg"] = math.degrees(max(each.turned for each in found))
    figures[f"{robot}.condition_over"] = max(each.condition for each in found)
    figures[f"{robot}.line_metres"] = sum(each.way for each in found)
    return figures


def _rows(arm: ArmModel) -> int:
    return 3 if len(arm.joint_names) < 6 else 6


def _at_end(arm: ArmModel, q: FloatArray) -> bool:
    return bool(((q - arm.lower < AT_END) | (arm.upper - q < AT_END)).any())


def _angle(first: Pose, second: Pose) -> float:
    """Angle between two orientations [rad]."""
    rotation = rotation_matrix(first.orientation_xyzw).T @ rotation_matrix(second.orientation_xyzw)
    off = np.array([rotation[2, 1] - rotation[1, 2], rotation[0, 2] - rotation[2, 0], rotation[1, 0] - rotation[0, 1]])
    return math.atan2(float(np.linalg.norm(off)), float(np.trace(rotation)) - 1.0)
