"""Parts of words that are words of their own, found by statistics (thesis 7.2 leaves this open).

Where a language joins a conjunction, a pronoun or a gender ending to a word, the joined word is rarer than its parts
and means what they mean. A beginning or an ending is such a part when it was met with several words that also stand
alone; of an ending two are enough where another is known that the same words take. Nothing of any language is built in.
"""

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from typing import Any

from learning.grounding.ngrams import ngrams_of
from learning.saved_numbers import saved_count

LONGEST_AFFIX = 2
"""Letters of a joined part at most."""
SHORTEST_STEM = 2
"""Letters of the word that it is joined to, at least."""
LEAST_FORMS = 3
"""A part must have been met in so many different words,"""
LEAST_STEMS = 2
"""of so many that also stand alone: one with two endings is joined twice."""
LEAST_LIKE = 2
"""or with so many that also take an ending that is known: what takes the place of an ending is one."""
ESTABLISHED = 4
"""How often a word must have been heard to count as one that stands alone, or to be what another is a slip for;"""
STANDING = 2
"""fewer are enough to be what another is that has a known part joined on."""
SLIP = 2
"""A word heard more often than this is no slip,"""
SLIP_SHARE = 0.1
"""unless what it would be a slip for is heard so much more often."""
LONG_ENOUGH = 4
"""Letters of a word that may have slips."""


