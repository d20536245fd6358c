"""Wooden toy blocks: cubes and cylinders."""

from .assembly import Blueprint
from .holds import from_above, pinch
from .model import Rgb
from .solids import box, drum

WOOD = 800.0
"""Density [kg/m^3]."""
_SIDE, _TALL = 0.033, 0.055


def cube(rgb: Rgb) -> Blueprint:
    """A cube of 33 mm."""
    solid = box([_SIDE] * 3, [0, 0, _SIDE / 2], WOOD, rgb)
    return Blueprint([solid], [pinch((0, 0, _SIDE / 2), closing, _SIDE) for closing in ((0, 1, 0), (1, 0, 0))])


def cylinder(rgb: Rgb) -> Blueprint:
    """A cylinder of 33 mm that stands 55 mm high."""
    return Blueprint([drum(_SIDE / 2, 0, _TALL, WOOD, rgb)], from_above(_SIDE, 0.6 * _TALL))
