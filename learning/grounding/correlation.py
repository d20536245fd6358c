"""The concepts correlation matrix K between n-grams and visual concepts (thesis 4.3, equation 4.1)."""

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping
from typing import Any

from learning.concept_id import Concept
from learning.saved_numbers import saved_count

TAU = 5.0
"""Decay constant of the learning curve (thesis 4.3: between 5 and 10)."""
CONFIDENCE = 1.6
"""Standard errors taken off a frequency before it counts as association."""
HABITUATION = 400.0
"""Sightings after which an n-gram's row is no longer updated (n_h of thesis 4.8.1)."""

MEMORY = 250.0
"""Sentences after which an n-gram that was heard only once is forgotten."""

WORTH_KEEPING = 0.1
"""Strength beyond chance from which a longer n-gram is saved."""


class CorrelationMatrix:
    """Counts of n-grams, concepts and both together, and the strength of association that follows from them.

    Only frequencies are kept, never a sentence or a scene, so the matrix is incremental by nature (thesis 4.8). A row
    whose n-gram was seen `habituation` times stops growing: its grounding lives on in Φ (thesis 4.8.1).
    """

    def __init__(self, tau: float = TAU, habituation: float = HABITUATION) -> None:
        """Start empty; `tau` is the decay constant of 4.1, `habituation` the sightings n_h of 4.8.1."""
        self.tau = tau
        self.habituation = habituation
        self.demos = 0.0
        self.ngram_counts: defaultdict[str, float] = defaultdict(float)
        self.concept_counts: defaultdict[Concept, float] = defaultdict(float)
        self.joint_counts: defaultdict[str, defaultdict[Concept, float]] = defaultdict(lambda: defaultdict(float))
        self.frozen_at: dict[str, float] = {}
        self._first_heard: dict[str, float] = {}

    def observe(self, ngrams: Iterable[str], concepts: Iterable[Concept]) -> None:
        """Count one sentence's n-grams and one demo's concepts (each once) as seen together."""
        present = set(concepts)
        self.demos += 1
        for concept in present:
            self.concept_counts[concept] += 1
        for ngram in set(ngrams):
            if self.ngram_counts[ngram] >= self.habituation:
                self.frozen_at.setdefault(ngram, self.demos - 1)
                continue
            self._first_heard.setdefault(ngram, self.demos)
            self.ngram_counts[ngram] += 1
            row = self.joint_counts[ngram]
            for concept in present:
                row[concept] += 1
        if self.demos % MEMORY == 0:
            self._forget()

    def strength(self, ngram: str, concept: Concept) -> float:
        """K(δ, v) exactly as equation 4.1, in 0..1; 0 for a pair never seen together."""
        together = self.joint_counts[ngram][concept] if ngram in self.joint_counts else 0.0
        if together == 0:
            return 0.0
        n_ngram, n_concept = self.ngram_counts[ngram], self.concept_counts[concept]
        return max(together / n_ngram, together / n_concept) * self._learning_curve(n_ngram, n_concept)

    def strength_beyond_chance(self, ngram: str, concept: Concept) -> float:
        """K(δ, v) with each of its two frequencies corrected for chance, in 0..1.

        In a scene of 25 blocks and three words in four being "the", both ratios of 4.1 are high for pairs that have
        nothing to do with one another. As in Cohen's kappa, what chance alone would give is taken off and the rest
        rescaled: (p - p0) / (1 - p0), where p0 is the concept's (or the n-gram's) share of all demos. p is the lower
        end of Wilson's interval, so that a pair seen a few times has to be all the more regular.
        """
        together = self.joint_counts[ngram][concept] if ngram in self.joint_counts else 0.0
        if together == 0:
            return 0.0
        n_ngram, n_concept = self.ngram_counts[ngram], self.concept_counts[concept]
        demos = self.row_demos(ngram)
        of_ngram = _beyond(wilson(together, n_ngram), n_concept / self.demos)
        of_concept = _beyond(wilson(together * self.demos / demos, n_concept), n_ngram / demos)
        return max(of_ngram, of_concept) * self._learning_curve(n_ngram, n_concept)

    def strongest(self, ngram: str) -> float:
        """Give the n-gram's strongest association beyond chance with any concept, in 0..1."""
        row = self.joint_counts.get(ngram)
        return max((self.strength_beyond_chance(ngram, concept) for concept in row), default=0.0) if row else 0.0

    def row_demos(self, ngram: str) -> float:
        """Sentences seen while the n-gram's row was still growing."""
        return self.frozen_at.get(ngram, self.demos)

    def _learning_curve(self, n_ngram: float, n_concept: float) -> float:
        return 1.0 - math.exp(-min(n_ngram, n_concept) / self.tau)

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry the counts of a concept over to the one it was merged into."""
        if old not in self.concept_counts:
            return
        self.concept_counts[new] += self.concept_counts.pop(old)
        for row in self.joint_counts.values():
            if old in row:
                row[new] += row.pop(old)

    def _forget(self) -> None:
        """Drop n-grams that were heard once and not again for long: chance combinations of words, mostly."""
        for ngram in [
            n for n, count in self.ngram_counts.items() if count < 2 and self._first_heard[n] <= self.demos - MEMORY
        ]:
            del self.ngram_counts[ngram]
            del self._first_heard[ngram]
            self.joint_counts.pop(ngram, None)

    def to_json(self) -> dict[str, Any]:
        """Counts of concepts, and for each n-gram its count, when it was first heard or frozen, and its row.

        Longer n-grams are saved only where they go with some concept more than chance has it: the others are chance
        combinations, and counting them anew loses nothing.
        """
        return {
            "sentences": int(self.demos),
            "concepts": {str(c): int(n) for c, n in sorted(self.concept_counts.items())},
            "ngrams": {
                ngram: [
                    int(count),
                    int(self._first_heard[ngram]),
                    int(self.frozen_at[ngram]) if ngram in self.frozen_at else None,
                    {str(c): int(n) for c, n in sorted(self.joint_counts[ngram].items())},
                ]
                for ngram, count in sorted(self.ngram_counts.items())
                if " " not in ngram or (count >= 2 and self.strongest(ngram) >= WORTH_KEEPING)
            },
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "CorrelationMatrix":
        """Rebuild K; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        matrix = cls()
        matrix.demos = saved_count(data["sentences"], "number of sentences")
        for concept, count in data["concepts"].items():
            matrix.concept_counts[Concept.parse(concept)] = saved_count(count, f"count of {concept}", least=1)
        for ngram, (count, first, frozen, row) in data["ngrams"].items():
            matrix.ngram_counts[ngram] = saved_count(count, f"count of '{ngram}'", least=1)
            matrix._first_heard[ngram] = saved_count(first, f"first hearing of '{ngram}'")
            if frozen is not None:
                matrix.frozen_at[ngram] = saved_count(frozen, f"last update of '{ngram}'", least=1)
            for concept, together in row.items():
                amount = saved_count(together, f"count of '{ngram}' with {concept}")
                matrix.joint_counts[ngram][Concept.parse(concept)] = amount
        return matrix


def _beyond(share: float, chance: float) -> float:
    return max(0.0, (share - chance) / (1.0 - chance)) if chance < 1.0 else 0.0


def wilson(hits: float, tries: float, errors: float = CONFIDENCE) -> float:
    """Lower end of Wilson's score interval of a share, `errors` standard errors wide; 0 where nothing was tried."""
    if tries <= 0.0:
        return 0.0
    hits = min(hits, tries)
    share, square = hits / tries, errors**2
    spread = errors * math.sqrt(share * (1 - share) / tries + square / (4 * tries * tries))
    return (share + square / (2 * tries) - spread) / (1 + square / tries)
