"""Where a thing's middle is, and how large it is, from the side of it that a camera sees."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray, read_only

_ANGLES = np.deg2rad(np.arange(0.0, 90.0, 7.5))
_TURNS = np.stack((np.cos(_ANGLES), np.sin(_ANGLES)), axis=1)
"""Directions in which footprints are measured, (12, 2)."""
_TAILS = (0.02, 0.98)
"""Quantiles taken as the ends of what was seen: single pixels fly off edges."""
_FOOT, _TOP = 0.04, 0.96
_MOST_POINTS = 250
"""About so many points are looked at."""
STANDS = 0.020
"""What is seen down to this height [m] stands on the table: the foot's own edge is often too faint."""
_NEARLY_AS_DEEP = 0.55
"""A thing seen this deep, as part of its width, is taken to be as deep as wide: its far side is hidden."""
BELOW = 0.010
"""A thing seen less than this below the hand hides its lower end [m]."""
_FLAT = 0.6
"""Lower than this part of its width it hides nothing of itself."""


@dataclass(frozen=True, slots=True)
class UprightBox:
    """A box around a thing, upright, turned about the vertical as it fits best.

    Attributes:
        centre: Its middle in the world, (3,) [m].
        extent: Length, width (the shorter side) and height, (3,) [m].
        yaw: Direction of its length in the world, 0 .. π [rad].
    """

    centre: FloatArray
    extent: FloatArray
    yaw: float

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "centre", read_only(self.centre))
        object.__setattr__(self, "extent", read_only(self.extent))


def upright_box(
    points: FloatArray, eye: FloatArray, pitch: float, floor: float = 0.0, stands: bool = False
) -> UprightBox:
    """Fit a box to the seen side of a thing.

    The footprint is the smallest rectangle among several directions. What is tall and round hides its far side: where
    what was seen is nearly as deep as wide, the box is made as deep as wide.

    Args:
        points: At least one point of the thing, (n, 3) [m], z measured from the table.
        eye: Where the camera is, (3,) [m].
        pitch: Distance of neighbouring pixels at the thing [m]: points are the middles of pixels.
        floor: Height of the table [m].
        stands: Whether it stands on the table though its foot may be hidden.
    """
    points = points[:: max(len(points) // _MOST_POINTS, 1)]
    flat = points[:, :2]
    low, high = _ends(points[:, 2], _FOOT, _TOP)
    bottom = floor if stands or low < floor + STANDS else low
    height = max(float(high - bottom), 0.002)
    middle = flat.mean(axis=0)
    away = middle - eye[:2]
    away = away / (np.linalg.norm(away) + 1e-9)
    beside = np.array([-away[1], away[0]])
    off = flat - middle
    near, far = _ends(off @ away, *_TAILS)
    left, right = _ends(off @ beside, *_TAILS)
    width, depth = float(right - left) + pitch, float(far - near) + pitch
    hidden = 0.0
    if height > _FLAT * width and _NEARLY_AS_DEEP * width < depth < width:
        hidden = width - depth
    shift = 0.5 * hidden * away
    # the smallest rectangle around the points and the hidden far side
    if hidden > 0.0:
        centre = middle + 0.5 * (near + far) * away + 0.5 * (left + right) * beside + shift
        sides, yaw = np.array([width, width]), float(np.arctan2(away[1], away[0]))
    else:
        along, across = off @ _TURNS.T, off @ np.stack((-_TURNS[:, 1], _TURNS[:, 0]), axis=1).T
        a, b = _ends(along, *_TAILS), _ends(across, *_TAILS)
        area = (a[1] - a[0] + pitch) * (b[1] - b[0] + pitch)
        best = int(area.argmin())
        turn = _TURNS[best]
        normal = np.array([-turn[1], turn[0]])
        centre = middle + 0.5 * (a[0, best] + a[1, best]) * turn + 0.5 * (b[0, best] + b[1, best]) * normal
        sides, yaw = np.array([a[1, best] - a[0, best], b[1, best] - b[0, best]]) + pitch, float(_ANGLES[best])
    if sides[1] > sides[0]:
        sides, yaw = sides[::-1], yaw + np.pi / 2
    return UprightBox(np.append(centre, bottom + height / 2), np.append(sides, height), float(yaw % np.pi))


def held_points(seen: FloatArray, tool: FloatArray, opening: float) -> FloatArray:
    """Places (k, 3) [m] at which a thing between two fingers is felt, though hand and fingers hide it.

    It fills the gap between the fingers, and is taken to be as deep as that. Where nothing of it is seen below the
    hand, it is taken to be held by its middle.

    Args:
        seen: What is seen of it, (n, 3) [m].
        tool: The point between the fingers, (3,) [m].
        opening: The gap [m].
    """
    turns = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    around = tool + 0.5 * opening * np.column_stack((np.cos(turns), np.sin(turns), np.zeros(8)))
    top = float(np.max(seen[:, 2]))
    if float(np.min(seen[:, 2])) > tool[2] - BELOW and top > tool[2]:
        lower = around - [0.0, 0.0, min(top - tool[2], tool[2])]
        return np.concatenate((around, lower))
    return np.asarray(around)


def _ends(values: FloatArray, low: float, high: float) -> FloatArray:
    """Two quantiles of values (n, ...) along the first axis, (2, ...), as `numpy.quantile` gives, but much sooner."""
    ordered = np.sort(values, axis=0)
    place = np.array([low, high]) * (len(ordered) - 1)
    below = place.astype(np.int64)
    above = np.minimum(below + 1, len(ordered) - 1)
    part = (place - below).reshape(-1, *([1] * (ordered.ndim - 1)))
    return np.asarray(ordered[below] * (1 - part) + ordered[above] * part)