class JoinedWords:
    """Counts of words, and what follows from them: which words are others with something joined on, or misspelt."""

    def __init__(self) -> None:
        """Start without words."""
        self.counts: defaultdict[str, float] = defaultdict(float)
        self._total = 0.0
        self._dirty = True
        self._beginnings: frozenset[str] = frozenset()
        self._endings: frozenset[str] = frozenset()
        self._pieces = lru_cache(maxsize=4096)(self._analyse)

    def hear(self, words: tuple[str, ...]) -> None:
        """Count the words of a sentence."""
        for word in words:
            self.counts[word] += 1
            self._total += 1
        self._dirty = True

    def pieces(self, word: str) -> tuple[str, ...]:
        """The parts that a word consists of, itself where it is simple; a slip is put right."""
        self._refresh()
        return self._pieces(word)

    def compounds(self) -> set[str]:
        """N-grams of parts that words consist of."""
        return {ngram for word in self.counts for ngram in ngrams_of(self.pieces(word)) if " " in ngram}

    def larger(self, word: str, part: str) -> list[str]:
        """What of a word a part of it is in, and more: n-grams of its parts and itself; nothing of a simple word."""
        pieces = self.pieces(word)
        if len(pieces) == 1:
            return []
        longer = [ngram for ngram in ngrams_of(pieces) if ngram != part and f" {part} " in f" {ngram} "]
        return [word, *longer]

    def split(self, words: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[int, ...]]:
        """All parts of a sentence's words, and the index of the word that each belongs to."""
        parts = [(piece, index) for index, word in enumerate(words) for piece in self.pieces(word)]
        return tuple(piece for piece, _ in parts), tuple(index for _, index in parts)

    @property
    def total(self) -> float:
        """How many words were heard."""
        return self._total

    def to_json(self) -> dict[str, int]:
        """Word to count."""
        return {word: int(count) for word, count in sorted(self.counts.items())}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "JoinedWords":
        """Rebuild; raises ValueError, TypeError or AttributeError for what `to_json` did not write."""
        joined = cls()
        for word, count in data.items():
            joined.counts[word] = saved_count(count, f"count of '{word}'", least=1)
        joined._total = sum(joined.counts.values())
        return joined

    def _refresh(self) -> None:
        if not self._dirty:
            return
        self._dirty = False
        ended = [(word[-n:], word[:-n], word) for word, n in self._cuts() if self._alone(word[:-n])]
        self._endings = frozenset(_usual(ended))
        self._endings |= _like(ended, self._endings)
        self._beginnings = frozenset(
            _usual((word[:n], stem, word) for word, n in self._cuts() if (stem := self._stem_of(word[n:])))
        )
        self._pieces.cache_clear()

    def _cuts(self) -> Iterator[tuple[str, int]]:
        """Each word with each length of a part at its end or beginning."""
        for word in self.counts:
            for length in range(1, LONGEST_AFFIX + 1):
                yield word, length

    def _alone(self, word: str) -> bool:
        return len(word) >= SHORTEST_STEM and self.counts.get(word, 0.0) >= ESTABLISHED

    def _stem_of(self, word: str) -> str:
        """The word that stands alone, of a word that may have an ending; empty where there is none."""
        if self._alone(word):
            return word
        stems = (word[: -len(end)] for end in sorted(self._endings) if word.endswith(end))
        return next((stem for stem in stems if self._alone(stem)), "")

    def _analyse(self, word: str) -> tuple[str, ...]:
        options = [(count, -len(parts), parts) for parts in self._readings(word) if (count := self._support(parts))]
        if options:
            return max(options)[2]
        count = self.counts.get(word, 0.0)
        if len(word) >= LONG_ENOUGH:
            right = [
                (meant, other)
                for other in _slips(word)
                if (meant := self._meant(other)) and count <= max(SLIP, SLIP_SHARE * meant)
            ]
            if right:
                return self._analyse(max(right)[1])
        return (word,)

    def _readings(self, word: str) -> Iterator[tuple[str, ...]]:
        """Ways to take a word apart into beginning, stem and ending, at least one of them joined on."""
        for begin in ("", *sorted(self._beginnings)):
            if not word.startswith(begin):
                continue
            rest = word[len(begin) :]
            for end in ("", *sorted(self._endings)):
                if rest.endswith(end) and (begin or end):
                    stem = rest[: len(rest) - len(end)]
                    yield tuple(part for part in (begin, stem, end) if part)

    def _meant(self, word: str) -> float:
        """How often a word was heard that another may be a slip for, or its stem; 0 where it is not established."""
        if self._alone(word):
            return self.counts[word]
        return max((self._support(parts) for parts in self._readings(word)), default=0.0)

    def _support(self, parts: tuple[str, ...]) -> float:
        """How often the stem stands alone; 0 where it does not, or is the rarer of the two."""
        word = "".join(parts)
        stems = [part for part in parts if len(part) >= SHORTEST_STEM and self.counts.get(part, 0.0) >= STANDING]
        count = max((self.counts[stem] for stem in stems), default=0.0)
        return count if count > self.counts.get(word, 0.0) else 0.0


def _usual(parts: Iterable[tuple[str, str, str]]) -> set[str]:
    """Parts that were met in enough words, of enough stems: each with its stem and the word that both make."""
    stems: defaultdict[str, set[str]] = defaultdict(set)
    words: defaultdict[str, set[str]] = defaultdict(set)
    for part, stem, word in parts:
        stems[part].add(stem)
        words[part].add(word)
    return {part for part, met in stems.items() if len(met) >= LEAST_STEMS and len(words[part]) >= LEAST_FORMS}


def _like(parts: Iterable[tuple[str, str, str]], known: frozenset[str]) -> frozenset[str]:
    """Parts that were met in the place of known ones with enough stems (as in the signatures of Goldsmith 2001)."""
    stems: defaultdict[str, set[str]] = defaultdict(set)
    for part, stem, _ in parts:
        stems[part].add(stem)
    with_known = set().union(*(stems[part] for part in known)) if known else set()
    return frozenset(part for part, met in stems.items() if len(met & with_known) >= LEAST_LIKE)


def _slips(word: str) -> Iterator[str]:
    """Words of which a word may be a slip: two neighbouring letters changed places."""
    for at in range(len(word) - 1):
        if word[at] != word[at + 1]:
            yield word[:at] + word[at + 1] + word[at] + word[at + 2 :]
