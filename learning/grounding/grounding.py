"""Φ: how often each n-gram was validated with each concept, or with none (thesis 4.7)."""

from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from learning.concept_id import Concept
from learning.saved_numbers import saved_count

KEPT = 0.05
"""Smallest count that is saved."""


class Grounding:
    """Counts of validated groundings and the probabilities that follow from them (equation 4.7).

    Counts may be fractions: where several hypotheses are validated by one demo, each gets its share. `None` stands for
    an n-gram that was passed over in a validated reading: a function word (thesis 4.9.4) gathers its weight there.
    """

    def __init__(self) -> None:
        """Start empty."""
        self.counts: defaultdict[str, defaultdict[Concept | None, float]] = defaultdict(lambda: defaultdict(float))
        self.concept_totals: defaultdict[Concept | None, float] = defaultdict(float)

    def clear(self) -> None:
        """Forget everything."""
        self.counts.clear()
        self.concept_totals.clear()

    def add(self, ngram: str, concept: Concept | None, amount: float = 1.0) -> None:
        """Add `amount` to λ(δ, v)."""
        self.counts[ngram][concept] += amount
        self.concept_totals[concept] += amount

    def total(self, ngram: str) -> float:
        """λ(δ): how much the n-gram was validated with anything."""
        return sum(self.counts[ngram].values()) if ngram in self.counts else 0.0

    def grounded(self, ngram: str) -> float:
        """How much the n-gram was validated with any concept, passing over not counted."""
        if ngram not in self.counts:
            return 0.0
        return sum(amount for concept, amount in self.counts[ngram].items() if concept is not None)

    def probability(self, ngram: str, concept: Concept) -> float:
        """Φ(δ, v) = P(v | δ), equation 4.7, over the concepts that δ was validated with; 0 when it never was."""
        grounded = self.grounded(ngram)
        return self.counts[ngram][concept] / grounded if grounded > 0 else 0.0

    def meanings(self, ngram: str) -> dict[Concept, float]:
        """All concepts of an n-gram with their Φ(δ, v)."""
        return {c: self.probability(ngram, c) for c in self.counts.get(ngram, {}) if c is not None}

    def rename(self, old: Concept, new: Concept) -> None:
        """Move all counts of a concept that was merged into another."""
        for row in self.counts.values():
            if old in row:
                row[new] += row.pop(old)
        self.concept_totals[new] += self.concept_totals.pop(old, 0.0)

    def to_json(self) -> dict[str, dict[str, float]]:
        """N-gram to concept (or `none`) to count; counts below 0.05 are left out."""
        rows = {}
        for ngram, row in sorted(self.counts.items()):
            kept = {str(c) if c is not None else "none": round(n, 3) for c, n in row.items() if n >= KEPT}
            if kept:
                rows[ngram] = kept
        return rows

    @classmethod
    def from_json(cls, data: Mapping[str, Mapping[str, Any]]) -> "Grounding":
        """Rebuild Φ; raises ValueError, TypeError or AttributeError for what `to_json` did not write."""
        grounding = cls()
        for ngram, row in data.items():
            for concept, count in row.items():
                amount = saved_count(count, f"count of '{ngram}' with {concept}")
                grounding.add(ngram, None if concept == "none" else Concept.parse(concept), amount)
        return grounding
