"""How deep two placed objects overlap: first by the boxes around them, then by their convex parts.

Two convex bodies are apart if a direction is found in which their shadows are (the separating axis theorem). Asked are
the directions of all faces, not those across two edges: what is apart by such a direction alone counts as overlapping,
which errs to the safe side.
"""

from collections.abc import Sequence
from functools import cache

import numpy as np
from scipy.spatial import ConvexHull

from robots.pose import FloatArray

from .model import ObjectModel

Placed = tuple[ObjectModel, Sequence[float], float]
"""An object, the position of its frame (3,) [m] and its yaw [rad]."""


def half_width(half: Sequence[float] | FloatArray, yaw: float, way: Sequence[float] | FloatArray) -> float:
    """How far a box reaches from its centre along a way, seen from above [m].

    Args:
        half: Half its length and width, and more that does not matter, (2,) or more [m].
        yaw: Direction of its length [rad].
        way: Unit vector, (2,).
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    along, across = abs(way[0] * cos + way[1] * sin), abs(way[1] * cos - way[0] * sin)
    return float(along * half[0] + across * half[1])


def box_depth(
    half_one: Sequence[float],
    half_other: Sequence[float],
    offset: Sequence[float],
    yaw_one: float = 0.0,
    yaw_other: float = 0.0,
) -> float:
    """How deep two upright boxes overlap [m]; negative when they are at least so far apart.

    Args:
        half_one: Half extents of the first, (3,) [m].
        half_other: Half extents of the second, (3,) [m].
        offset: From the first one's centre to the second one's, (3,) [m].
        yaw_one: How the first is turned about the vertical [rad].
        yaw_other: How the second is turned [rad].
    """
    return min(
        footprint_depth(half_one, half_other, offset, yaw_one, yaw_other),
        half_one[2] + half_other[2] - abs(offset[2]),
    )


def footprint_depth(
    half_one: Sequence[float], half_other: Sequence[float], offset: Sequence[float], yaw_one: float, yaw_other: float
) -> float:
    """As `box_depth`, seen from above: how deep two turned rectangles overlap [m]."""
    x, y = offset[0], offset[1]
    depth = np.inf
    for yaw in {yaw_one, yaw_other}:
        cos, sin = (1.0, 0.0) if yaw == 0.0 else (float(np.cos(yaw)), float(np.sin(yaw)))
        for ax, ay in ((cos, sin), (-sin, cos)):
            reach = _reach(half_one, yaw_one, ax, ay) + _reach(half_other, yaw_other, ax, ay)
            depth = min(depth, reach - abs(x * ax + y * ay))
    return float(depth)


def parts_depth(one: Placed, other: Placed) -> float:
    """How deep any convex part of one object overlaps any of another [m]; 0 when none do."""
    deepest = 0.0
    there = [_placed(other, corners, faces) for corners, faces in _convex_parts(other[0])]
    for corners, faces in _convex_parts(one[0]):
        corners, faces = _placed(one, corners, faces)
        lower, upper = corners.min(axis=0), corners.max(axis=0)
        for others, other_faces in there:
            if (others.max(axis=0) > lower).all() and (others.min(axis=0) < upper).all():
                axes = np.concatenate([faces, other_faces])
                first, second = corners @ axes.T, others @ axes.T
                overlap = np.minimum(first.max(axis=0) - second.min(axis=0), second.max(axis=0) - first.min(axis=0))
                deepest = max(deepest, float(overlap.min()))
    return deepest


def _reach(half: Sequence[float], yaw: float, ax: float, ay: float) -> float:
    """How far a turned rectangle reaches from its centre in a direction."""
    cos, sin = (1.0, 0.0) if yaw == 0.0 else (float(np.cos(yaw)), float(np.sin(yaw)))
    return half[0] * abs(ax * cos + ay * sin) + half[1] * abs(ay * cos - ax * sin)


@cache
def _convex_parts(model: ObjectModel) -> list[tuple[FloatArray, FloatArray]]:
    """Corners (n, 3) and the directions of the faces (k, 3) of each part, in the object frame."""
    parts = []
    for part in model.parts:
        normals = ConvexHull(part.vertices).equations[:, :3]
        parts.append((part.vertices, np.unique(normals.round(6), axis=0)))
    return parts


def _placed(placed: Placed, corners: FloatArray, faces: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Corners and directions in the world."""
    _, position, yaw = placed
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    return corners @ turn.T + np.array(position), faces @ turn.T
