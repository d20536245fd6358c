"""A wrong outcome, marked so: the readings that led to it lose weight, and the next command is understood otherwise.

The weights follow the same gradient as in learning, away from what was done: features expected over the readings that
do anything else, minus features expected over those that do it (`learning.grammar.weights`).
"""

from collections import defaultdict
from dataclasses import dataclass
from typing import TYPE_CHECKING

from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import CommandReading
from learning.grammar.phrase import Feature
from learning.grounding.reading_learner import ReadingLearner
from learning.interpretation.reading_interpreter import moves_of

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.grammar.arrangement import Arrangement

STEPS = 20
"""Most steps down the gradient for one mark."""


@dataclass(frozen=True, slots=True)
class Deed:
    """What was done upon a sentence.

    Attributes:
        words: The words.
        arrangement: The board before.
        moved: Index of the block.
        place: Column where it was put, None where it was kept in the gripper.
    """

    words: tuple[str, ...]
    arrangement: "Arrangement"
    moved: int
    place: int | None


def unlearn(knowledge: "Knowledge", deed: Deed) -> bool:
    """Learn that a deed was not what the words say.

    Args:
        knowledge: Updated in place.
        deed: What was done.

    Returns:
        Whether the words are understood otherwise now; where they can mean nothing else, they are only trusted less.
    """
    language = knowledge.language
    if not isinstance(language, ReadingLearner):
        return False
    table = knowledge.action_table()
    for _ in range(STEPS):
        scene = BoardElements(deed.arrangement, knowledge.bearing_shapes())
        found = language.read(deed.words, scene, table)
        if not found.readings:
            return True
        votes = moves_of(found)
        if max(votes, key=lambda move: votes[move]) != (deed.moved, deed.place):
            return True
        gradient: defaultdict[Feature, float] = defaultdict(float)
        pairs = list(zip(found.readings, found.shares(), strict=True))
        wrong = [(each, share) for each, share in pairs if each.does(deed.moved, deed.place)]
        other = [(each, share) for each, share in pairs if not each.does(deed.moved, deed.place)]
        _add(gradient, wrong, -1.0)
        _add(gradient, other, 1.0)
        language.weights.follow(gradient)
        if not other:
            return False
    return False


def _add(gradient: defaultdict[Feature, float], readings: list[tuple[CommandReading, float]], sign: float) -> None:
    """Add the features of readings, each by its share among them."""
    total = sum(share for _, share in readings)
    for reading, share in readings:
        for feature in reading.all_features():
            gradient[feature] += sign * share / max(total, 1e-12)
