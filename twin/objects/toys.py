"""Wooden toy blocks: cubes and cylinders."""

import numpy as np

from .assembly import Blueprint
from .holds import from_above, pinch
from .model import Rgb
from .solids import box, drum

WOOD = 800.0
"""Density [kg/m^3]."""
_SIDE, _TALL = 0.033, 0.055
_INTO = ((0, 0, -1), (0, 0, 1), (-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0))
"""Ways into a cube through each of its sides, that which is up at first before all others."""


def cube(rgb: Rgb) -> Blueprint:
    """A cube of 33 mm."""
    solid = box([_SIDE] * 3, [0, 0, _SIDE / 2], WOOD, rgb)
    # Whichever side is up: a cube that fell may lie on any.
    grasps = [pinch((0, 0, _SIDE / 2), across, _SIDE, into) for into in _INTO for across in _across(into)]
    return Blueprint([solid], grasps)


def cylinder(rgb: Rgb) -> Blueprint:
    """A cylinder of 33 mm that stands 55 mm high."""
    return Blueprint([drum(_SIDE / 2, 0, _TALL, WOOD, rgb)], from_above(_SIDE, 0.6 * _TALL))


def _across(into: tuple[int, int, int]) -> list[tuple[int, int, int]]:
    """The two directions of a cube's edges at a right angle to a way into it."""
    return [across for across in ((0, 1, 0), (1, 0, 0), (0, 0, 1)) if not np.dot(into, across)]
