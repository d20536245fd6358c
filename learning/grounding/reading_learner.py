"""Words and grammar from before and after alone: alignment, readings, and what of them did what was shown.

A sentence is aligned with what was salient. It is read in all ways that its words and the scene allow, and the readings
that do what was shown are credited: one that leaves k moves open predicted the one that was shown with probability 1/k.
Credit goes to Φ (which words were used for what, or passed over), to Π (which rules) and to the weights. A few
sentences of the recent past are looked at again after each new one, so that early ones are understood with what came
later.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import CommandReading, read_clauses
from learning.grammar.description import Description, Sense
from learning.grammar.pcfg import Pcfg
from learning.grammar.phrase import Feature
from learning.grammar.phrase_chart import PhraseChart
from learning.grammar.rcl import RclNode
from learning.grammar.reading_tree import tree_of
from learning.grammar.weights import Weights
from learning.grounding.alignment import ENOUGH, Alignment, Meaning
from learning.grounding.attention import salient_meanings, ways_of_speaking
from learning.grounding.collocations import Collocations
from learning.grounding.credit import LEAST_SHARE, add_features, grounded_words, right_readings
from learning.grounding.grounding import Grounding
from learning.grounding.memory import LARGEST, Episode, Memory
from learning.grounding.shares import shares_of
from learning.grounding.word_uses import UseTable, WordUses
from learning.percept import ShownAction
from learning.saved_numbers import saved_count

MOST_WORDS = 40
"""Words that may mean something in the longest sentence that is read; the time grows with their third power."""
LONGEST = 300
"""Words of the longest sentence that is looked at."""
REPLAYS = 1
"""Earlier sentences that are read again after a new one."""
REALIGNED = 20
"""Earlier sentences that are aligned again after a new one."""
LISTENING = 32
"""Sentences that are aligned alone before any is read."""
FRESH_STARTS = (LISTENING, 128, 512, LARGEST)
"""Numbers of sentences at which all that reading had taught is forgotten and the memory is read afresh: what was read
while words could mean nearly anything would mislead for ever."""
SWEEPS = 6
"""How often the memory is aligned again before it is read afresh."""
SELDOM = 60.0
"""Words heard so often at most are aligned from nothing before the memory is read afresh."""


@dataclass(frozen=True, slots=True)
class Readings:
    """How a sentence can be read in a scene.

    Attributes:
        readings: Readings, best first.
        kept: Positions in the sentence of the words that the readings' positions count.
    """

    readings: tuple[CommandReading, ...]
    kept: tuple[int, ...]

    def shares(self) -> list[float]:
        """Probability of each reading."""
        return shares_of([reading.score for reading in self.readings])


class ReadingLearner:
    """Alignment, Φ, Π and weights, updated by one pair of sentence and demo at a time."""

    method = "readings"

    def __init__(self) -> None:
        """Start knowing nothing."""
        self.alignment = Alignment()
        self.grounding = Grounding()
        self.grammar = Pcfg()
        self.weights = Weights()
        self.collocations = Collocations()
        self.memory = Memory()
        self.sentences = 0
        self._uses = UseTable(self.alignment, self.grounding, self.weights)

    @property
    def epsilon(self) -> float:
        """Least probability of a meaning that is tried, which keeps groundings sparse as ε does in the thesis."""
        return self._uses.least_probability

    @epsilon.setter
    def epsilon(self, value: float) -> None:
        self._uses.least_probability = value

    def knows(self, word: str) -> bool:
        """Whether a word was ever heard."""
        return self.alignment.word_counts.get(word, 0.0) > 0

    def meanings(self, word: str) -> dict[Meaning, float]:
        """P(meaning | word): what was validated, with the alignment as prior."""
        return self._uses.meanings(word)

    def uses_of(self, words: tuple[str, ...], actions: ActionTable) -> WordUses:
        """How the words of a sentence may be read, by themselves."""
        return self._uses.of(words, actions.sorts())

    def read(
        self,
        words: tuple[str, ...],
        scene: BoardElements,
        actions: ActionTable,
        senses: dict[Description, list[Sense]] | None = None,
        open_minded: bool = False,
    ) -> Readings:
        """Read a sentence in a scene; no readings when it has too many words.

        Args:
            words: The sentence.
            scene: The scene.
            actions: The known actions.
            senses: Senses of descriptions in this scene known from other sentences about it; added to.
            open_minded: Whether any word that has no plain meaning may be an action.
        """
        if len(words) > LONGEST:
            return Readings((), ())
        found = self._uses.of(words, actions.sorts(), open_minded)
        if len(found.kept) > MOST_WORDS:
            return Readings((), found.kept)
        weight = self.weights.of
        chart = PhraseChart(len(found.kept), found.uses, found.passed, weight, scene, senses)
        return Readings(tuple(read_clauses(chart, actions, weight)), found.kept)

    def tree(self, words: tuple[str, ...], reading: CommandReading, kept: tuple[int, ...]) -> RclNode:
        """The RCL tree of a reading, in which a meaning has all words that it is said with ("pick up").

        Args:
            words: The sentence.
            reading: One of its readings.
            kept: Positions in the sentence of the words that the reading's positions count.
        """
        return self.collocations.joined(tree_of(reading, kept), words)

    def learn(
        self,
        words: tuple[str, ...],
        arrangement: Arrangement,
        shown: ShownAction,
        actions: ActionTable,
        bearing: frozenset[int],
        rng: np.random.Generator,
    ) -> bool:
        """Learn from one sentence and demo, then look at some earlier ones again.

        Args:
            words: The sentence.
            arrangement: The scene before the action.
            shown: The action.
            actions: The known actions.
            bearing: Shape concepts that something can rest on.
            rng: Chooses the earlier ones.

        Returns:
            Whether any reading did what was shown.
        """
        if not words or len(words) > LONGEST:
            return False
        self.collocations.hear(words)
        scene = BoardElements(arrangement, bearing)
        ways = ways_of_speaking(shown, actions)
        salient = salient_meanings(scene, shown, ways)
        episode = Episode(words, arrangement, shown, salient, self.alignment.observe(words, salient, None, ways))
        for other in self.memory.recall(REALIGNED, rng):
            self._align(other, actions)
        self.memory.keep(episode)
        self.sentences += 1
        if self.sentences < LISTENING:
            return False
        if self.sentences in FRESH_STARTS:
            self._start_over(actions, bearing, rng)
        validated = self._credit(episode, scene, actions)
        for other in self.memory.recall(REPLAYS, rng):
            self._credit(other, BoardElements(other.arrangement, bearing), actions)
        return validated

    def _start_over(self, actions: ActionTable, bearing: frozenset[int], rng: np.random.Generator) -> None:
        """Read the whole memory afresh, by what alignment has come to know."""
        episodes = self.memory.episodes
        if self.sentences >= ENOUGH:
            for episode in episodes:
                episode.observed = self.alignment.level(episode.words, episode.observed, SELDOM)
        for _ in range(SWEEPS):
            for episode in episodes:
                self._align(episode, actions)
        self.grounding.clear()
        self.weights.clear()
        self.grammar.clear()
        for episode in episodes:
            episode.grounded = ()
            episode.counted = False
        for index in rng.permutation(len(episodes)):
            episode = episodes[int(index)]
            self._credit(episode, BoardElements(episode.arrangement, bearing), actions)

    def _align(self, episode: Episode, actions: ActionTable) -> None:
        """Align an earlier sentence anew: with what was salient, and with what it turned out to say."""
        ways = ways_of_speaking(episode.shown, actions)
        told = episode.told() if self.sentences >= ENOUGH else frozenset()
        salient = tuple(sorted(told.union(episode.salient)))
        episode.observed = self.alignment.observe(episode.words, salient, episode.observed, ways, told)

    def _credit(self, episode: Episode, scene: BoardElements, actions: ActionTable) -> bool:
        words, shown = episode.words, episode.shown
        found = self.read(words, scene, actions)
        right, credit = right_readings(found.readings, shown)
        if not right:
            found = self.read(words, scene, actions, open_minded=True)
            right, credit = right_readings(found.readings, shown)
        if not right:
            return False
        kept_words = tuple(words[position] for position in found.kept)
        gradient: defaultdict[Feature, float] = defaultdict(float)
        for reading, share in zip(right, credit, strict=True):
            add_features(gradient, kept_words, reading, share)
        for reading, share in zip(found.readings, found.shares(), strict=True):
            add_features(gradient, kept_words, reading, -share)
        self._ground(episode, found.kept, right, credit)
        self.weights.follow(gradient)
        return True

    def _ground(
        self, episode: Episode, kept: tuple[int, ...], readings: list[CommandReading], credit: list[float]
    ) -> None:
        """Count which words were used for what, which were passed over, and which rules were used.

        What the episode had added to Φ when it was read last is taken back first.
        """
        words = episode.words
        for reading, share in zip(readings, credit, strict=True):
            if share < LEAST_SHARE or episode.counted:
                continue
            tree = tree_of(reading, kept)
            self.grammar.add_rule("command", (tree.label,), share)
            for left, right in tree.rules():
                self.grammar.add_rule(left, right, share)
            for node in tree.nodes():
                if node.concept is not None:
                    self.grammar.add_terminal(node.label, words[node.first - 1], share)
        episode.counted = True
        for word, meaning, amount in episode.grounded:
            self.grounding.add(word, meaning, -amount)
        episode.grounded = grounded_words(words, kept, readings, credit, self.meanings)
        for word, meaning, amount in episode.grounded:
            self.grounding.add(word, meaning, amount)

    def speaks_of(self, concept: Concept) -> bool:
        """Whether anything was learned of a concept."""
        return concept in self.alignment.totals or concept in self.grounding.concept_totals

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over all that was learned of a concept that turned out to be another."""
        self.alignment.rename(old, new)
        self.grounding.rename(old, new)
        self.weights.rename(str(old), str(new))
        self.memory.rename(old, new)

    def named(self) -> Iterator[Concept]:
        """Walk the concepts that words were aligned with or grounded in."""
        for concept in (*self.alignment.totals, *self.grounding.concept_totals):
            if concept is not None:
                yield concept

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; the memory of recent sentences is left out."""
        return {
            "method": self.method,
            "sentences": self.sentences,
            "alignment": self.alignment.to_json(),
            "told": self.alignment.told_to_json(),
            "grounding": self.grounding.to_json(),
            "grammar": self.grammar.to_json(),
            "weights": self.weights.to_json(),
            "collocations": self.collocations.to_json(),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "ReadingLearner":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        learner = cls()
        learner.sentences = int(saved_count(data["sentences"], "number of sentences"))
        learner.alignment = Alignment.from_json(data["alignment"], data.get("told"))
        learner.alignment.sentences = learner.sentences
        learner.grounding = Grounding.from_json(data["grounding"])
        learner.grammar = Pcfg.from_json(data["grammar"])
        learner.weights = Weights.from_json(data["weights"])
        learner.collocations = Collocations.from_json(data.get("collocations", {}))  # older files have none
        learner._uses = UseTable(learner.alignment, learner.grounding, learner.weights)
        return learner
