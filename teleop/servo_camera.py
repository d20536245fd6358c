"""Axes for driving as a camera sees it: x away from the viewer, y to the left of the picture, z up in it."""

import numpy as np

from robots import RobotModel
from robots.kinematics import frame_pose, rotation_matrix
from robots.pose import FloatArray


def body_axes(optical_xyzw: FloatArray) -> FloatArray:
    """Rotation matrix (3, 3) of those axes for the orientation of an optical frame (x right, y down, z forward)."""
    right, down, forward = rotation_matrix(optical_xyzw).T
    return np.column_stack((forward, -right, -down))


def camera_axes_in_base(robot: RobotModel) -> FloatArray:
    """The axes of a robot's first camera in its base frame, (3, 3); the base's own where it has no camera.

    The camera's link is taken where it is while no joint moves: cameras here stand on bodies, not on arms.
    """
    for mount in robot.cameras.values():
        link = frame_pose(robot.urdf_path, dict(robot.locked), mount.link)
        return np.asarray(
            rotation_matrix(link.orientation_xyzw) @ body_axes(mount.pose_camera_in_link.orientation_xyzw)
        )
    return np.eye(3)
