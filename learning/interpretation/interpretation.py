"""What comes of understanding a sentence: a goal, a tree, and an explanation."""

from dataclasses import dataclass

from learning.grammar.rcl import RclNode
from learning.graphs import ActionGraphlet
from robots.pose import FloatArray


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
    action: ActionGraphlet


@dataclass(frozen=True, slots=True)
class Interpretation:
    """How a sentence was understood in a scene.

    Attributes:
        words: The sentence's words; a node's `first` and `last` count them from 1.
        understood: Whether there is a goal.
        goals: What to do, in order; the most likely choice where the sentence leaves several.
        tree: The RCL tree Ψ, None when nothing was understood.
        explanation: What was understood, or why nothing was, in a sentence.
        unknown: Words that were never heard.
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


def refusal(words: tuple[str, ...], why: str, unknown: tuple[str, ...] = ()) -> Interpretation:
    """Say why nothing was understood."""
    return Interpretation(words, False, (), None, why, unknown=unknown)


def listed(words: tuple[str, ...]) -> str:
    """Write words in quotes."""
    return ", ".join(f"“{word}”" for word in words)


def metres(position: FloatArray) -> str:
    """Write a position."""
    return "(" + ", ".join(f"{value:.3f}" for value in position) + ") m"
