"""Places on the board where a block can be put aside."""

from collections.abc import Collection

import numpy as np

from executor.sight import Sight
from robots.pose import FloatArray
from twin import board

Column = tuple[int, int]
"""Cell (x, y) of the board."""


def free_place(sight: Sight, near: FloatArray, kept_free: Collection[Column]) -> FloatArray | None:
    """The free place on the board itself that is nearest to a point.

    Places with free cells beside them across the fingers come first, so that the hand has room; nothing is put on other
    blocks, as it is not known which of them bear something.

    Args:
        sight: What stands where.
        near: The point, (3,) [m].
        kept_free: Columns where nothing may be put.

    Returns:
        Where the block's centre would be, (3,) [m]; None where the board is full.
    """
    standing = [place for number, place in zip(sight.object_ids, sight.location, strict=True) if number != sight.held]
    taken = {board.nearest_cell(place)[:2] for place in standing}
    best: tuple[float, FloatArray] | None = None
    for x in range(board.CELLS):
        for y in range(board.CELLS):
            if (x, y) in taken or (x, y) in kept_free:
                continue
            place = board.cell_centre(x, y, 0)
            crowd = sum((x + dx, y + dy) in taken for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)))
            cost = float(np.linalg.norm(place[:2] - near[:2])) + crowd * board.CELL
            if best is None or cost < best[0]:
                best = (cost, place)
    return None if best is None else best[1]
