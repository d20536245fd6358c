"""One sentence and one demo: from association to validated groundings and grammar (thesis 4.8 and algorithm 1)."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from learning.concept_id import Concept
from learning.grammar.actions import ActionTable
from learning.grammar.chart import Chart, Reading
from learning.grammar.pcfg import Pcfg
from learning.grammar.preferences import MOVES_FEATURE, Preferences, lexical_feature, rule_feature, skip_feature
from learning.grammar.scene import SceneSets
from learning.grounding.correlation import CorrelationMatrix
from learning.grounding.grounding import Grounding
from learning.grounding.hypotheses import supposed
from learning.grounding.integer_program import EPSILON, Pair
from learning.grounding.lexicon import lexical_entries
from learning.grounding.ngrams import ngrams_of
from learning.grounding.salience import focal_concepts, salient_concepts
from learning.grounding.shares import shares_of
from learning.percept import Percept, ShownAction

LEAST_SHARE = 0.01
"""Readings whose share of the credit is smaller are not counted."""
LEAST_STRENGTH = 0.05
"""Pairs with a weaker correlation are no hypotheses."""


@dataclass(frozen=True, slots=True)
class VisionTree:
    """The vision tree Ω of a demo (thesis 5.2): action, entity and destination as the eye saw them."""

    action: int
    entity: int
    """Mask of the moved object."""
    destination: int
    """Mask of the placement where it ended; 0 when it stayed in the gripper."""

    @classmethod
    def of(cls, shown: ShownAction) -> "VisionTree":
        """Build Ω from what was shown."""
        return cls(shown.action, 1 << shown.moved, 0 if shown.placement is None else 1 << shown.placement)

    def matches(self, reading: Reading) -> bool:
        """Whether an RCL tree's elements agree with Ω (thesis 5.3.4)."""
        return bool(
            reading.action == self.action
            and reading.moved & self.entity
            and (reading.places & self.destination if self.destination else reading.places == 0)
        )


