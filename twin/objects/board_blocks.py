"""The blocks of the board as objects: cubes, prisms, spheres and cylinders, all equally wide and high."""

from ..board import BLOCK, CUBE_MASS
from .assembly import Blueprint
from .holds import from_above, pinch
from .model import Rgb
from .solids import ball, bar, box, drum

DENSITY = CUBE_MASS / BLOCK**3
"""Of all blocks [kg/m^3]."""
ROLLING = 0.001
"""Rolling friction [m] of spheres and cylinders: a sphere stays on a slope of 3 degrees and stops from 0.05 m/s within
4 mm."""
_HALF = BLOCK / 2
_SIDES = ((0, 1, 0), (1, 0, 0))


def cube(rgb: Rgb) -> Blueprint:
    """A cube."""
    solid = box([BLOCK] * 3, [0, 0, _HALF], DENSITY, rgb)
    grasps = [pinch((0, 0, _HALF), side, BLOCK) for side in _SIDES]
    return Blueprint([solid], grasps, rolling_friction=0.0, spinning_friction=0.0)


def prism(rgb: Rgb) -> Blueprint:
    """A prism whose ridge lies along y; it is held by its upright end faces."""
    solid = bar([(-_HALF, 0.0), (_HALF, 0.0), (0.0, BLOCK)], BLOCK, DENSITY, rgb)
    grasps = [pinch((0, 0, height), (0, 1, 0), BLOCK) for height in (BLOCK / 3, _HALF)]
    return Blueprint([solid], grasps, rolling_friction=0.0, spinning_friction=0.0)


def sphere(rgb: Rgb) -> Blueprint:
    """A sphere."""
    return Blueprint([ball(_HALF, [0, 0, _HALF], DENSITY, rgb)], from_above(BLOCK, _HALF), ROLLING)


def cylinder(rgb: Rgb) -> Blueprint:
    """An upright cylinder."""
    return Blueprint([drum(_HALF, 0.0, BLOCK, DENSITY, rgb)], from_above(BLOCK, _HALF), ROLLING)
