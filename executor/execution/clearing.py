"""Putting aside what is in the way on the board."""

from typing import TYPE_CHECKING

from executor.errors import RefusalError
from executor.execution.understood import Understood
from executor.free_places import Column, free_place
from executor.sight import Sight
from learning.interpretation import Goal
from twin.board import nearest_cell

if TYPE_CHECKING:
    from learning.graphs import ActionGraphlet


def put_aside(number: int, understood: Understood, sight: Sight, action: "ActionGraphlet") -> Goal:
    """The goal of moving one block out of the way.

    It goes to the nearest free place on the board that is neither where anything that matters stands nor where the
    command's block will go, so that it blocks nothing again.

    Args:
        number: Track number of the block.
        understood: The command.
        sight: What stands where now.
        action: How it is moved.

    Raises:
        RefusalError: There is no such place.
    """
    kept: set[Column] = set()
    for goal in understood.goals:
        if goal.position is not None:
            kept.add(nearest_cell(goal.position)[:2])
        if goal.object_id != number and goal.object_id != sight.held:
            kept.add(nearest_cell(sight.where(goal.object_id))[:2])
    place = free_place(sight, sight.where(number), kept)
    if place is None:
        raise RefusalError("there is no free place on the board to put it")
    return Goal(number, place, action)
