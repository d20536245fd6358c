"""What comes of understanding a sentence: a goal, a tree, and an explanation."""

from collections.abc import Sequence
from dataclasses import dataclass, field

from learning.grammar.rcl import RclNode
from learning.graphs import ActionGraphlet
from learning.percept import Percept
from robots.pose import FloatArray

MEANINGFUL = 0.6
"""A word grounded in at least this share of its validations is not passed over without saying so."""
ESTABLISHED = 3.0
"""Validations after which that share is trusted."""

MOST_TOLD = 10
"""Words of one sort that an explanation names."""
LONGEST_TOLD = 30
"""Letters of a word that it shows."""


@dataclass(frozen=True, slots=True)
class Goal:
    """Which object ends where.

    Attributes:
        object_id: Track number of the object.
        position: Where its centre ends, (3,) [m], or None when it stays in the gripper.
        action: How that is done.
    """

    object_id: int
    position: FloatArray | None
    action: ActionGraphlet = field(repr=False)

    def __str__(self) -> str:
        """Tell the goal in one line."""
        where = "" if self.position is None else f" to {metres(self.position)}"
        return f"object {self.object_id}{where} by {self.action}"


@dataclass(frozen=True, slots=True)
class Interpretation:
    """How a sentence was understood in a scene.

    Attributes:
        words: The sentence's words; a node's `first` and `last` count them from 1.
        understood: Whether there is a goal.
        goals: What to do, in order; the most likely choice where the sentence leaves several.
        tree: The RCL tree Ψ, None when nothing was understood.
        explanation: What was understood, or why nothing was, in a sentence.
        unknown: Words and signs that were never heard.
        unlearned: Words that the reading passes over and that were heard too seldom to know if they mean something.
        unheeded: Words with a learned meaning that the reading had to pass over: nothing in the scene is that.
        object_candidates: Track numbers of all objects that the sentence may be about.
        place_candidates: All positions [m] that it may end at.
        confidence: Share of this reading among all readings, 0..1.
    """

    words: tuple[str, ...]
    understood: bool
    goals: tuple[Goal, ...]
    tree: RclNode | None
    explanation: str
    unknown: tuple[str, ...] = ()
    unheeded: tuple[str, ...] = ()
    object_candidates: tuple[int, ...] = ()
    place_candidates: tuple[FloatArray, ...] = ()
    confidence: float = 0.0
    unlearned: tuple[str, ...] = ()


def refusal(words: tuple[str, ...], why: str, unknown: tuple[str, ...] = ()) -> Interpretation:
    """Say why nothing was understood."""
    return Interpretation(words, False, (), None, why, unknown=unknown)


def understanding(
    words: tuple[str, ...],
    percept: Percept,
    action: tuple[int, ActionGraphlet],
    move: tuple[int, int | None],
    candidates: tuple[Sequence[int], Sequence[int]],
    passed: tuple[tuple[str, ...], tuple[str, ...]],
    tree: RclNode,
    confidence: float,
    unlearned: tuple[str, ...] = (),
) -> Interpretation:
    """Say what was understood.

    Args:
        words: The sentence.
        percept: The scene.
        action: Number and graphlet of the action.
        move: Indices of the moved object and of the placement where it ends, None when it stays in the gripper.
        candidates: Indices of all objects and of all placements that fit the words.
        passed: Words that were never heard, and words with a learned meaning that nothing in the scene has.
        tree: The RCL tree.
        confidence: Share of the reading among all, 0..1.
        unlearned: Words that are passed over and of which little is known.
    """
    number, graphlet = action
    moved, place = move
    objects, places = candidates
    unknown, unheeded = passed
    goal = Goal(int(percept.object_ids[moved]), None if place is None else percept.placements[place], graphlet)
    explanation = f"understood as action_{number}: object {goal.object_id}"
    explanation += " is kept in the gripper" if goal.position is None else f" to {metres(goal.position)}"
    if len(objects) > 1:
        explanation += f"; {len(objects)} objects fit the words"
    if len(places) > 1:
        explanation += f"; {len(places)} places fit the words"
    if unheeded:
        explanation += f"; nothing here fits {listed(unheeded)}"
    if unknown:
        explanation += f"; never heard {listed(unknown)}"
    return Interpretation(
        words=words,
        understood=True,
        goals=(goal,),
        tree=tree,
        explanation=explanation,
        unknown=unknown,
        unheeded=unheeded,
        object_candidates=tuple(int(percept.object_ids[each]) for each in objects),
        place_candidates=tuple(percept.placements[each] for each in places),
        confidence=confidence,
        unlearned=unlearned,
    )


def listed(words: tuple[str, ...], quoted: bool = True) -> str:
    """Write words, in quotes or not: the first few, and of long ones the beginning."""
    told = [word if len(word) <= LONGEST_TOLD else f"{word[:LONGEST_TOLD]}…" for word in words[:MOST_TOLD]]
    more = f" and {len(words) - MOST_TOLD} more" if len(words) > MOST_TOLD else ""
    return ", ".join(f"“{word}”" if quoted else word for word in told) + more


def metres(position: FloatArray) -> str:
    """Write a position."""
    return "(" + ", ".join(f"{value:.3f}" for value in position) + ") m"
