"""What a demo tells of its stops: when the last input came, when braking began, when everything was at rest.

All of it is in simulated time, from what was recorded at each control step; what braking had to take follows from the
recorded speeds and the robot's limits alone (Ruckig's velocity interface, as the servo brakes).
"""

from dataclasses import dataclass

import numpy as np

from robots.catalogue import load_robot
from robots.model import RobotModel
from robots.pose import FloatArray

from .demo import Demo
from .drive_command import MAX_AGE, DriveCommand
from .velocity_profile import VelocityProfile


@dataclass(frozen=True, slots=True)
class Stop:
    """Once that everything was told to come to rest while it was moving.

    Attributes:
        reason: Why.
        braking: When braking began, in the demo [s].
        last_input: When the last input came that was followed [s]; None where none came or this was not kept.
        rest: When everything was at rest [s]; None where it was told to move again before, or the demo ends.
        needed: What braking takes at least within the limits of acceleration and jerk [s].
    """

    reason: str
    braking: float
    last_input: float | None
    rest: float | None
    needed: float

    @property
    def delay(self) -> float | None:
        """From the last input to braking [s]."""
        return None if self.last_input is None else self.braking - self.last_input

    @property
    def taken(self) -> float | None:
        """From braking to rest [s]."""
        return None if self.rest is None else self.rest - self.braking


def stops_of(demo: Demo, robot: RobotModel | None = None) -> tuple[Stop, ...]:
    """The stops of a demo of a whole robot; none for other demos.

    Args:
        demo: The demo.
        robot: Its robot; None takes the one that has its name.

    Raises:
        RobotError: The demo's robot is not here.
    """
    if demo.drive is None or demo.arm_commands is None or not len(demo.drive):
        return ()
    robot = robot or load_robot(demo.scene.robot)
    reasons = [_why(command) for command in demo.drive.commands]
    # What is executed during step k is row k + 1; before the first step nothing moves.
    speeds = np.concatenate((demo.commands.joint_velocity, demo.arm_commands.base_executed), axis=1)
    speeds = np.vstack((np.zeros((1, speeds.shape[1])), speeds))
    found = []
    for step in range(1, len(reasons)):
        if not reasons[step] or reasons[step - 1] or not speeds[step].any():
            continue
        rest = next((k for k in range(step, len(reasons)) if not reasons[k] or not speeds[k + 1].any()), None)
        ends = rest is not None and bool(reasons[rest])
        rate = demo.rate
        found.append(
            Stop(
                reason=reasons[step],
                braking=step / rate,
                last_input=_last_input(demo, reasons, step),
                rest=(rest + 1) / rate if rest is not None and ends else None,
                needed=least_time_to_rest(robot, speeds[step], (speeds[step] - speeds[step - 1]) * rate),
            )
        )
    return tuple(found)


def least_time_to_rest(robot: RobotModel, velocity: FloatArray, acceleration: FloatArray) -> float:
    """The least time to rest within the limits of acceleration and jerk [s].

    Args:
        robot: The robot.
        velocity: Of its n joints [rad/s], and then of its base where there is one [m/s, rad/s], (n,) to (n + 2,).
        acceleration: The same [1/s]; beyond the limits it is taken as at them.
    """
    drive = robot.drive
    # A base that cannot move rests, whatever its limits are.
    base = [(drive.acceleration, drive.yaw_acceleration), (drive.jerk, drive.yaw_jerk)] if drive else [(1.0, 1.0)] * 2
    limits = [
        np.concatenate(pair)[: len(velocity)] for pair in zip((robot.acceleration, robot.jerk), base, strict=True)
    ]
    profile = VelocityProfile(limits[0].tolist(), limits[1].tolist())
    within = np.clip(acceleration, -limits[0], limits[0])
    return profile.way_to_rest(velocity.tolist(), within.tolist(), ())[1]


def _why(command: DriveCommand) -> str:
    """Why a command brings everything to rest; empty when it does not."""
    if command.stop:
        return "emergency stop"
    if command.fault:
        return command.fault
    if not command.age <= MAX_AGE:
        return f"input is older than {MAX_AGE} s"
    return "" if command.enabled else "not enabled"


def _last_input(demo: Demo, reasons: list[str], before: int) -> float | None:
    """When the last input came that was followed [s]."""
    arrived = demo.inputs.arrived
    if arrived is None:
        return None
    return next((step / demo.rate for step in range(before - 1, -1, -1) if arrived[step] and not reasons[step]), None)
