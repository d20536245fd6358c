"""A wheeled base: where it gets to as it brakes."""

import math
from collections.abc import Sequence

import numpy as np

from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose


def rolled(pose_base_in_world: Pose, way: FloatArray) -> list[Pose]:
    """Poses of a base along a way, each stretch of which is taken as an arc.

    Args:
        pose_base_in_world: Where it starts, upright.
        way: Distance gone along its x axis [m] and angle turned [rad] since the start, (m, 2).
    """
    rotation = rotation_matrix(pose_base_in_world.orientation_xyzw)
    position = pose_base_in_world.position
    poses = []
    gone, turned = 0.0, 0.0
    x, y = 0.0, 0.0
    for distance, angle in way.tolist():
        middle = 0.5 * (turned + angle)
        half = 0.5 * (angle - turned)
        chord = (distance - gone) * (math.sin(half) / half if abs(half) > 1e-9 else 1.0)
        x, y = x + chord * math.cos(middle), y + chord * math.sin(middle)
        gone, turned = distance, angle
        turn = (0.0, 0.0, math.sin(0.5 * angle), math.cos(0.5 * angle))
        orientation = _product(pose_base_in_world.orientation_xyzw.tolist(), turn)
        poses.append(Pose(position + rotation @ np.array([x, y, 0.0]), np.array(orientation)))
    return poses


def _product(first: Sequence[float], second: Sequence[float]) -> tuple[float, float, float, float]:
    """Product of two quaternions in xyzw order."""
    ax, ay, az, aw = first
    bx, by, bz, bw = second
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )
