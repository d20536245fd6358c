"""Cutlery as small children have it: with a thick handle that two fingers can hold without touching the table.

The handle lies along x on the table; the head is at +x, a little above the table.
"""

import numpy as np

from .assembly import Blueprint
from .holds import pinch
from .model import Rgb
from .parts import hull, turned_part
from .solids import Solid, bar, box, slab, turned

PLASTIC = 1500.0
"""Density [kg/m^3], of melamine."""
_LENGTH, _WIDTH, _HEIGHT = 0.090, 0.013, 0.013
"""The handle [m]; it ends at x = 0 in a neck."""
_LIFT = 0.004
"""Height [m] of the head above the table: only the handle touches it."""
_HOLD = 0.008
"""Height [m] of the pads: 5 mm below the top of the handle, so that the finger tips clear the table."""


def fork(rgb: Rgb) -> Blueprint:
    """A fork with four tines, 155 mm long."""
    low, high = _LIFT, _LIFT + 0.004
    right = [(0.016, -0.004), (0.026, -0.012), (0.036, -0.012)]
    palm = slab([*right, *((x, -y) for x, y in reversed(right))], low, high, PLASTIC, rgb)
    sides = (-0.0102, -0.0034, 0.0034, 0.0102)
    tines = [box([0.026, 0.0036, high - low], [0.048, y, (low + high) / 2], PLASTIC, rgb) for y in sides]
    return _with_handle([palm, *tines], rgb)


def spoon(rgb: Rgb) -> Blueprint:
    """A spoon with an oval, hollow head, 150 mm long; to contact the shallow head is filled."""
    outside = [(0.0, 0.0), (0.006, 0.0005), (0.011, 0.003), (0.014, 0.007), (0.0150, 0.010)]
    inside = [(0.0135, 0.010), (0.0125, 0.0075), (0.0095, 0.0042), (0.005, 0.0025), (0.0, 0.0022)]
    round_head = turned([*outside, *inside], PLASTIC, rgb, [turned_part([*outside, (0.0, 0.010)])])
    stretch, move = np.array([1.5, 1.0, 1.0]), np.array([0.036, 0.0, _LIFT])
    mesh = round_head.mesh.copy()
    mesh.vertices = mesh.vertices * stretch + move
    filled = hull(round_head.parts[0].vertices * stretch + move)
    return _with_handle([Solid(mesh, PLASTIC, rgb, (filled,))], rgb)


def knife(rgb: Rgb) -> Blueprint:
    """A knife with a round-tipped blade, 155 mm long."""
    blade = [(0.010, -0.006), (0.050, -0.010), (0.060, -0.007), (0.066, 0.000), (0.065, 0.006), (0.010, 0.006)]
    return _with_handle([slab(blade, _LIFT, _LIFT + 0.004, PLASTIC, rgb)], rgb)


def _with_handle(head: list[Solid], rgb: Rgb) -> Blueprint:
    """Put a handle and a neck to a head that starts at about x = 15 mm."""
    half = _WIDTH / 2
    turns = np.deg2rad(np.linspace(90, 270, 7))
    end = [(half * np.cos(turn) - (_LENGTH - half), half * np.sin(turn)) for turn in turns]
    handle = slab([(0, -half), (0, half), *end], 0, _HEIGHT, PLASTIC, rgb)
    neck = bar([(0, 0.005), (0.022, _LIFT), (0.022, _LIFT + 0.004), (0, 0.011)], 0.007, PLASTIC, rgb)
    grasps = [pinch((-x, 0, _HOLD), (0, 1, 0), _WIDTH) for x in (0.030, 0.025, 0.035, 0.020)]
    return Blueprint([handle, neck, *head], grasps)
