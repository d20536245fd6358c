"""Places of the board (innate): which cells they take up, and how far every cell is from them, in cells."""

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from learning.concept_id import Concept
from learning.grammar.innate import CENTRE, CORNER, EDGE, REGION, SELF, WHOLE
from twin.board import CELLS

LAST = CELLS - 1


@dataclass(frozen=True, slots=True)
class Place:
    """One place.

    Attributes:
        kind: Corner, edge, region, centre, the whole board, or the robot.
        sides: Sides it lies towards, as positions in `SIDES`.
        cells: Columns that are part of it, as a mask.
        distance: How far each column is from it [cells], (64,).
    """

    kind: Concept
    sides: frozenset[int]
    cells: int
    distance: tuple[float, ...]


@cache
def board_places() -> tuple[Place, ...]:
    """All places of the board, in a fixed order."""
    x, y = (axis.ravel().astype(np.float64) for axis in np.mgrid[0:CELLS, 0:CELLS])
    off = (LAST - x, x, LAST - y, y)
    aside = np.maximum(np.abs(x - LAST / 2), np.abs(y - LAST / 2))
    places = [
        _place(CORNER, (deep, wide), np.hypot(off[deep], off[wide]), (off[deep] == 0) & (off[wide] == 0))
        for deep in (0, 1)
        for wide in (2, 3)
    ]
    places += [_place(EDGE, (side,), off[side], off[side] == 0) for side in range(4)]
    places += [_place(REGION, (side,), off[side], off[side] < CELLS / 2) for side in range(4)]
    places.append(_place(CENTRE, (), np.hypot(x - LAST / 2, y - LAST / 2), aside < 1))
    places.append(_place(WHOLE, (), np.zeros_like(x), np.ones_like(x, dtype=bool)))
    # The robot stands before the whole width of the board: only how far away something is counts.
    places.append(_place(SELF, (), x + 1.0, np.zeros_like(x, dtype=bool)))
    return tuple(places)


def _place(kind: Concept, sides: tuple[int, ...], distance: NDArray[np.float64], inside: NDArray[np.bool_]) -> Place:
    cells = sum(1 << int(index) for index in np.flatnonzero(inside))
    return Place(kind, frozenset(sides), cells, tuple(distance.tolist()))
