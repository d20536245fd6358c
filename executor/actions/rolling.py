"""Rolling a robot's base to where its arm reaches better: straight ahead or back, clear of everything."""

import numpy as np

from executor.follow import base_pose, follow_base
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from robots.trajectories import BaseLimits, drive_base
from twin import World

COMFORTABLE = 0.62
"""Distance [m] along the robot's heading, from the middle of its base, at which a hand works best."""
WAYS = (0.08, 0.16, 0.24)
"""Distances [m] that are rolled one after the other, each towards where the place is at that distance or beyond."""
CLEAR = 0.01
"""Least distance [m] of the robot from everything."""


def roll_nearer(world: World, place: FloatArray, attempt: int, rng: np.random.Generator) -> bool:
    """Roll so that a place is at a comfortable distance; whether the base moved.

    Args:
        world: The twin, of any robot: one without wheels stays.
        place: The place, (3,) [m].
        attempt: Number of the attempt; there are as many as `WAYS`.
        rng: Where the planner's chance comes from.
    """
    drive = world.robot.drive
    if drive is None or attempt >= len(WAYS):
        return False
    x, y, yaw = base_pose(world)
    ahead = np.array([np.cos(yaw), np.sin(yaw)])
    off = float((np.asarray(place)[:2] - np.array([x, y])) @ ahead)
    way = WAYS[attempt] * (1.0 if off > COMFORTABLE else -1.0)
    around = CollisionModel(world.placed_robot, world.obstacles(detailed=()))
    q, openings = world.commanded_positions, dict(zip(world.robot.arms, world.commanded_openings, strict=True))
    height = float(world.base_pose.position[2])

    def free(pose: FloatArray) -> bool:
        at_x, at_y, at_yaw = pose.tolist()
        turn = np.array([0.0, 0.0, np.sin(at_yaw / 2), np.cos(at_yaw / 2)])
        around.place_base(Pose(np.array([at_x, at_y, height]), turn))
        return around.free(q, openings, CLEAR)

    limits = BaseLimits(
        drive.speed, drive.acceleration, drive.jerk, drive.yaw_rate, drive.yaw_acceleration, drive.yaw_jerk
    )
    goal = np.array([x + way * ahead[0], y + way * ahead[1], yaw])
    trajectory = drive_base(np.array([x, y, yaw]), goal, limits, free, rng).trajectory if free(goal) else None
    if trajectory is None:
        return False
    follow_base(world, trajectory, world.commanded_openings)
    return True
