"""Words and n-grams of an utterance (thesis 4.2)."""

import re
from collections.abc import Mapping

MAX_N = 3
"""Longest n-gram (thesis 6.4: N = 3)."""

_WORD = re.compile(r"[^\W_]+(?:'[^\W_]+)*")

Span = tuple[int, int]


def words_of(utterance: str) -> tuple[str, ...]:
    """Return the lower-case words of an utterance in any script, without punctuation (thesis 4.2)."""
    return tuple(_WORD.findall(utterance.lower().replace("’", "'")))


def with_words(utterance: str, instead: Mapping[str, str]) -> str:
    """Return an utterance with other words in place of some, which are named as `words_of` gives them."""
    plain = utterance.replace("’", "'")
    return _WORD.sub(lambda found: instead.get(found[0].lower(), found[0]), plain)


def ngrams_of(words: tuple[str, ...], longest: int = MAX_N) -> dict[str, list[Span]]:
    """Map each n-gram (words joined by a space), n <= `longest`, to the spans [first, after last) where it stands."""
    found: dict[str, list[Span]] = {}
    for first in range(len(words)):
        for after in range(first + 1, min(first + longest, len(words)) + 1):
            found.setdefault(" ".join(words[first:after]), []).append((first, after))
    return found


def parts_of(ngram: str) -> list[str]:
    """Give the shorter n-grams that an n-gram consists of."""
    words = ngram.split(" ")
    return [
        " ".join(words[first:after])
        for first in range(len(words))
        for after in range(first + 1, len(words) + 1)
        if after - first < len(words)
    ]
