"""The learned action that takes a thing and puts it down somewhere else, or what makes one up."""

from typing import TYPE_CHECKING

from executor.errors import RefusalError
from learning.graphs import ActionGraphlet

if TYPE_CHECKING:
    from learning import Knowledge


def carrying_action(knowledge: "Knowledge") -> tuple[int, ActionGraphlet]:
    """The learned action that takes a thing and puts it down somewhere else, with its number.

    Where there is none, one that takes a thing and one that puts it down, or just lets go of it, make it up: the number
    is that of the taking.

    Raises:
        RefusalError: No such actions were learned.
    """
    learned = dict(knowledge.spaces.actions.numbered)
    for number, graphlet in learned.items():
        first, last = graphlet.states[0], graphlet.states[-1]
        if not first.holds and not last.holds and _brings(graphlet):
            return number, graphlet
    taking = {n: each for n, each in learned.items() if not each.states[0].holds and each.states[-1].holds}
    leaving = [each for each in learned.values() if each.states[0].holds and not each.states[-1].holds]
    for number, take in taking.items():
        for leave in leaving:
            if _brings(leave):
                return number, take.followed_by(leave)
    for number, take in taking.items():
        for leave in leaving:
            # It is let go of on the ground: between the two it is carried to another place.
            if not take.states[-1].raised and not leave.states[0].raised:
                there = 1 + max(state.object_location for state in take.states)
                return number, ActionGraphlet.of((*take.states, *(state.at(there) for state in leave.states)))
    raise RefusalError("no action was learned that puts a thing somewhere else")


def _brings(graphlet: ActionGraphlet) -> bool:
    """Whether the object is carried to another place and stands there before it is let go of: dropping is none."""
    held = [state for state in graphlet.states if state.holds]
    return bool(held) and held[0].object_location != held[-1].object_location and not held[-1].raised
