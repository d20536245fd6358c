"""How far the hand is from objects that have an upright box: from face to point, not from centre to centre."""

import numpy as np

from learning.perception.observation import Observation
from robots.pose import FloatArray


def gap_offsets(observation: Observation) -> FloatArray:
    """Shortest way from the tool point to each object, (F, N, 3) [m]: zero where the tool is inside the object's box.

    How the box is turned about the vertical is not told, so its outline on the table is taken as the circle whose
    radius is the mean of its half length and half width. Where only points are known (`extent` is None, the board),
    the way leads to the centre.
    """
    to_centre = observation.location - observation.gripper_location[:, None]
    if observation.extent is None:
        return np.asarray(to_centre)
    radius, half_height = box_size(observation)
    along = np.linalg.norm(to_centre[..., :2], axis=2)
    outside = np.maximum(along - radius, 0.0)
    share = np.divide(outside, along, out=np.zeros_like(along), where=along > 0.0)
    up = to_centre[..., 2]
    vertical = np.sign(up) * np.maximum(np.abs(up) - half_height, 0.0)
    return np.concatenate([to_centre[..., :2] * share[..., None], vertical[..., None]], axis=2)


def face_distances(observation: Observation) -> tuple[FloatArray, FloatArray]:
    """How far the tool point is above the top and outside the outline of each box, each (F, N) [m]; negative inside.

    Raises:
        ValueError: The observation has no extents.
    """
    if observation.extent is None:
        raise ValueError("the observation has no extents: only boxes have faces")
    radius, half_height = box_size(observation)
    to_tool = observation.gripper_location[:, None] - observation.location
    return to_tool[..., 2] - half_height, np.linalg.norm(to_tool[..., :2], axis=2) - radius


def box_size(observation: Observation) -> tuple[FloatArray, FloatArray]:
    """Radius of the outline and half height of each object, each (N,) [m].

    Objects do not change: the size is the median over the frames in which the object is seen and the hand is not in
    front of it or around it, as far as there are such frames.
    """
    assert observation.extent is not None
    away = np.linalg.norm(observation.location - observation.gripper_location[:, None], axis=2) > CLEAR_VIEW
    seen = np.ones_like(away) if observation.visible is None else observation.visible
    size = np.zeros((away.shape[1], 3))
    for index in range(len(size)):
        chosen = next((m for m in (seen[:, index] & away[:, index], seen[:, index]) if np.count_nonzero(m) >= 3), None)
        values = observation.extent[:, index] if chosen is None else observation.extent[chosen, index]
        size[index] = np.median(values, axis=0)
    return 0.25 * (size[:, 0] + size[:, 1]), 0.5 * size[:, 2]


CLEAR_VIEW = 0.15
"""A hand further than this from an object's centre hides nothing of it, most of the time [m]."""
