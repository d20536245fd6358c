"""Grounding as sets of pairs (n-gram, true value), and their F1 (design section 6)."""

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from learning.evaluation.table_gold import GoldSentence
from learning.grounding.ngrams import ngrams_of

Pair = tuple[str, str]
"""N-gram and true value."""
SPACES = ("colour", "shape", "location", "direction", "distance", "action", "size")
"""Feature spaces that are scored, where a collection speaks of them."""


@dataclass(frozen=True, slots=True)
class PairScore:
    """Pairs of one feature space.

    Attributes:
        found: True pairs that were learned.
        wrong: Learned pairs that are not true.
        missed: True pairs that were not learned.
    """

    found: frozenset[Pair]
    wrong: frozenset[Pair]
    missed: frozenset[Pair]

    @property
    def f1(self) -> float | None:
        """F1 in 0..1; None where there are no pairs at all."""
        total = 2 * len(self.found) + len(self.wrong) + len(self.missed)
        return 2 * len(self.found) / total if total else None


class GoldPairs:
    """What the token alignments of some sentences give.

    Attributes:
        pairs: Feature space to the pairs of head and true value.
    """

    def __init__(self, sentences: Iterable[GoldSentence]) -> None:
        """Collect the pairs of some sentences, with all n-grams between head and phrase that mean the same."""
        self.pairs: dict[str, set[Pair]] = {space: set() for space in SPACES}
        self.ngrams: Counter[str] = Counter()
        self._heads: defaultdict[tuple[str, str, str], set[Pair]] = defaultdict(set)
        for sentence in sentences:
            words = sentence.words
            self.ngrams.update(set(ngrams_of(words)))
            for leaf in sentence.leaves:
                if leaf.element not in self.pairs:
                    continue
                head = " ".join(words[leaf.head[0] - 1 : leaf.head[1]])
                self.pairs[leaf.element].add((head, leaf.value))
                for first in range(leaf.phrase[0], leaf.head[0] + 1):
                    for last in range(leaf.head[1], leaf.phrase[1] + 1):
                        ngram = " ".join(words[first - 1 : last])
                        self._heads[leaf.element, ngram, leaf.value].add((head, leaf.value))

    def values(self, space: str, ngram: str) -> set[str]:
        """True values of an n-gram, or of any that has its words and more or fewer function words."""
        return {value for of, text, value in self._heads if of == space and text == ngram}

    def score(self, learned: Mapping[str, Iterable[Pair]]) -> dict[str, PairScore]:
        """Score learned pairs, by feature space."""
        scores = {}
        for space in SPACES:
            found: set[Pair] = set()
            wrong: set[Pair] = set()
            for ngram, value in learned.get(space, ()):
                heads = self._heads.get((space, ngram, value))
                if heads:
                    found |= heads
                else:
                    wrong.add((ngram, value))
            scores[space] = PairScore(frozenset(found), frozenset(wrong), frozenset(self.pairs[space] - found))
        return scores
