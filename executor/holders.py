"""What an object lies in: a hull around a bowl would be in the way of a hand that reaches into it."""

import numpy as np

from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from twin import World
from twin.state import ObjectState

TOUCHING = 0.002
"""What rests on a thing may sink into it so far [m]."""


def holders(world: World, object_id: int) -> tuple[int, ...]:
    """Ids of the things around an object: those that stand under its middle and reach above its underside.

    Raises:
        TwinError: There is no such object.
    """
    bounds = {each.id: _bounds(world, each) for each in world.state().objects}
    low, high = bounds[object_id]
    middle = 0.5 * (low + high)[:2]
    return tuple(
        other
        for other, (lowest, highest) in bounds.items()
        if other != object_id
        and bool(np.all((lowest[:2] <= middle) & (middle <= highest[:2])))
        and low[2] < highest[2] - TOUCHING
        and lowest[2] < low[2] + TOUCHING
    )


def _bounds(world: World, thing: ObjectState) -> tuple[FloatArray, FloatArray]:
    """Lowest and highest corner of a thing where it is, (3,) each [m]."""
    pose = thing.pose_object_in_world
    corners = np.concatenate([part.vertices for part in world.model_of(thing.id).parts])
    placed = corners @ rotation_matrix(pose.orientation_xyzw).T + pose.position
    return placed.min(axis=0), placed.max(axis=0)
