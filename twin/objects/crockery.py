"""Bowls and mugs, held by the rim; mugs by the handle too. Their walls are rings of convex segments."""

import numpy as np

from robots.pose import FloatArray

from .assembly import Blueprint
from .holds import pinch, rim
from .model import Rgb
from .parts import ring_parts, turned_part
from .solids import loft, turned

PLASTIC = 1100.0
"""Density [kg/m^3] of camping crockery."""
CLEAR = 0.004
"""Height [m] above which walls begin for contact: only the bottom touches the table, which keeps physics fast."""
_DEPTH = 0.012
"""How far [m] below the rim the pads hold."""
_HANDLE = (14, 15, 0, 1, 2)
"""Sixteenths of a turn that a mug's handle takes."""


def bowl(rgb: Rgb) -> Blueprint:
    """A bowl of 100 mm, 46 mm high, with an upright rim."""
    outer, inner, height, bend = 0.050, 0.046, 0.046, 0.022
    foot = [(0.0, 0.0), (0.024, 0.0), (0.026, 0.005), (0.0, 0.005)]
    belly = [(0.027, CLEAR), (0.041, 0.011), (0.0475, 0.0165), (outer, bend)]
    slope = [*belly, (inner, bend + 0.0025), (0.0235, 0.005)]
    wall = [(outer, bend), (outer, height), (inner, height), (inner, bend)]
    outside = [(0.0, 0.0), (0.024, 0.0), *belly, (outer, height)]
    profile = [*outside, (inner, height), (inner, bend + 0.0025), (0.0235, 0.005), (0.0, 0.005)]
    parts = [turned_part(foot), *ring_parts(slope), *ring_parts(wall)]
    return Blueprint([turned(profile, PLASTIC, rgb, parts)], rim(outer, inner, height - _DEPTH))


def mug(rgb: Rgb) -> Blueprint:
    """A mug of 70 mm, 75 mm high, with a handle at +x."""
    outer, inner, height = 0.035, 0.031, 0.075
    bottom = [(0.0, 0.0), (0.032, 0.0), (0.0335, 0.005), (0.0, 0.005)]
    wall = [(0.0337, CLEAR), (outer, 0.008), (outer, height), (inner, height), (inner, CLEAR)]
    profile = [
        *[(0.0, 0.0), (0.032, 0.0), (outer, 0.008), (outer, height)],
        *[(inner, height), (inner, 0.007), (0.029, 0.005), (0.0, 0.005)],
    ]
    body = turned(profile, PLASTIC, rgb, [turned_part(bottom), *ring_parts(wall)])
    # The handle's middle line, from the wall round to the wall.
    path = np.array([(0.033, 0.062), (0.049, 0.061), (0.057, 0.052), (0.057, 0.032), (0.049, 0.022), (0.033, 0.020)])
    strap, thick = 0.010, 0.007
    handle = loft(_strap(path, strap, thick), PLASTIC, rgb)
    holds = rim(outer, inner, height - _DEPTH, leave_out=_HANDLE)
    return Blueprint([body, handle], [pinch((0.057, 0, 0.045), (0, 1, 0), strap), *holds])


def _strap(path: FloatArray, width: float, thick: float) -> FloatArray:
    """Rings (n, 4, 3) around a line (n, 2) in the x-z plane, for a strap of this width along y."""
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.column_stack([-along[:, 1], along[:, 0]]) * thick / 2
    sides = ((1, -width / 2), (1, width / 2), (-1, width / 2), (-1, -width / 2))
    corners = [np.insert(path + sign * across, 1, y, axis=1) for sign, y in sides]
    return np.stack(corners, axis=1)
