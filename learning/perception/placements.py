"""Where a block would come to rest on the board: on top of each column of cells."""

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray
from twin.board import BLOCK, CELL, CELLS, cell_centre, nearest_cell


def column_of(location: FloatArray) -> int:
    """Index of the column of cells nearest to a place (3,) [m]: 8 x + y, in 0..63."""
    x, y, _ = nearest_cell(location)
    return int(np.clip(x, 0, CELLS - 1) * CELLS + np.clip(y, 0, CELLS - 1))


def landing_places(location: FloatArray, hanging: int | None) -> tuple[FloatArray, NDArray[np.int64]]:
    """Where a block let go above each of the 64 columns would come to rest.

    Whether it would stay there (on a sloped top) or may be put there (on itself) is not asked.

    Args:
        location: Object centres, (N, 3) [m].
        hanging: Index of the object that hangs in the gripper and so is part of no column, or None.

    Returns:
        Centres of the block at rest, (64, 3) [m], in the order of `column_of`; and the index of the object below it,
        -1 for the board, (64,).
    """
    places = np.array([cell_centre(x, y, 0) for x in range(CELLS) for y in range(CELLS)])
    support = np.full(CELLS * CELLS, -1, dtype=np.int64)
    for index in np.argsort(location[:, 2], kind="stable"):  # upwards: the topmost of a column is written last
        if index == hanging:
            continue
        column = column_of(location[index])
        level = nearest_cell(location[index])[2]
        support[column] = index
        places[column, 2] = (level + 1.5) * BLOCK
    return places, support


def clear_objects(location: FloatArray, hanging: int | None) -> NDArray[np.bool_]:
    """Whether nothing rests on each object, (N,): no other one stands above it within half a cell."""
    aside = np.linalg.norm(location[:, None, :2] - location[None, :, :2], axis=2)
    higher = location[None, :, 2] - location[:, None, 2] > 0.5 * BLOCK
    above = (aside < 0.5 * CELL) & higher
    if hanging is not None:
        above[:, hanging] = False
    return np.asarray(~np.any(above, axis=1))
