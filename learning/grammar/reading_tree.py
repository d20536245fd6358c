"""The RCL tree Ψ of a reading (thesis 5.2): what it says, without what it denotes."""

from dataclasses import replace

from learning.concept_id import Concept
from learning.grammar.clauses import Clause, CommandReading
from learning.grammar.innate import COLLECTIVE, EXTREMES, FURTHEST, SIDES
from learning.grammar.innate import GROUP as KIND_GROUP
from learning.grammar.phrase import Phrase
from learning.grammar.rcl import RclNode

GROUP = "group"
"""Label of a word for a kind of thing that here speaks of several things at once ("the red and blue blocks")."""
LABELS = {"entity": "entity", "modifier": "spatial-relation", "measure": "measure", "shift": "spatial-relation"}


def tree_of(reading: CommandReading, kept: tuple[int, ...]) -> RclNode:
    """Write a reading as a tree.

    Args:
        reading: What was understood.
        kept: Positions in the sentence of the words that the reading's positions count.
    """
    events = tuple(_event(clause, kept) for clause in reading.clauses)
    return events[0] if len(events) == 1 else _node("sequence", events)


def _event(clause: Clause, kept: tuple[int, ...]) -> RclNode:
    children = []
    for part in clause.parts:
        if part is clause.goal:
            children.append(_node("destination", (_phrase(part, kept),)))
        else:
            children.append(_phrase(part, kept))
    return _node("event", tuple(children))


def _phrase(phrase: Phrase, kept: tuple[int, ...]) -> RclNode:
    if phrase.concept is not None:
        return RclNode(phrase.concept.space, phrase.concept, kept[phrase.used[0]] + 1, kept[phrase.used[-1]] + 1)
    parts: list[RclNode] = []
    for child in phrase.children:
        # A description of more than one step, and what a modifier was added to, are one entity in the tree.
        if child.label == phrase.label or child.label == "description":
            parts += _phrase(child, kept).children
        else:
            parts.append(_phrase(child, kept))
    if ("sense", "group") in phrase.features or ("sense", "group unsaid") in phrase.features:
        parts = [replace(part, label=GROUP) if part.label in ("shape", "reference") else part for part in parts]
    return _node(LABELS[phrase.label], tuple(_together(parts)))


def _together(parts: list[RclNode]) -> list[RclNode]:
    """Make one leaf of neighbours that name one thing: a side with "furthest", a stack with what it is made of."""
    found: list[RclNode] = []
    for part in parts:
        before = found[-1] if found else None
        joint = None if before is None else _joint(before, part)
        if before is not None and joint is not None:
            found[-1] = RclNode(joint.space, joint, before.first, part.last)
        else:
            found.append(part)
    return found


def _joint(one: RclNode, two: RclNode) -> Concept | None:
    """The concept that two neighbouring leaves together stand for."""
    for rank, side in ((one, two), (two, one)):
        if rank.concept == FURTHEST and side.concept in SIDES:
            return EXTREMES[side.concept.number]
    for whole, made_of in ((one, two), (two, one)):
        if whole.concept == COLLECTIVE and (made_of.concept == KIND_GROUP or made_of.label in ("shape", GROUP)):
            return COLLECTIVE
    return None


def _node(label: str, children: tuple[RclNode, ...]) -> RclNode:
    return RclNode(label, None, children[0].first, children[-1].last, children)
