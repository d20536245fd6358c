"""Playing a joint trajectory on the twin."""

from collections.abc import Sequence

import numpy as np

from robots.pose import FloatArray
from robots.trajectories import Trajectory
from twin import JointCommand, World


def follow(world: World, trajectory: Trajectory, joints: slice, openings: Sequence[float]) -> None:
    """Drive some joints along a trajectory; the others stay.

    The drives integrate commanded velocities, so that each step is told the way to the trajectory's next point from
    where they were told to be: rounding does not add up.

    Args:
        world: The twin.
        trajectory: Of the joints that move, from where they are.
        joints: Which of the robot's joints these are.
        openings: Gap of each arm's fingers meanwhile [m].
    """
    count = int(np.ceil(trajectory.duration / World.DT - 1e-9))
    for step in range(1, count + 1):
        wanted, _, _ = trajectory.at(min(step * World.DT, trajectory.duration))
        velocity: FloatArray = np.zeros(len(world.robot.joint_names))
        velocity[joints] = (wanted - world.commanded_positions[joints]) / World.DT
        world.step(JointCommand(velocity, openings))


def wait(world: World, seconds: float, openings: Sequence[float]) -> None:
    """Stand still for a time [s] with the fingers told to make these gaps [m]."""
    still = JointCommand(np.zeros(len(world.robot.joint_names)), openings)
    for _ in range(round(seconds / World.DT)):
        world.step(still)
