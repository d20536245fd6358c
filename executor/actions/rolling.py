"""Rolling a robot's base to where its arm reaches: the nearest such place that is clear of everything."""

from collections.abc import Callable, Iterator

import numpy as np

from executor.follow import base_pose, follow_base
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from robots.trajectories import BaseLimits, drive_base
from twin import World

COMFORTABLE = (0.62, 0.55, 0.70)
"""Distances [m] along the robot's heading, from the middle of its base, at which a hand works well, the best first."""
TURNS = (0.0, 0.35, -0.35, 0.7, -0.7, 1.05, -1.05)
"""Headings [rad] that are tried, from that which the robot has."""
ASIDE = (0.0, 0.15, -0.15)
"""Distances [m] to the left of that heading at which the place may be."""
MOST = 3
"""Places that are driven to for one action."""
LEAST = 0.03
"""A place is another one so far away [m], or turned so much [rad / 5]."""
CLEAR = 0.01
"""Least distance [m] of the robot from everything."""
TURNING = 0.2
"""What turning by a radian costs, in metres."""


def roll_nearer(
    world: World,
    place: FloatArray,
    attempt: int,
    rng: np.random.Generator,
    suits: Callable[[Pose], bool] = lambda base: True,
) -> bool:
    """Roll to the nearest place from where the arm reaches another place; whether the base moved.

    Args:
        world: The twin, of any robot: one without wheels stays.
        place: The place, (3,) [m].
        attempt: Number of the attempt; there are `MOST`, each drives to somewhere else than the base stands.
        rng: Where the planner's chance comes from.
        suits: Whether the arm reaches all that it has to from a pose of the base.
    """
    drive = world.robot.drive
    if drive is None or attempt >= MOST:
        return False
    start = np.array(base_pose(world))
    around = CollisionModel(world.placed_robot, world.obstacles(detailed=()))
    q, openings = world.commanded_positions, dict(zip(world.robot.arms, world.commanded_openings, strict=True))
    height = float(world.base_pose.position[2])

    def free(pose: FloatArray) -> bool:
        around.place_base(_standing(pose, height))
        return around.free(q, openings, CLEAR)

    limits = BaseLimits(
        drive.speed, drive.acceleration, drive.jerk, drive.yaw_rate, drive.yaw_acceleration, drive.yaw_jerk
    )
    for goal in sorted(_places(start, np.asarray(place)), key=lambda goal: _way(start, goal)):
        if _way(start, goal) < LEAST or not free(goal) or not suits(_standing(goal, height)):
            continue
        trajectory = drive_base(start, goal, limits, free, rng).trajectory
        if trajectory is not None:
            follow_base(world, trajectory, world.commanded_openings)
            return True
    return False


def _places(start: FloatArray, place: FloatArray) -> Iterator[FloatArray]:
    """Poses of the base, (3,) [m, m, rad], before which a place lies well."""
    for turn in TURNS:
        yaw = float(start[2]) + turn
        ahead, left = np.array([np.cos(yaw), np.sin(yaw)]), np.array([-np.sin(yaw), np.cos(yaw)])
        for distance in COMFORTABLE:
            for aside in ASIDE:
                yield np.append(place[:2] - distance * ahead - aside * left, yaw)


def _way(start: FloatArray, goal: FloatArray) -> float:
    """How far a pose is from another [m], with what turning costs."""
    return float(np.linalg.norm(goal[:2] - start[:2])) + TURNING * abs(float(goal[2] - start[2]))


def _standing(pose: FloatArray, height: float) -> Pose:
    """Pose of a base that stands upright at x, y, yaw, (3,) [m, m, rad]."""
    x, y, yaw = pose.tolist()
    return Pose(np.array([x, y, height]), np.array([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)]))
