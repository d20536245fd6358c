"""How high the tool must be to pass over what stands on the board."""

import numpy as np

from robots.pose import FloatArray
from twin.board import BLOCK
from twin.state import WorldState

BESIDE = 0.065
"""Blocks whose centres are within this of the way, seen from above, count as on it: a block, its neighbour's half and
room for an imprecise hand [m]."""
BELOW_TOOL = 0.019
"""A held block and the finger tips reach this far below the tool [m]."""
ROOM = 0.012
"""What stays free between them and a tower [m]."""


def carry_height(state: WorldState, start: FloatArray, end: FloatArray, moved: int | None) -> float:
    """Lowest tool height [m] at which a straight way from `start` to `end` passes over everything.

    Args:
        state: The world.
        start: Where the way begins, seen from above, (3,) [m]; its height does not matter.
        end: Where it ends, (3,) [m].
        moved: The object that is moved and so is not in the way; None for none.
    """
    way = end[:2] - start[:2]
    length = float(way @ way)
    highest = 0.0
    for each in state.objects:
        if each.id == moved:
            continue
        where = each.pose_object_in_world.position
        off = where[:2] - start[:2]
        along = min(max(float(off @ way) / length, 0.0), 1.0) if length > 0.0 else 0.0
        if np.abs(off - along * way).max() < BESIDE:
            highest = max(highest, float(where[2]) + BLOCK / 2)
    return highest + BELOW_TOOL + ROOM
