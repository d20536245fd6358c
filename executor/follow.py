"""Playing a joint trajectory on the twin."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from robots.pose import FloatArray
from robots.trajectories import BaseTrajectory, Trajectory
from twin import JointCommand, World

ALONG, BESIDE, TURNING = 2.0, 6.0, 3.0
"""Gains of the base's correction: per second along the way, per square metre beside it, per second of turning."""
STOP = 0.03
"""Time [s] in which a motion that is stopped comes to rest."""
SETTLE = 0.6
"""Time [s] at the end in which the base comes to its goal."""


def follow(
    world: World,
    trajectory: Trajectory,
    joints: slice,
    openings: Sequence[float],
    until: Callable[[], bool] | None = None,
) -> bool:
    """Drive some joints along a trajectory; the others stay.

    The drives integrate commanded velocities, so that each step is told the way to the trajectory's next point from
    where they were told to be: rounding does not add up.

    Args:
        world: The twin.
        trajectory: Of the joints that move, from where they are, but for whole turns of those that turn for ever.
        joints: Which of the robot's joints these are.
        openings: Gap of each arm's fingers meanwhile [m].
        until: Asked after each step whether to stop; then the trajectory is slowed down to rest within `STOP`, which
            only slow ones can be within limits of acceleration.

    Returns:
        Whether it was stopped.
    """
    gaps = tuple(openings)  # who keeps a command must not see it change
    start = trajectory.at(0.0)[0]
    endless = np.isinf(world.robot.lower[joints]) & np.isinf(world.robot.upper[joints])
    turns = 2 * np.pi * endless * np.round((world.commanded_positions[joints] - start) / (2 * np.pi))
    step, late, rate, stopping = 0, 0.0, 1.0, False
    while rate > 0.0 and step * World.DT - late < trajectory.duration - 1e-9 * World.DT:
        if stopping:
            rate = max(0.0, rate - World.DT / STOP)
        step += 1
        late += (1.0 - rate) * World.DT
        wanted, _, _ = trajectory.at(min(step * World.DT - late, trajectory.duration))
        velocity: FloatArray = np.zeros(len(world.robot.joint_names))
        velocity[joints] = (wanted + turns - world.commanded_positions[joints]) / World.DT
        world.step(JointCommand(velocity, gaps))
        stopping = stopping or (until is not None and until())
    return stopping


def follow_base(
    world: World,
    trajectory: BaseTrajectory,
    openings: Sequence[float],
    each_step: Callable[[], None] = lambda: None,
) -> None:
    """Drive the base along a trajectory by its wheels; the arms stay.

    Wheels slip a little, so that the commanded twist is corrected by where the base is (Kanayama et al. 1990): ahead
    or behind, beside the way, and turned off it. It ends as near to the goal as rolling allows, at rest.

    Args:
        world: The twin of a robot on wheels.
        trajectory: Of the base, from where it is.
        openings: Gap of each arm's fingers meanwhile [m].
        each_step: Called after each step.

    Raises:
        TwinError: The robot has no wheels.
    """
    still, gaps = np.zeros(len(world.robot.joint_names)), tuple(openings)
    count = int(np.ceil((trajectory.duration + SETTLE) / World.DT))
    for step in range(1, count + 1):
        wanted, twist, _ = trajectory.at(min(step * World.DT, trajectory.duration))
        x, y, yaw = base_pose(world)
        east, north = float(wanted[0]) - x, float(wanted[1]) - y
        ahead = math.cos(yaw) * east + math.sin(yaw) * north
        across = math.cos(yaw) * north - math.sin(yaw) * east
        turned = float(np.remainder(wanted[2] - yaw + np.pi, 2 * np.pi) - np.pi)
        speed, turn = float(twist[0]), float(twist[1])
        command = (speed + ALONG * ahead, turn + TURNING * turned + BESIDE * speed * across)
        world.step(JointCommand(still, gaps, command))
        each_step()
    world.step(JointCommand(still, gaps))


def base_pose(world: World) -> tuple[float, float, float]:
    """Where the base is: x, y [m] and yaw [rad] in the world."""
    pose = world.base_pose
    x, y, z, w = pose.orientation_xyzw.tolist()
    return float(pose.position[0]), float(pose.position[1]), math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def wait(world: World, seconds: float, openings: Sequence[float]) -> None:
    """Stand still for a time [s] with the fingers told to make these gaps [m]."""
    still = JointCommand(np.zeros(len(world.robot.joint_names)), tuple(openings))
    for _ in range(round(seconds / World.DT)):
        world.step(still)
