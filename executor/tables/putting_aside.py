"""Putting aside what is in the way of a goal at a table, one thing after the other."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.actions.carrying import carrying_action
from executor.errors import RefusalError
from executor.execution.answer import Answer
from executor.report import Outcome, joined
from executor.tables.clearing import covering, places_aside
from executor.tables.places import Spot, best_apart
from learning.interpretation.interpretation import Goal

if TYPE_CHECKING:
    from executor.tables.table_runner import TableRunner
    from executor.tables.table_view import TableView
    from learning import Knowledge


@dataclass(frozen=True, slots=True)
class PutAside:
    """How a thing was put aside.

    Attributes:
        number: Its number; None where nothing could be.
        answer: How a command is answered that needed it.
        outcome: What the last look showed; None where nothing could be begun.
        reason: Why nothing could be put aside, in plain words; or what happened on the way.
    """

    number: int | None
    answer: Answer
    outcome: Outcome | None
    reason: str


def put_aside(
    numbers: Sequence[int],
    goal: Goal,
    kept_free: Spot | None,
    view: "TableView",
    runner: "TableRunner",
    knowledge: "Knowledge",
) -> PutAside:
    """Put aside the first of some things that can be: those after it are looked at again later.

    Args:
        numbers: Numbers of the things that are in the way, the one to begin with first.
        goal: What they are in the way of.
        kept_free: Where its thing shall go; None where it goes nowhere.
        view: What is seen of the table.
        runner: Who carries goals out.
        knowledge: What was learned.
    """
    if view.held is not None:
        return PutAside(None, Answer.IMPOSSIBLE, None, "the hand holds another thing; say where to put that one first")
    try:
        action, graphlet = carrying_action(knowledge)
    except RefusalError as refusal:
        return PutAside(None, Answer.IMPOSSIBLE, None, str(refusal))
    moved = view.index_of(goal.object_id)
    reason = "it is not seen any more"
    for number in numbers:
        index = view.index_of(number)
        if index is None or moved is None or covering(index, view.things, knowledge):
            continue
        spots = best_apart(places_aside(index, moved, kept_free, view.things, knowledge))
        if not spots:
            reason = "there is no free place for it"
            continue
        run = runner.carry_out(Goal(number, spots[0].position, graphlet), action, spots, view)
        if run.outcome is None:
            reason = run.note
            continue
        if run.outcome.right:
            return PutAside(number, run.answer, run.outcome, run.note)
        return PutAside(None, run.answer, run.outcome, joined(run.outcome.explanation, run.note))
    return PutAside(None, Answer.IMPOSSIBLE, None, reason)
