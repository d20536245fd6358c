"""Toy fruit, small enough for a narrow gripper. Each has a flat place to stand on, as the toys have."""

from collections.abc import Sequence

import numpy as np

from robots.pose import FloatArray

from .assembly import Blueprint
from .holds import from_above, pinch
from .model import Rgb
from .parts import turned_part
from .solids import Solid, drum, loft, turned

FLESH = 1300.0
"""Density [kg/m^3]: of solid rubber, as the toys are, not of fruit."""
ROLLING = 0.001
"""Rolling friction [m] of what is round."""
_STALK = (0.30, 0.18, 0.08)
_BEND = 0.066
"""Radius [m] of a banana's middle line."""
_FLAT = float(np.cos(np.pi / 8))
"""How much nearer than its corners an octagon's sides are to its middle."""


def apple(rgb: Rgb) -> Blueprint:
    """An apple of 36 mm with a dent and a stalk on top."""
    outside = [(9, 0), (15, 4), (17.6, 10), (18, 16.5), (17, 23), (13.5, 29), (9, 31.5)]
    flesh = _fruit(outside, [(5, 31), (2, 28), (0, 27)], rgb)
    stalk = drum(0.0016, 0.026, 0.037, FLESH, _STALK)
    return Blueprint([flesh, stalk], from_above(0.036, 0.0165), ROLLING)


def pear(rgb: Rgb) -> Blueprint:
    """A pear of 36 mm, 51 mm high without its stalk."""
    belly = [(9, 0), (14.5, 3.5), (17.5, 10), (18, 16), (16.5, 23)]
    neck = [(13, 30), (10, 37), (9, 44), (7.5, 48.5), (4, 51)]
    flesh = _fruit(belly, [*neck, (0, 51.5)], rgb)
    top = _fruit(neck, [], rgb)
    stalk = drum(0.0016, 0.050, 0.058, FLESH, _STALK)
    return Blueprint([flesh, Solid(top.mesh, 0.0, None, top.parts), stalk], from_above(0.036, 0.016), ROLLING)


def banana(rgb: Rgb) -> Blueprint:
    """A banana that lies on its side, bent in the horizontal plane: 28 mm thick, 125 mm along its middle line."""
    corners = np.array([4, 6, 12, 15, 15, 15, 15, 12, 6, 3.5]) / 1000
    leg = 16.0
    turns = np.deg2rad([-57, -52, -40, -1.5 * leg, -leg / 2, leg / 2, 1.5 * leg, 40, 52, 56])
    height = corners.max() * _FLAT
    rings = np.array([_octagon(turn, radius, height) for turn, radius in zip(turns, corners, strict=True)])
    peel = loft(rings[1:-1], FLESH, rgb)
    ends = [loft(rings[:2], FLESH, _STALK), loft(rings[-2:], FLESH, _STALK)]
    # Held in the middle of the three straight legs of full thickness, whose flat sides are parallel.
    nearer = float(np.cos(np.deg2rad(leg / 2)))
    grasps = []
    for turn in np.deg2rad([0.0, -leg, leg]):
        x, y = float(np.cos(turn)), float(np.sin(turn))
        centre = (_BEND * nearer * x, _BEND * nearer * y, height)
        grasps.append(pinch(centre, (x, y, 0.0), 2 * height * nearer))
    return Blueprint([peel, *ends], grasps)


def _fruit(touched: Sequence[tuple[float, float]], rest: Sequence[tuple[float, float]], rgb: Rgb) -> Solid:
    """Turn a profile (radius, height) [mm] from the edge of its lowest, flat face to the top.

    Contact feels the convex hull of `touched`; `rest` is only drawn.
    """
    first = (0.0, touched[0][1])
    around = [(r / 1000, z / 1000) for r, z in [first, *touched]]
    outline = [(r / 1000, z / 1000) for r, z in [first, *touched, *(rest or [(0.0, touched[-1][1])])]]
    return turned(outline, FLESH, rgb, [turned_part(around)])


def _octagon(turn: float, radius: float, height: float) -> FloatArray:
    """Corners (8, 3) [m] of a banana's cross section, with flat sides below, above, inside and outside."""
    angles = (np.arange(8) + 0.5) * np.pi / 4
    out = _BEND + radius * np.cos(angles)
    return np.column_stack([out * np.cos(turn), out * np.sin(turn), height + radius * np.sin(angles)])
