"""Whether a robot that was halted can be moved on by some input."""

from collections.abc import Mapping

import numpy as np

from robots import RobotModel
from robots.pose import FloatArray, Pose
from teleop.base_servo import rolled
from teleop.drive_command import ArmWish, DriveCommand
from teleop.robot_servo import RobotServo
from teleop.servo_reason import STOPPING
from teleop.servo_result import RobotServoResult, ServoView

DT = 1.0 / 240.0
PROBE = 36
"""Steps that an input is given to move what was halted."""
MOVED = 2e-4
"""What has moved so far in that time is not stuck [rad or m]."""
STANDS = 1e-4
"""What is slower stands [m/s or rad/s]."""
WHEELS = ((0.2, 0.0), (-0.2, 0.0), (0.0, 0.4), (0.0, -0.4))
"""Speeds [m/s] and turning speeds [rad/s] that a halted base is tried with."""


class WayOut:
    """Looks for ways out with a servo of its own."""

    def __init__(self, robot: RobotModel, probe: RobotServo) -> None:
        """Take the robot and a servo that knows what is around."""
        self._robot, self._probe = robot, probe

    def stuck(
        self, result: RobotServoResult, q: FloatArray, openings: Mapping[str, float], base: Pose
    ) -> dict[str, bool]:
        """Whether no input moves each arm, and the base, that was asked to move and stands; by name.

        An arm has a way out if an input moves it; the base, if an input moves it or an arm that is in its way.
        """
        inputs = {name: _inputs(self._robot, name) for name in result.arms}
        found = {}
        for name in halted(result):
            if name == "base":
                commands = [DriveCommand(base=wheels) for wheels in WHEELS] + [
                    each for some in inputs.values() for each in some
                ]
                found[name] = not any(self._moves(each, slice(None), q, openings, base) for each in commands)
            else:
                where = self._robot.slice_of(name)
                found[name] = not any(self._moves(each, where, q, openings, base) for each in inputs[name])
        return found

    def _moves(
        self, command: DriveCommand, where: slice, q: FloatArray, openings: Mapping[str, float], base: Pose
    ) -> bool:
        """Whether a command moves some joints, or the base."""
        self._probe.reset()
        here, stand, gone = q, base, np.zeros(2)
        for _ in range(PROBE):
            result = self._probe.step(command, ServoView(here, np.zeros(len(q)), openings, stand), DT)
            here = here + result.joint_velocity * DT
            if result.base_twist.any():
                gone += result.base_twist * DT
                stand = rolled(stand, result.base_twist[None] * DT)[0]
            if max(np.abs(here - q)[where].max(), np.abs(gone).max()) > MOVED:
                return True
        return False


def halted(result: RobotServoResult) -> list[str]:
    """What stands that was asked to move, not because everything was told to stop: arms, and `base`."""
    names = [
        name
        for name, arm in result.arms.items()
        if arm.reason not in STOPPING and bool(arm.asked.any()) and float(np.abs(arm.executed).max()) < STANDS
    ]
    moves = float(np.abs(result.base_twist).max()) >= STANDS
    return names + ["base"] * (bool(result.base_asked.any()) and not moves and result.base_reason not in STOPPING)


def _inputs(robot: RobotModel, name: str) -> list[DriveCommand]:
    """One twist or joint of an arm at a time, both ways."""
    rows = np.vstack((0.1 * np.eye(6), -0.1 * np.eye(6)))
    rows[[3, 4, 5, 9, 10, 11]] *= 3.0
    wishes = [ArmWish(tuple(row.tolist())) for row in rows]
    wishes += [
        ArmWish(jog=(joint, speed)) for joint in range(len(robot.arms[name].joint_names)) for speed in (0.3, -0.3)
    ]
    return [DriveCommand({name: wish}) for wish in wishes]
