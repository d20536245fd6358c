"""What is in the way of a move on the board, and where the move ends once that is gone."""

from typing import TYPE_CHECKING

import numpy as np

from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import ABOVE
from learning.grammar.phrase_chart import Modifier
from learning.grammar.scene import bits
from learning.interpretation import Goal
from twin.board import BLOCK, CELLS, cell_centre

if TYPE_CHECKING:
    from learning.graphs import ActionGraphlet
    from learning.percept import Percept


def stack_at(arrangement: Arrangement, column: int) -> list[int]:
    """Indices of the blocks that stand in a column, from the board upwards."""
    here = [i for i, each in enumerate(arrangement.columns) if each == column and i != arrangement.held]
    return sorted(here, key=lambda index: arrangement.levels[index])


def blocking(
    scene: BoardElements,
    arrangement: Arrangement,
    bearing: frozenset[int],
    moved: int,
    place: int | None,
    meaning: Modifier | None,
) -> tuple[tuple[int, ...], int | None]:
    """Find what has to go before a block can be moved to a column.

    Args:
        scene: The board's elements.
        arrangement: How the blocks stand.
        bearing: Shape concepts that something can rest on.
        moved: Index of the block to move.
        place: Column where it should end; None where it is only taken.
        meaning: How the destination was told; what it says to put the block on stays.

    Returns:
        Indices of what is in the way, in the order in which it can be moved; and of the block that the moved one will
        stand on, None for the board.
    """
    found: list[int] = []
    if arrangement.held != moved:
        own = stack_at(arrangement, arrangement.columns[moved])
        found += reversed(own[own.index(moved) + 1 :])
    if place is None:
        return tuple(found), None
    stack = stack_at(arrangement, place)
    base = len(stack)
    told = _told_by(scene, stack, meaning)
    if told is not None:
        base = stack.index(told) + 1
    else:
        while base and arrangement.shapes[stack[base - 1]] not in bearing:
            base -= 1
    in_column = [index for index in reversed(stack[base:]) if index not in found]
    if in_column and arrangement.held is not None and arrangement.held not in found:
        found.append(arrangement.held)  # the hand has to be free to clear
    return tuple(dict.fromkeys((*found, *in_column))), stack[base - 1] if base else None


def _told_by(scene: BoardElements, stack: list[int], meaning: Modifier | None) -> int | None:
    """The uppermost block of a column that something is to be put on, where that was said."""
    if meaning is None or meaning.relation != ABOVE or meaning.steps:
        return None
    grounds = [each for each in bits(meaning.ground) if each < scene.count and each in stack]
    return max(grounds, key=stack.index) if grounds else None


def goal_of(percept: "Percept", graphlet: "ActionGraphlet", moved: int, place: int | None, base: int | None) -> Goal:
    """The goal that a move has once nothing is in the way.

    Args:
        percept: What is seen.
        graphlet: How it is done.
        moved: Index of the block.
        place: Column where it ends, None where it stays in the gripper.
        base: Index of the block that it will stand on, None for the board.
    """
    object_id = int(percept.object_ids[moved])
    if place is None:
        return Goal(object_id, None, graphlet)
    x, y = divmod(place, CELLS)
    position = np.array(cell_centre(x, y, 0))
    if base is not None:
        position[2] = percept.location[base][2] + BLOCK
    return Goal(object_id, position, graphlet)
