"""Online alignment of words with what is salient: IBM Model 1, one sentence at a time (thesis 7.2.2).

Every word of a sentence is taken to be said of one salient concept, or of none. Expected counts are added as sentences
come (incremental EM, Neal & Hinton 1998; Model 1 of Brown et al. 1993); a sentence that is looked at again replaces
what it had added. Rare concepts are smoothed towards how frequent words are, so that whatever stood beside one of them
by chance is not taken for its name. What a sentence owes is looked at after that (`owed`).
"""

import math
import operator
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from learning.concept_id import Concept
from learning.grounding.owed import is_in_ways, log_odds_told, log_untold, with_owed
from learning.grounding.shares import shares_of
from learning.saved_numbers import saved_count

NOTHING = 1.5
"""How much likelier than any one salient concept a word is to be said of none."""
SMOOTHING = 15.0
"""Words that every concept is taken to have been named with before anything was heard, spread as words are."""
ENOUGH = 256
"""Sentences that are heard before it is looked at what they owe: until then all words are rare."""
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


class Observed(NamedTuple):
    """What a sentence added.

    Attributes:
        salient: What it may be about.
        shares: For each word, the probability that it is said of each of these.
        told: For each of these, the probability that any word is said of it.
    """

    salient: tuple[Concept, ...]
    shares: Shares
    told: tuple[float, ...]

    @property
    def meanings(self) -> tuple[Meaning, ...]:
        """None, then what is salient."""
        return None, *self.salient


class Alignment:
    """Expected counts of words with concepts."""

    def __init__(self) -> None:
        """Start empty."""
        self.word_counts: defaultdict[str, float] = defaultdict(float)
        self.joint: defaultdict[str, defaultdict[Meaning, float]] = defaultdict(lambda: defaultdict(float))
        self.totals: defaultdict[Meaning, float] = defaultdict(float)
        self.salient: defaultdict[Concept, float] = defaultdict(float)
        self.told: defaultdict[Concept, float] = defaultdict(float)
        self.heard = 0.0
        self.sentences = 0

    def observe(
        self,
        words: Sequence[str],
        salient: Sequence[Concept],
        earlier: Observed | None = None,
        ways: Sequence[Way] = (Way(),),
        told: frozenset[Concept] = frozenset(),
    ) -> Observed:
        """Count one sentence.

        Args:
            words: The sentence.
            salient: What it may be about, in a fixed order.
            earlier: What this sentence had added when it was looked at last.
            ways: Ways of speaking of it. How likely each is follows from all words of the sentence together.
            told: What of the salient is told for certain, by some word.

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
            self._add(words, earlier, -1.0)
        rows = []
        for word in words:
            row = self.joint[word]
            usual = SMOOTHING * self.word_counts[word] / self.heard
            likely = [(row.get(each, 0.0) + usual) / (self.totals.get(each, 0.0) + SMOOTHING) for each in meanings]
            likely[0] *= NOTHING
            rows.append(likely)
        spread = [_spread(rows, meanings, way) for way in ways]
        odds = shares_of([score for score, _ in spread])
        shares = np.array(
            [
                [sum(map(operator.mul, odds, column)) for column in zip(*of_word, strict=True)]
                for of_word in zip(*(table for _, table in spread), strict=True)
            ]
        )
        if words and self.sentences >= ENOUGH:
            owed = [
                log_odds_told(each, self.salient.get(each, 0.0), self.told.get(each, 0.0), each in told)
                for each in salient
            ]
            heard = np.array([self.word_counts[word] for word in words])
            untold = log_untold(words, shares, _in_ways(meanings))[1]
            shares = with_owed(shares, untold, np.array([0.0, *owed]), heard)
        return self._added(words, tuple(salient), tuple(map(tuple, shares.tolist())))

    def level(self, words: Sequence[str], earlier: Observed, most: float) -> Observed:
        """Take back what was made of the rare words of a sentence: they may be said of anything again.

        Online estimates of a rare word rest on what little was known when it was heard.

        Args:
            words: The sentence.
            earlier: What it had added.
            most: How often a rare word was heard at most.

        Returns:
            What it adds now.
        """
        self._add(words, earlier, -1.0)
        flat = (1.0 / len(earlier.meanings),) * len(earlier.meanings)
        pairs = zip(words, earlier.shares, strict=True)
        level = tuple(flat if self.word_counts[word] <= most else row for word, row in pairs)
        return self._added(words, earlier.salient, level)

    def _added(self, words: Sequence[str], salient: tuple[Concept, ...], shares: Shares) -> Observed:
        """Count what the words of a sentence are said of; what that adds."""
        told: tuple[float, ...] = (0.0,) * len(salient)
        if words:
            untold = log_untold(words, np.array(shares), _in_ways((None, *salient)))[0]
            told = tuple((-np.expm1(untold[1:])).tolist())
        observed = Observed(salient, shares, told)
        self._add(words, observed, 1.0)
        return observed

    def _add(self, words: Sequence[str], observed: Observed, sign: float) -> None:
        for word, row_shares in zip(words, observed.shares, strict=True):
            row = self.joint[word]
            for meaning, share in zip(observed.meanings, row_shares, strict=True):
                row[meaning] = max(0.0, row[meaning] + sign * share)
                self.totals[meaning] = max(0.0, self.totals[meaning] + sign * share)
        if words:
            for concept, share in zip(observed.salient, observed.told, strict=True):
                self.salient[concept] += sign
                self.told[concept] = max(0.0, self.told[concept] + sign * share)

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
        for table in (self.salient, self.told):
            table[new] += table.pop(old, 0.0)
        for row in self.joint.values():
            if old in row:
                row[new] += row.pop(old)

    def to_json(self) -> dict[str, Any]:
        """Word to its count and its expected counts by concept (`none` for no concept)."""
        return {
            word: [int(count), {name_of(m): round(n, 2) for m, n in self.joint[word].items() if n >= KEPT}]
            for word, count in sorted(self.word_counts.items())
        }

    def told_to_json(self) -> dict[str, list[float]]:
        """Concept to the number of sentences in which it was salient, and in which it was told."""
        return {
            str(concept): [round(salient), round(self.told.get(concept, 0.0), 2)]
            for concept, salient in sorted(self.salient.items())
            if salient >= 0.5
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any], told: Mapping[str, Any] | None = None) -> "Alignment":
        """Rebuild; raises TypeError, ValueError or AttributeError for what `to_json` did not write.

        Args:
            data: From `to_json`.
            told: From `told_to_json`; files written before it was counted have none.
        """
        alignment = cls()
        for name, (salient, how_often) in (told or {}).items():
            alignment.salient[Concept.parse(name)] = saved_count(salient, f"sentences with {name} salient")
            alignment.told[Concept.parse(name)] = saved_count(how_often, f"sentences that tell {name}")
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


def _in_ways(meanings: Sequence[Meaning]) -> npt.NDArray[np.bool_]:
    return np.array([is_in_ways(each) for each in meanings])


def name_of(meaning: Meaning) -> str:
    """Write a meaning."""
    return "none" if meaning is None else str(meaning)