class LanguageLearner:
    """K, Φ and Π, updated by one pair of sentence and demo at a time."""

    method = "thesis"

    def __init__(self) -> None:
        """Start knowing nothing."""
        self.epsilon = EPSILON
        self.correlation = CorrelationMatrix()
        self.focus = CorrelationMatrix()
        self.grounding = Grounding()
        self.grammar = Pcfg()
        self.preferences = Preferences()

    def learn(
        self, words: tuple[str, ...], percept: Percept, shown: ShownAction, scene: SceneSets, actions: ActionTable
    ) -> bool:
        """Run the six steps of thesis 4.8 and algorithm 1 on one pair; tell whether any reading was validated."""
        if not words:
            return False
        ngrams = ngrams_of(words)
        salient = salient_concepts(percept, shown)
        self.correlation.observe(ngrams, salient)
        self.focus.observe(ngrams, focal_concepts(percept, shown))
        candidates = self.hypotheses(list(ngrams), salient)
        entries, skip = lexical_entries(
            words,
            self.grounding,
            self.preferences,
            candidates,
            {w: max(self.correlation.strongest(w), self.focus.strongest(w)) for w in set(words)},
        )
        chart = Chart(len(words), entries, skip, self.grammar, scene, actions, self.preferences)
        omega = VisionTree.of(shown)
        readings = chart.readings()
        validated = [reading for reading in readings if omega.matches(reading)]
        if not validated:
            return False
        self._credit(words, validated, readings)
        return True

    def strength(self, ngram: str, concept: Concept) -> float:
        """K(δ, v) beyond chance, among all that was salient or among what was in focus, whichever is stronger."""
        return max(
            self.correlation.strength_beyond_chance(ngram, concept), self.focus.strength_beyond_chance(ngram, concept)
        )

    def hypotheses(self, ngrams: list[str], salient: set[Concept]) -> dict[Pair, float]:
        """Select (4.2) and filter (4.3 to 4.6) grounding hypotheses for the n-grams and concepts at hand."""
        strengths = {(ngram, concept): self.strength(ngram, concept) for ngram in ngrams for concept in sorted(salient)}
        strengths = {pair: k if k >= LEAST_STRENGTH else 0.0 for pair, k in strengths.items()}
        return supposed(strengths, self.epsilon)

    def log_weight(self, reading: Reading) -> float:
        """Log probability of a reading, not normalised, with the preference for readings that leave little open."""
        return reading.score + self.preferences.of(MOVES_FEATURE) * math.log(reading.moves)

    def _credit(self, words: tuple[str, ...], validated: list[Reading], readings: list[Reading]) -> None:
        """Share one validation among the readings: by their probability, over the number of moves each allows.

        A reading that would have allowed k different moves predicted the one that was shown with probability 1/k.
        """
        shares = shares_of([self.log_weight(reading) - math.log(reading.moves) for reading in validated])
        gradient: defaultdict[str, float] = defaultdict(float)
        for reading, share in zip(validated, shares, strict=True):
            _add_features(gradient, words, reading, share)
        for reading, share in zip(readings, shares_of([self.log_weight(r) for r in readings]), strict=True):
            _add_features(gradient, words, reading, -share)
        self.preferences.follow(gradient)
        every = ngrams_of(words)
        for reading, share in zip(validated, shares, strict=True):
            if share < LEAST_SHARE:
                continue
            used: set[str] = set()
            covered = reading.item.covered()
            for leaf in reading.item.leaves():
                ngram = " ".join(words[leaf.first : leaf.after])
                used.add(ngram)
                if leaf.concept is not None:
                    self.grounding.add(ngram, leaf.concept, share)
                    self.grammar.add_terminal(leaf.label, ngram, share)
            for ngram, spans in every.items():
                if ngram in used:
                    continue
                # A word is passed over where no leaf covers it; a longer n-gram counts only if it was counted before.
                if ngram in self.grounding.counts if " " in ngram else any(at not in covered for at, _ in spans):
                    self.grounding.add(ngram, None, share)
            for left, right in reading.rules():
                self.grammar.add_rule(left, right, share)

    def speaks_of(self, concept: Concept) -> bool:
        """Whether anything was learned of a concept."""
        return self.correlation.concept_counts.get(concept, 0.0) > 0

    def knows(self, word: str) -> bool:
        """Whether a word was ever heard."""
        return word in self.correlation.ngram_counts

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry over all that was learned of a concept that turned out to be another."""
        self.correlation.rename(old, new)
        self.focus.rename(old, new)
        self.grounding.rename(old, new)
        self.preferences.rename(f" = {old}", f" = {new}")

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings."""
        return {
            "method": self.method,
            "correlation": self.correlation.to_json(),
            "focus": self.focus.to_json(),
            "grounding": self.grounding.to_json(),
            "grammar": self.grammar.to_json(),
            "preferences": self.preferences.to_json(),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "LanguageLearner":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        learner = cls()
        learner.correlation = CorrelationMatrix.from_json(data["correlation"])
        learner.focus = CorrelationMatrix.from_json(data["focus"])
        learner.grounding = Grounding.from_json(data["grounding"])
        learner.grammar = Pcfg.from_json(data["grammar"])
        learner.preferences = Preferences.from_json(data["preferences"])
        return learner


def _add_features(gradient: defaultdict[str, float], words: tuple[str, ...], reading: Reading, amount: float) -> None:
    if abs(amount) < 1e-4:
        return
    covered = reading.item.covered()
    for leaf in reading.item.leaves():
        gradient[lexical_feature(" ".join(words[leaf.first : leaf.after]), leaf.concept)] += amount
    for position, word in enumerate(words):
        if position not in covered:
            gradient[skip_feature(word)] += amount
    for left, right in reading.rules():
        gradient[rule_feature(left, right)] += amount
    gradient[MOVES_FEATURE] += amount * math.log(reading.moves)
