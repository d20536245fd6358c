"""Sentences about the board: chosen by how probable they are, and said only if they are understood as they are meant."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import islice
from typing import TypeVar, cast

from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.phrase_chart import Denotation, PhraseChart
from learning.grammar.rcl import RclNode
from learning.grounding.reading_learner import MOST_WORDS, ReadingLearner
from learning.grounding.shares import shares_of
from learning.interpretation.reading_interpreter import moves_of
from learning.knowledge import Knowledge
from learning.saying.board_events import BoardEvents, Destination
from learning.saying.board_references import BoardReferences, Reference
from learning.saying.ordering import said_together
from learning.saying.phrasing import Phrasing
from learning.saying.wording import Wording, wording

TRIED = 12
"""Sentences that are read back before one is given up."""
PARTS_TRIED = 8
"""Ways to tell each part that are combined."""
CLEARLY = 0.9
"""A phrase is said at once when so large a share of its readings means what it should."""
REFERENCES_TRIED = 60
"""Ways to refer to a thing that are put into words."""
WHERE = 6.0
"""How much better, in log probability, a phrase is that tells where a thing is, when that is asked."""

Part = TypeVar("Part", Reference, Destination)


@dataclass(frozen=True, slots=True)
class Saying:
    """A sentence that is understood as it is meant.

    Attributes:
        text: The sentence.
        tree: Its meaning.
        score: Log probability of its words and order.
        share: Share of the readings that understand it as it is meant.
        tried: How many were put into words and read back before it was, itself included.
    """

    text: str
    tree: RclNode
    score: float
    share: float
    tried: int


class BoardSpeaker:
    """Says what was shown on a board, and where things are."""

    def __init__(self, knowledge: Knowledge, language: ReadingLearner, phrasing: Phrasing) -> None:
        """Speak by what was learned; it is not changed."""
        self.knowledge = knowledge
        self.language = language
        self.phrasing = phrasing
        self._together = said_together(language.grammar, "entity")
        self._named = frozenset(concept for concept in phrasing.names if phrasing.names_of(concept))

    def event(self, arrangement: Arrangement, action: int, moved: int, placement: int | None) -> Saying | None:
        """Say what is done to a block; None where no sentence was found that is understood so.

        Args:
            arrangement: The board before.
            action: Number of the action.
            moved: Index of the block.
            placement: Where it ends, None when it stays in the gripper.
        """
        scene = BoardElements(arrangement, self.knowledge.bearing_shapes())
        table = self.knowledge.action_table()
        events = BoardEvents(scene, table, BoardReferences(scene, self._named, self._together))
        things = self._likeliest(events.movable(moved, action))
        goals: list[Destination | None] = []
        if placement is None or table.starts_held[action]:
            goals.append(None)
        if placement is not None:
            goals += self._likeliest(events.destinations(moved, placement, action))
        trees = (tree for thing in things for goal in goals for tree in events.commands(action, thing, goal))
        wordings = (said for tree in trees if (said := self._say(tree)) is not None)
        best: Saying | None = None
        for number, said in enumerate(_best(wordings), start=1):
            votes = moves_of(self.language.read(said.words, scene, table))
            share = votes.get((moved, placement), 0.0)
            if share and share == max(votes.values()) and (best is None or share > best.share):
                best = Saying(said.text, said.tree, said.score, share, number)
            if share > CLEARLY:
                break
        return best

    def thing(self, arrangement: Arrangement, thing: int) -> Saying | None:
        """Say where a block is, so that it is told from all others; None where no phrase was found that does."""
        scene = BoardElements(arrangement, self.knowledge.bearing_shapes())
        fitting = [each for each in BoardReferences(scene, self._named, self._together).of_thing(thing) if each.mask == 1 << thing]
        wordings = []
        for each in fitting[:REFERENCES_TRIED]:
            said = self._say(each.tree)
            if said is not None:
                wordings.append(replace(said, score=said.score + WHERE) if each.located else said)
        best: Saying | None = None
        for number, said in enumerate(_best(wordings), start=1):
            shares = read_thing(self.knowledge, self.language, said.words, scene)
            share = shares.get(1 << thing, 0.0)
            if share > max((each for mask, each in shares.items() if mask != 1 << thing), default=0.0) and (best is None or share > best.share):
                best = Saying(said.text, said.tree, said.score, share, number)
            if share > CLEARLY:
                break
        return best

    def _say(self, tree: RclNode) -> Wording | None:
        return wording(tree, self.language.grammar, self.phrasing)

    def _likeliest(self, parts: Iterable[Part]) -> list[Part]:
        """The parts of a sentence that are the likeliest to be said, of the shortest."""
        rated = [(said.score, part) for part in islice(parts, REFERENCES_TRIED) if (said := self._say(part.tree))]
        return [part for _, part in sorted(rated, key=lambda each: -each[0])[:PARTS_TRIED]]


def _best(wordings: Iterable[Wording]) -> list[Wording]:
    """The likeliest of different sentences, the best first."""
    found: dict[tuple[str, ...], Wording] = {}
    for each in wordings:
        if each.words not in found or found[each.words].score < each.score:
            found[each.words] = each
    return sorted(found.values(), key=lambda each: -each.score)[:TRIED]


def read_thing(
    knowledge: Knowledge, language: ReadingLearner, words: tuple[str, ...], scene: BoardElements
) -> dict[int, float]:
    """What a phrase denotes: sets of elements, as masks, with the shares of the readings that mean them."""
    found = language.uses_of(words, knowledge.action_table())
    size = len(found.kept)
    if size > MOST_WORDS:
        return {}
    chart = PhraseChart(size, found.uses, found.passed, language.weights.of, scene)
    best: dict[int, float] = {}
    for first in range(size):
        cell = chart.cells[first][size]
        for phrase in () if cell is None else cell.get("entity", ()):
            elements, nearest, _ = cast(Denotation, phrase.meaning)
            mask = scene.nearest_to_robot(elements) if nearest else elements
            best[mask] = max(best.get(mask, float("-inf")), phrase.score + chart.passed[first])
    return dict(zip(best, shares_of(list(best.values())), strict=True))
