"""Where the things of a world are: poses, corners, what bears them."""

from collections.abc import Iterator

import numpy as np

from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose
from twin import World, WorldState

CROWDED = 0.3
"""What is so near to an object may be in the way of a hand that comes from its side [m]."""


def pose_of(state: WorldState, object_id: int) -> Pose:
    """Pose of an object that the scene has, in the world."""
    return next(each.pose_object_in_world for each in state.objects if each.id == object_id)


def is_crowded(world: World, object_id: int) -> bool:
    """Whether anything stands so near to an object that a hand may not come beside it."""
    state = world.state()
    here = pose_of(state, object_id).position
    away = [float(np.linalg.norm(each.pose_object_in_world.position - here)) for each in state.objects]
    return sum(distance < CROWDED for distance in away) > 1


def corners_of(world: World, object_id: int, pose: Pose | None = None) -> FloatArray:
    """Corners of an object's convex parts in the world, (n, 3) [m], where it is or at another pose.

    Raises:
        TwinError: There is no such object.
    """
    model = world.model_of(object_id)
    pose = pose_of(world.state(), object_id) if pose is None else pose
    corners = np.concatenate([part.vertices for part in model.parts])
    return np.asarray(corners @ rotation_matrix(pose.orientation_xyzw).T + pose.position)


def clear_below(world: World, object_id: int, pose: Pose | None = None) -> float:
    """How far an object's underside is above what would bear it [m]: the table, or the highest thing under its middle.

    Raises:
        TwinError: There is no such object.
    """
    corners = corners_of(world, object_id, pose)
    middle = (corners[:, :2].min(axis=0) + corners[:, :2].max(axis=0)) / 2
    underside = float(corners[:, 2].min())
    tops = (float(its[:, 2].max()) for its in others_around(world, object_id, middle))
    return underside - max([0.0, *(top for top in tops if top < underside + 0.01)])


def others_around(world: World, object_id: int, place: FloatArray) -> Iterator[FloatArray]:
    """Corners, (n, 3) [m], of each other object whose extent along x and y a place (2,) [m] is in."""
    for other in world.state().objects:
        if other.id != object_id:
            its = corners_of(world, other.id, other.pose_object_in_world)
            if np.all((its[:, :2].min(axis=0) <= place) & (place <= its[:, :2].max(axis=0))):
                yield its
