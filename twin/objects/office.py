"""Things from an office: markers, staplers, rolls of tape."""

from collections.abc import Sequence

import numpy as np

from .assembly import Blueprint
from .holds import from_above, pinch
from .model import Rgb
from .parts import ring_parts
from .solids import Solid, bar, box, loft, turned

_GREY = (0.75, 0.75, 0.75)
_DARK = (0.12, 0.12, 0.12)
_CARDBOARD = (0.72, 0.58, 0.40)
_STEEL = (0.55, 0.55, 0.58)
_FILM = 1500.0
"""Density [kg/m^3] of wound film."""
_INK = 1000.0
"""Density [kg/m^3] of a marker."""
_FLAT = float(np.cos(np.pi / 8))
"""How much nearer than its corners an octagon's sides are to its middle."""
_FEET = (0, 5, 11)
"""The segments with which a roll of tape touches the table; the others begin 3 mm higher, which nobody sees and makes
physics faster."""


def marker(rgb: Rgb) -> Blueprint:
    """A felt pen with eight flat sides 17 mm apart, lying along x, 125 mm long, its cap at +x."""
    thick = 0.017
    dull = (0.55 * rgb[0], 0.55 * rgb[1], 0.55 * rgb[2])
    back, front = [(-0.060, 0.014), (-0.057, thick), (0.018, thick)], [(0.023, thick), (0.060, thick), (0.065, 0.011)]
    collar = _barrel([(0.018, 0.0145), (0.023, 0.0145)], thick, _GREY)
    # To contact it is one piece.
    touched = Solid(collar.mesh, collar.density, _GREY, _barrel([*back, *front], thick, _GREY).parts)
    body, cap = (Solid(_barrel(end, thick, rgb).mesh, _INK, colour) for end, colour in ((back, rgb), (front, dull)))
    # Whichever side is up: a marker that was put down may have rolled.
    turns = [np.pi / 4 * side for side in (0, 1, -1, 2, -2, 3, -3, 4)]
    grasps = [
        pinch((x, 0, thick / 2), (0, np.cos(turn), np.sin(turn)), thick, (0, np.sin(turn), -np.cos(turn)))
        for turn in turns
        for x in (0.0, -0.012, -0.024)
    ]
    return Blueprint([body, touched, cap], grasps)


def stapler(rgb: Rgb) -> Blueprint:
    """A stapler, 120 mm long, its hinge at -x; held by its arm."""
    density, width = 900.0, 0.028
    base = box([0.120, 0.032, 0.008], [0, 0, 0.004], density, _DARK)
    side = [(-0.058, 0.008), (-0.036, 0.008), (-0.036, 0.032), (-0.052, 0.032), (-0.058, 0.026)]
    hinge = bar(side, 0.022, density, _STEEL)
    magazine = bar([(-0.040, 0.024), (-0.040, 0.018), (0.052, 0.014), (0.052, 0.020)], 0.016, density, _STEEL)
    side = [(-0.050, 0.026), (0.056, 0.020), (0.060, 0.023), (0.058, 0.031), (-0.030, 0.043), (-0.050, 0.041)]
    arm = bar(side, width, density, rgb)
    grasps = [pinch((x, 0, 0.030), (0, 1, 0), width) for x in (-0.006, 0.006, -0.018)]
    return Blueprint([base, hinge, magazine, arm], grasps)


def tape(rgb: Rgb) -> Blueprint:
    """A small roll of sticky tape that lies flat, 36 mm wide and 24 mm high."""
    outer, core, inner, height = 0.018, 0.010, 0.009, 0.024
    section = [(core, 0.0), (outer, 0.0), (outer, height), (core, height)]
    lining = [(inner, 0.0005), (core, 0.0005), (core, height - 0.0005), (inner, height - 0.0005)]
    low, high = (ring_parts([(inner, z), (outer, z), (outer, height), (inner, height)]) for z in (0.0, 0.003))
    parts = [low[at] if at in _FEET else high[at] for at in range(len(low))]
    roll = turned([*section, section[0]], _FILM, rgb, parts)
    cardboard = turned([*lining, lining[0]], _FILM, _CARDBOARD)
    return Blueprint([roll, cardboard], from_above(2 * outer, 0.014))


def _barrel(profile: Sequence[tuple[float, float]], thick: float, rgb: Rgb) -> Solid:
    """One convex solid through octagons at (x, distance of two flat sides) [m], its axis at half of `thick`."""
    angles = (np.arange(8) + 0.5) * np.pi / 4
    ring = np.column_stack([np.zeros(8), np.cos(angles), np.sin(angles)]) / (2 * _FLAT)
    rings = np.array([ring * across + [x, 0, thick / 2] for x, across in profile])
    return loft(rings, _INK, rgb, one_part=True)
