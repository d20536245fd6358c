"""Putting aside what is in the way on the board."""

from typing import TYPE_CHECKING

from executor.errors import RefusalError
from executor.execution.understood import Understood
from executor.free_places import Column, free_place
from executor.sight import Sight
from learning.interpretation import Goal
from twin.board import nearest_cell

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.graphs import ActionGraphlet


def carrying_action(knowledge: "Knowledge") -> "ActionGraphlet":
    """The learned action that takes a block and puts it down somewhere else.

    Raises:
        RefusalError: None was learned, nor two that make one together.
    """
    table = knowledge.action_table()
    graphlets = dict(knowledge.spaces.actions.numbered)
    whole = [number for number in graphlets if not table.starts_held[number] and not table.ends_held[number]]
    for number in whole:
        if any(state.holds for state in graphlets[number].states):
            return graphlets[number]
    takes = [number for number in graphlets if not table.starts_held[number] and table.ends_held[number]]
    drops = [number for number in graphlets if table.starts_held[number] and not table.ends_held[number]]
    if takes and drops:
        return graphlets[takes[0]].followed_by(graphlets[drops[0]])
    raise RefusalError("no action was learned that puts a block somewhere else")


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
