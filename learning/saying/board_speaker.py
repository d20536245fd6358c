"""Sentences about the board: the likeliest that are understood as they are meant."""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
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
from learning.saying.board_events import BoardEvents
from learning.saying.board_references import BoardReferences
from learning.saying.ordering import said_together
from learning.saying.phrasing import Phrasing
from learning.saying.reference import Destination, Reference
from learning.saying.saying import Saying
from learning.saying.wording import Wording, different, wording

TRIED = 12
"""Sentences that are read back before one is given up."""
PARTS_TRIED = 8
"""Ways to tell each part that are combined."""
CLARITY = 5.0
"""How much it counts that a sentence is understood as it is meant, next to how likely it is to be said."""
REFERENCES_TRIED = 60
"""Ways to refer to a thing that are put into words."""
WHERE = 6.0
"""How much better, in log probability, a phrase is that tells where a thing is, when that is asked."""

Part = TypeVar("Part", Reference, Destination)
Meant = TypeVar("Meant")


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

        def share(said: Wording) -> float:
            votes = moves_of(self.language.read(said.words, scene, table))
            return _lead(votes, (moved, placement))

        return _clearest(wordings, share)

    def thing(self, arrangement: Arrangement, thing: int) -> Saying | None:
        """Say where a block is, so that it is told from all others; None where no phrase was found that does."""
        scene = BoardElements(arrangement, self.knowledge.bearing_shapes())
        references = BoardReferences(scene, self._named, self._together, telling_where=True)
        fitting = [each for each in references.of_thing(thing) if each.mask == 1 << thing]
        wordings = []
        for each in fitting[:REFERENCES_TRIED]:
            said = self._say(each.tree)
            if said is not None:
                wordings.append(replace(said, score=said.score + WHERE) if each.located else said)

        def share(said: Wording) -> float:
            return _lead(read_thing(self.knowledge, self.language, said.words, scene), 1 << thing)

        return _clearest(wordings, share)

    def _say(self, tree: RclNode) -> Wording | None:
        return wording(tree, self.language.grammar, self.phrasing)

    def _likeliest(self, parts: Iterable[Part]) -> list[Part]:
        """The parts of a sentence that are the likeliest to be said, of the shortest."""
        rated = [(said.score, part) for part in islice(parts, REFERENCES_TRIED) if (said := self._say(part.tree))]
        return [part for _, part in sorted(rated, key=lambda each: -each[0])[:PARTS_TRIED]]


def _lead(shares: Mapping[Meant, float], meant: Meant) -> float:
    """Share of what is meant; 0 where something else is at least as likely."""
    share = shares.get(meant, 0.0)
    return share if share > max((each for key, each in shares.items() if key != meant), default=0.0) else 0.0


def _clearest(wordings: Iterable[Wording], share: Callable[[Wording], float]) -> Saying | None:
    """The sentence that is likely to be said and likely to be understood as it is meant; None where none would be."""
    best: Saying | None = None
    worth = -math.inf
    for number, said in enumerate(different(wordings, TRIED), start=1):
        if said.score <= worth:
            break  # no other can be better, however clear it is
        clear = share(said)
        if clear and said.score + CLARITY * math.log(clear) > worth:
            worth = said.score + CLARITY * math.log(clear)
            best = Saying(said.text, said.tree, said.score, clear, number)
    return best


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
