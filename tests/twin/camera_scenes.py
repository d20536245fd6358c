"""Small scenes that the camera's tests look at."""

import numpy as np
import trimesh

from robots.pose import FloatArray, Pose
from twin.camera import CameraModel, Drawable, SceneGeometry, looking_at

CAMERA = CameraModel(160, 120, 150.0, 145.0, 70.0, 65.0)
"""Unequal focal lengths and an axis off the middle, so that a mixed-up axis shows."""
STRAIGHT = Pose(np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]))
"""The optical frame is the world's: z forward, y down."""
AT_TABLE = looking_at((0.0, 0.0, 0.6), (0.6, 0.0, 0.0))


def at(*position: float) -> FloatArray:
    """An unturned pose, (4, 4)."""
    pose = np.eye(4)
    pose[:3, 3] = position
    return pose


def box(identity: int, size: tuple[float, float, float], rgb: tuple[float, float, float], **more: bool) -> Drawable:
    mesh = trimesh.creation.box(size)
    return Drawable(identity, mesh.vertices, mesh.faces, np.array(rgb), **more)


def ball(identity: int, radius: float, rgb: tuple[float, float, float]) -> Drawable:
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=radius)
    return Drawable(identity, mesh.vertices, mesh.faces, np.array(rgb))


def table_scene() -> SceneGeometry:
    """A table that stands, and a red box, a green ball and a blue rod that move."""
    rod = trimesh.creation.cylinder(radius=0.02, height=0.3, sections=32)
    top = trimesh.creation.box((0.8, 1.0, 0.04))
    return SceneGeometry(
        (
            Drawable(100, top.vertices + (0.6, 0.0, -0.02), top.faces, np.array((0.6, 0.5, 0.4)), moving=False),
            box(3, (0.08, 0.1, 0.06), (0.9, 0.1, 0.1)),
            ball(7, 0.05, (0.1, 0.8, 0.1)),
            Drawable(11, rod.vertices, rod.faces, np.array((0.1, 0.2, 0.9))),
        )
    )


def table_poses(turn: float = 0.5) -> FloatArray:
    """Poses (3, 4, 4) of what moves in `table_scene`, the box and rod turned [rad]."""
    turned = trimesh.transformations.rotation_matrix(turn, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
    tilted = trimesh.transformations.rotation_matrix(turn, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    return np.stack((at(0.5, 0.15, 0.03) @ turned, at(0.6, -0.1, 0.05), at(0.75, 0.05, 0.16) @ tilted))
