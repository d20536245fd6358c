"""Convex parts for contact. Rings are cut into segments, so that what is hollow is hollow to contact too."""

from collections.abc import Sequence

import numpy as np

from robots.pose import FloatArray, Pose

from .model import Part, PartKind

SEGMENTS = 16
"""Sides of a turned part, and segments of a ring. Their middles touch the true circle."""

_UPRIGHT = np.array([0.0, 0.0, 0.0, 1.0])
_CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])

Section = Sequence[tuple[float, float]]
"""Convex cross section of something turned around the z axis: corners (radius, height) [m]."""


def box_part(half_extents: FloatArray, middle: FloatArray) -> Part:
    """A true box [m]."""
    return _part("box", half_extents, middle, middle + _CORNERS * half_extents)


def ball_part(radius: float, middle: FloatArray) -> Part:
    """A true sphere [m]."""
    # Corners of a cube and an octahedron around the sphere.
    around = np.concatenate([_CORNERS * radius, np.sqrt(3) * radius * np.concatenate([np.eye(3), -np.eye(3)])])
    return _part("sphere", np.full(3, radius), middle, middle + around)


def drum_part(radius: float, bottom: float, top: float) -> Part:
    """A true cylinder, upright around the z axis [m]."""
    size, middle = np.array([radius, radius, (top - bottom) / 2]), np.array([0.0, 0.0, (bottom + top) / 2])
    return _part("cylinder", size, middle, _turned([(radius, bottom), (radius, top)]))


def turned_part(section: Section) -> Part:
    """The convex hull of a cross section turned around the z axis."""
    return hull(_turned(section))


def ring_parts(section: Section) -> tuple[Part, ...]:
    """Segments of a ring with this cross section; the first is in the direction of +x."""
    step = 2 * np.pi / SEGMENTS
    return tuple(
        hull(np.concatenate([_corners_at(section, (segment + side) * step) for side in (-0.5, 0.5)]))
        for segment in range(SEGMENTS)
    )


def hull(corners: FloatArray) -> Part:
    """The convex part with these corners (n, 3) [m]."""
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    return _part("hull", (upper - lower) / 2, (upper + lower) / 2, corners)


def _part(kind: PartKind, size: FloatArray, middle: FloatArray, corners: FloatArray) -> Part:
    return Part(kind, size, Pose(middle, _UPRIGHT), corners)


def _turned(section: Section) -> FloatArray:
    angles = (np.arange(SEGMENTS) + 0.5) * 2 * np.pi / SEGMENTS
    # Corners on the axis come once.
    return np.unique(np.concatenate([_corners_at(section, angle) for angle in angles]).round(12), axis=0)


def _corners_at(section: Section, angle: float) -> FloatArray:
    """Corners (n, 3) of a section, so far out that the sides between neighbouring corners touch the circle."""
    radii, heights = np.array(section, dtype=float).T
    radii = radii / np.cos(np.pi / SEGMENTS)
    return np.column_stack([radii * np.cos(angle), radii * np.sin(angle), heights])
