"""From a sentence and a percept to a goal by all its readings: the move that most of them together speak for."""

from collections import defaultdict
from collections.abc import Iterable

from learning.concept_id import OBJECT_SPACES, Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import CommandReading
from learning.grammar.scene import bits
from learning.grounding.reading_learner import LONGEST, MOST_WORDS, ReadingLearner, Readings
from learning.interpretation.interpretation import (
    ESTABLISHED,
    MEANINGFUL,
    Interpretation,
    listed,
    refusal,
    understanding,
)
from learning.knowledge import Knowledge
from learning.percept import Percept

NEGLIGIBLE = 1e-4
"""Readings with a smaller share have no say."""

Move = tuple[int, int | None]
"""Index of the moved thing and of the placement where it ends, None when it stays in the gripper."""


class ReadingInterpreter:
    """Reads sentences with what `ReadingLearner` learned."""

    def __init__(self, knowledge: Knowledge, language: ReadingLearner) -> None:
        """Use this knowledge and this part of it; neither is changed."""
        self.knowledge = knowledge
        self.language = language

    def interpret(self, words: tuple[str, ...], percept: Percept) -> Interpretation:
        """Find the move that the readings of a sentence speak for, each with its share over the moves it allows."""
        unknown = tuple(dict.fromkeys(word for word in words if not self.language.knows(word)))
        if len(words) > LONGEST:
            return refusal(words, f"the sentence has {len(words)} words; say it in at most {MOST_WORDS}", unknown[:10])
        scene = BoardElements(Arrangement.of(percept), self.knowledge.bearing_shapes())
        actions = self.knowledge.action_table()
        found = self.language.read(words, scene, actions)
        if not found.readings and len(found.kept) <= MOST_WORDS:
            found = self.language.read(words, scene, actions, open_minded=True)
        if not found.readings:
            return refusal(words, self._why_nothing(words, unknown, found, scene), unknown)
        votes = moves_of(found)
        move = max(votes, key=lambda each: votes[each])
        best = next(reading for reading in found.readings if reading.does(*move))
        return self._interpretation(words, unknown, found, best, move, votes[move], percept)

    def _interpretation(
        self,
        words: tuple[str, ...],
        unknown: tuple[str, ...],
        found: Readings,
        reading: CommandReading,
        move: Move,
        share: float,
        percept: Percept,
    ) -> Interpretation:
        number, (moved, _) = reading.action, move
        things = [thing for thing, _ in reading.moves]
        places = bits(next(places for thing, places in reading.moves if thing == moved))
        leaves = (leaf for phrase in reading.phrases() for leaf in phrase.leaves())
        used = {found.kept[position] for leaf in leaves for position in leaf.used}
        passed = tuple(dict.fromkeys(word for position, word in enumerate(words) if position not in used))
        return understanding(
            words,
            percept,
            (number, self.knowledge.spaces.actions[number]),
            move,
            (things, places),
            (unknown, tuple(word for word in passed if self._established(word))),
            self.language.tree(words, reading, found.kept),
            share,
            tuple(word for word in passed if word not in unknown and self.language.grounding.total(word) < ESTABLISHED),
        )

    def _established(self, word: str) -> Concept | None:
        grounding = self.language.grounding
        total = grounding.total(word)
        if total < ESTABLISHED:
            return None
        for concept, amount in grounding.counts[word].items():
            if concept is not None and concept.space in OBJECT_SPACES and amount / total >= MEANINGFUL:
                return concept
        return None

    def _why_nothing(
        self, words: tuple[str, ...], unknown: tuple[str, ...], found: Readings, scene: BoardElements
    ) -> str:
        """Name the words that were never heard, or whose meanings nothing in the scene has."""
        if len(found.kept) > MOST_WORDS:
            return f"the sentence has {len(words)} words, too many to read at once; say it in shorter ones"
        if not found.kept or set(unknown) == set(words):
            said = (
                f"never heard: {listed(unknown, quoted=False)}"
                if unknown
                else "none of its words was learned to mean anything"
            )
            return f"nothing of the sentence was understood ({said})"
        missing = self._absent(words, scene)
        if missing:
            return f"nothing in the scene fits {listed(missing)}"
        if unknown:
            return f"the words do not add up to something that can be done here; never heard {listed(unknown)}"
        return "the words do not add up to something that can be done in this scene"

    def _absent(self, words: Iterable[str], scene: BoardElements) -> tuple[str, ...]:
        found = []
        for word in dict.fromkeys(words):
            concept = self._established(word)
            if concept is not None and not scene.looking(concept):
                found.append(word)
        return tuple(found)


def moves_of(found: Readings) -> dict[Move, float]:
    """Share of every move: each reading's probability, spread over the moves that it allows."""
    votes: defaultdict[Move, float] = defaultdict(float)
    for reading, share in zip(found.readings, found.shares(), strict=True):
        if share < NEGLIGIBLE:
            continue
        for thing, places in reading.moves:
            if reading.ends_held:
                votes[thing, None] += share / reading.choices
            for place in bits(places):
                votes[thing, place] += share / reading.choices
    return votes
