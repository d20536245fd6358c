"""What is true of places, directions and distances: rules of geometry, as many classes as table 6.2 has.

Where the rules give no class an instance is not scored, neither for us nor for the SVM: nobody could say which of two
classes holds.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np

from robots.pose import FloatArray
from twin.board import BLOCK, CELL, CELLS, nearest_cell

SECTOR = np.deg2rad(30.0)
"""A horizontal direction has a class within this of one of the four sides [rad]; what is between two has none."""
STEEP = np.deg2rad(45.0)
"""Higher than this is above [rad]."""


@dataclass(frozen=True, slots=True)
class TrueDemo:
    """What is true of one demo, in the order of the observation's tracks. Only the scorer sees it.

    Attributes:
        properties: Space of a property to the class of each object, None where it has none, (N,).
        first: True centres before the action, (N, 3) [m].
        last: True centres after it, (N, 3) [m].
        action: What was done, None where it is not known.
    """

    properties: Mapping[str, tuple[str | None, ...]]
    first: FloatArray
    last: FloatArray
    action: str | None


@dataclass(frozen=True, slots=True)
class TruthRules:
    """The geometric rules of one robot's collection.

    Attributes:
        location: Class of a place (3,) [m], None where it has none.
        direction: Class of an offset (3,) [m], of one thing as seen from another.
        distance: Class of a distance [m]; None where the collection is not scored on it.
        other: Further rules by the name of a row of their own: the space they score, and their rule.
    """

    location: Callable[[FloatArray], str | None]
    direction: Callable[[FloatArray], str | None]
    distance: Callable[[float], str | None] | None = None
    other: Mapping[str, tuple[str, Callable[[FloatArray], str | None]]] = field(default_factory=dict)


def side_of(offset: FloatArray) -> str | None:
    """Front, back, left, right or above; None between two of them, and below.

    The robot looks along +x and left is +y. Nobody says of a thing that it is below what stands on it: the thesis has
    five directions.
    """
    x, y, z = (float(value) for value in offset)
    altitude = np.arctan2(z, np.hypot(x, y))
    if altitude > STEEP:
        return "above"
    if altitude < -STEEP:
        return None
    azimuth = float(np.arctan2(y, x))
    quarter = round(azimuth / (np.pi / 2))
    if abs(azimuth - quarter * np.pi / 2) > SECTOR:
        return None
    return ("front", "left", "back", "right")[quarter % 4]


def nearest_side(offset: FloatArray) -> str:
    """Front, back, left, right, above or below, whichever is nearest: every direction has a class."""
    x, y, z = (float(value) for value in offset)
    across = max(abs(x), abs(y))
    if abs(z) > np.hypot(x, y):
        return "above" if z > 0 else "below"
    if across == abs(x):
        return "front" if x > 0 else "back"
    return "left" if y > 0 else "right"


def board_side(offset: FloatArray) -> str | None:
    """`side_of` for blocks whose cells share a face: beside each other on one level, or one on top of the other."""
    steps = np.abs(np.round(np.asarray(offset) / (CELL, CELL, BLOCK)))
    return side_of(offset) if steps.sum() == 1 else None


def corner_of(place: FloatArray) -> str | None:
    """The board's four corners, the places that the commands name; elsewhere a place has no name of its own."""
    name = kind_of_place(place)
    if name != "corner":
        return None
    x, y, _ = nearest_cell(place)
    return f"{'front' if x > 0 else 'back'} {'left' if y > 0 else 'right'} corner"


def kind_of_place(place: FloatArray) -> str:
    """Corner, edge, centre (the four middle cells) or elsewhere: every cell of the board has a class."""
    x, y, _ = nearest_cell(place)
    outer = (x in (0, CELLS - 1)) + (y in (0, CELLS - 1))
    if outer:
        return "corner" if outer == 2 else "edge"
    middle = (CELLS // 2 - 1, CELLS // 2)
    return "centre" if x in middle and y in middle else "elsewhere"


BOARD_RULES = TruthRules(
    corner_of,
    board_side,
    other={"location, all": ("location", kind_of_place), "direction, all": ("direction", nearest_side)},
)
"""Nine colours, four shapes, four locations and five directions (table 6.2)."""


TABLE_X = 0.65
"""Middle of the part of the table where objects stand, from the robot [m]."""
TABLE_Y = 0.125
"""Half width of its middle third [m]."""
BANDS = (0.06, 0.17, 0.295, 0.42, 0.53)
"""Distances between the classes of distance [m]."""


def part_of_table(place: FloatArray) -> str | None:
    """One of six parts of the table: near or far, left, in the middle or right."""
    x, y, _ = (float(value) for value in place)
    if not np.isfinite(x):
        return None
    side = "left" if y > TABLE_Y else "right" if y < -TABLE_Y else "middle"
    return f"{'far' if x > TABLE_X else 'near'} {side}"


def band_of(distance: float) -> str | None:
    """One of six classes of distance, from touching to far."""
    if not np.isfinite(distance):
        return None
    return ("touching", "close", "near", "apart", "distant", "far")[int(np.searchsorted(BANDS, distance))]


def table_side(offset: FloatArray) -> str | None:
    """`side_of`, of things whose places are known."""
    return side_of(offset) if np.all(np.isfinite(offset)) else None


def no_class(_: FloatArray) -> None:
    """Nothing has a class: a lone object at any place of a counter (table 6.2)."""
    return


TABLE_RULES = TruthRules(part_of_table, table_side, band_of)
"""Six locations, five directions, six distances (table 6.2)."""
COUNTER_RULES = TruthRules(no_class, no_class)
"""Colours, shapes and actions only."""
