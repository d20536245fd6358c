"""Solids to make objects of: each has a closed mesh, a density, a colour, and convex parts for contact.

While an object is made, z = 0 is what it stands on; `assemble` moves the origin to the middle.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh

from robots.pose import FloatArray

from .model import Part, Rgb
from .parts import SEGMENTS, ball_part, box_part, drum_part, hull

SECTIONS = 2 * SEGMENTS
"""Sides of what is turned on a lathe, as drawn: a multiple of the parts' sides, so that grasps lie on corners."""

Outline = Sequence[tuple[float, float]]


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """One solid of an object.

    Attributes:
        mesh: Closed triangle mesh, of trimesh [m].
        density: [kg/m^3]; negative for a cavity.
        rgb: Colour; None if it is not drawn.
        parts: What contact feels of it.
    """

    mesh: Any
    density: float
    rgb: Rgb | None
    parts: tuple[Part, ...] = ()

    def cavity(self, wall: float) -> "Solid":
        """The hollow that leaves a wall [m] of this solid: the same mesh, smaller, its mass taken away."""
        mesh = self.mesh.copy()
        middle = mesh.bounds.mean(axis=0)
        mesh.vertices = middle + (mesh.vertices - middle) * (1 - 2 * wall / mesh.extents)
        return Solid(mesh, -self.density, None)


def box(size: Sequence[float], middle: Sequence[float], density: float, rgb: Rgb | None) -> Solid:
    """A box of `size` (3,) [m] around `middle` (3,) [m]."""
    mesh = trimesh.creation.box(extents=size)
    mesh.apply_translation(middle)
    return Solid(mesh, density, rgb, (box_part(np.array(size) / 2, np.array(middle)),))


def ball(radius: float, middle: Sequence[float], density: float, rgb: Rgb | None) -> Solid:
    """A sphere [m]."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    mesh.apply_translation(middle)
    return Solid(mesh, density, rgb, (ball_part(radius, np.array(middle)),))


def drum(radius: float, bottom: float, top: float, density: float, rgb: Rgb | None) -> Solid:
    """An upright cylinder around the z axis [m]."""
    outline = [(0, bottom), (radius, bottom), (radius, top), (0, top)]
    return turned(outline, density, rgb, [drum_part(radius, bottom, top)])


def turned(profile: Outline, density: float, rgb: Rgb | None, parts: Iterable[Part] = ()) -> Solid:
    """A solid turned on a lathe around the z axis.

    Args:
        profile: Outline (radius, height) [m], outside upwards and inside downwards: from the axis to the axis, or
            closed, for a ring.
        density: [kg/m^3].
        rgb: Colour.
        parts: What contact feels of it.
    """
    mesh = trimesh.creation.revolve(np.array(profile, dtype=float), sections=SECTIONS)
    return Solid(mesh, density, rgb, tuple(parts))


def loft(rings: FloatArray, density: float, rgb: Rgb | None, *, one_part: bool = False) -> Solid:
    """A solid through convex rings of corners.

    Args:
        rings: (m, n, 3) [m], all the same way round.
        density: [kg/m^3].
        rgb: Colour.
        one_part: Whether all of it is convex, and one part to contact; else each leg is.
    """
    count, corners, _ = rings.shape
    faces = []
    for start in range(0, (count - 1) * corners, corners):
        for corner in range(corners):
            a, b = start + corner, start + (corner + 1) % corners
            faces += [[a, b, b + corners], [a, b + corners, a + corners]]
    last = (count - 1) * corners
    faces += [[0, corner + 1, corner] for corner in range(1, corners - 1)]
    faces += [[last, last + corner, last + corner + 1] for corner in range(1, corners - 1)]
    mesh = trimesh.Trimesh(rings.reshape(-1, 3), faces, process=False)
    if mesh.volume < 0:
        mesh.invert()
    legs = [rings] if one_part else [rings[at : at + 2] for at in range(count - 1)]
    return Solid(mesh, density, rgb, tuple(hull(leg.reshape(-1, 3)) for leg in legs))


def slab(outline: Outline, bottom: float, top: float, density: float, rgb: Rgb) -> Solid:
    """A plate with a convex outline (x, y) between two heights [m]."""
    return loft(np.array([[(x, y, z) for x, y in outline] for z in (bottom, top)]), density, rgb)


def bar(outline: Outline, width: float, density: float, rgb: Rgb) -> Solid:
    """A bar along y with a convex outline (x, z) and a width [m] about y = 0."""
    return loft(np.array([[(x, y, z) for x, z in outline] for y in (-width / 2, width / 2)]), density, rgb)
