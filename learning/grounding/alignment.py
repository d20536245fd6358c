"""Online alignment of words with what is salient: IBM Model 1, one sentence at a time (thesis 7.2.2).

Every word of a sentence is taken to be said of one salient concept, or of none. Expected counts are added as sentences
come (incremental EM, Neal & Hinton 1998; Model 1 of Brown et al. 1993); a sentence that is looked at again replaces
what it had added. Rare concepts are smoothed towards how frequent words are, so that whatever stood beside one of them
by chance is not taken for its name.
"""

import math
import operator
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from learning.concept_id import Concept
from learning.grounding.shares import shares_of
from learning.saved_numbers import saved_count

NOTHING = 1.5
"""How much likelier than any one salient concept a word is to be said of none."""
SMOOTHING = 15.0
"""Words that every concept is taken to have been named with before anything was heard, spread as words are."""
KEPT = 0.05
"""Smallest count that is saved."""

Meaning = Concept | None
LEAST_TOLD = 0.02
"""Least probability that something is told which no word seems to be about."""


class Way(NamedTuple):
    """One way of speaking of what was shown: what of the salient is told for certain in it, and what is not."""

    told: frozenset[Concept] = frozenset()
    untold: frozenset[Concept] = frozenset()


Shares = tuple[tuple[float, ...], ...]
"""For each word, the probability that it was said of each meaning: of none, then of the salient concepts."""


class Alignment:
    """Expected counts of words with concepts."""

    def __init__(self) -> None:
        """Start empty."""
        self.word_counts: defaultdict[str, float] = defaultdict(float)
        self.joint: defaultdict[str, defaultdict[Meaning, float]] = defaultdict(lambda: defaultdict(float))
        self.totals: defaultdict[Meaning, float] = defaultdict(float)
        self.heard = 0.0
        self.sentences = 0

    def observe(
        self,
        words: Sequence[str],
        salient: Sequence[Concept],
        earlier: Shares | None = None,
        ways: Sequence[Way] = (Way(),),
    ) -> Shares:
        """Count one sentence.

        Args:
            words: The sentence.
            salient: What it may be about, in a fixed order.
            earlier: What this sentence had added when it was looked at last.
            ways: Ways of speaking of it. How likely each is follows from all words of the sentence together.

        Returns:
            What it adds now.
        """
        meanings: tuple[Meaning, ...] = (None, *salient)
        if earlier is None:
            for word in words:
                self.word_counts[word] += 1
            self.heard += len(words)
            self.sentences += 1
        else:
            self._add(words, meanings, earlier, -1.0)
        rows = []
        for word in words:
            row = self.joint[word]
            usual = SMOOTHING * self.word_counts[word] / self.heard
            likely = [(row.get(each, 0.0) + usual) / (self.totals.get(each, 0.0) + SMOOTHING) for each in meanings]
            likely[0] *= NOTHING
            rows.append(likely)
        spread = [_spread(rows, meanings, way) for way in ways]
        odds = shares_of([score for score, _ in spread])
        shares = [
            tuple(sum(map(operator.mul, odds, column)) for column in zip(*of_word, strict=True))
            for of_word in zip(*(table for _, table in spread), strict=True)
        ]
        self._add(words, meanings, shares, 1.0)
        return tuple(shares)

    def _add(
        self, words: Sequence[str], meanings: Sequence[Meaning], shares: Sequence[Sequence[float]], sign: float
    ) -> None:
        for word, row_shares in zip(words, shares, strict=True):
            row = self.joint[word]
            for meaning, share in zip(meanings, row_shares, strict=True):
                row[meaning] = max(0.0, row[meaning] + sign * share)
                self.totals[meaning] = max(0.0, self.totals[meaning] + sign * share)

    def meanings(self, word: str) -> dict[Meaning, float]:
        """P(concept | word), with one count of doubt; empty for a word never heard."""
        count = self.word_counts.get(word, 0.0)
        if not count:
            return {}
        return {meaning: amount / (count + 1.0) for meaning, amount in self.joint[word].items()}

    def rename(self, old: Concept, new: Concept) -> None:
        """Carry the counts of a concept over to the one it was merged into."""
        if old not in self.totals:
            return
        self.totals[new] += self.totals.pop(old)
        for row in self.joint.values():
            if old in row:
                row[new] += row.pop(old)

    def to_json(self) -> dict[str, Any]:
        """Word to its count and its expected counts by concept (`none` for no concept)."""
        return {
            word: [int(count), {name_of(m): round(n, 2) for m, n in self.joint[word].items() if n >= KEPT}]
            for word, count in sorted(self.word_counts.items())
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Alignment":
        """Rebuild; raises TypeError, ValueError or AttributeError for what `to_json` did not write."""
        alignment = cls()
        for word, (count, row) in data.items():
            alignment.word_counts[word] = saved_count(count, f"count of '{word}'", least=1)
            alignment.heard += alignment.word_counts[word]
            for name, amount in row.items():
                meaning = None if name == "none" else Concept.parse(name)
                number = saved_count(amount, f"count of '{word}' with {name}")
                alignment.joint[word][meaning] = number
                alignment.totals[meaning] += number
        return alignment


def _spread(rows: Sequence[Sequence[float]], meanings: Sequence[Meaning], way: Way) -> tuple[float, list[list[float]]]:
    """Log odds of a way of speaking, and of each word the probability of each meaning in it.

    Every meaning has the same prior in all ways, so the way in which more can be told is the likelier one. With a prior
    that is spread over what is open in a way it would be the one in which less can be told, more so the longer the
    sentence; but who tells of the parts says more words.
    """
    open_ones = [each not in way.untold for each in meanings]
    table = []
    score = 0.0
    for likely in rows:
        told = [value if is_open else 0.0 for value, is_open in zip(likely, open_ones, strict=True)]
        total = sum(told)
        score += math.log(total)
        table.append([value / total for value in told])
    for index, each in enumerate(meanings):
        if each in way.told:
            score += math.log(max(LEAST_TOLD, 1.0 - math.prod(1.0 - row[index] for row in table)))
    return score, table


def name_of(meaning: Meaning) -> str:
    """Write a meaning."""
    return "none" if meaning is None else str(meaning)
