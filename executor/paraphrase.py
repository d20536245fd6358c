"""The same sentence in other words: what a second person might say of the same demo."""

import re

import numpy as np

from teleop.referring import COLOUR_WORDS, DIRECTIONS, ON_WORDS, SHAPE_WORDS
from teleop.sentences import DROP_VERBS, MOVE_VERBS, TAKE_VERBS

_NAMES = (*COLOUR_WORDS.values(), *SHAPE_WORDS.values(), *DIRECTIONS.values())
_GROUPS = (*_NAMES, ON_WORDS, MOVE_VERBS, TAKE_VERBS, DROP_VERBS)
_GROUP_OF = {phrase: group for group in _GROUPS for phrase in group if len(group) > 1}
# The longest first, so that `put down` is not taken for `put`.
_PHRASES = re.compile(r"\b(" + "|".join(sorted(map(re.escape, _GROUP_OF), key=len, reverse=True)) + r")\b")


OFTEN = 0.4
"""Usual probability that a word is replaced."""


def told(sentence: str, times: int, rng: np.random.Generator) -> tuple[str, ...]:
    """A sentence and what others would say instead, at most `times` in all, none twice."""
    said = dict.fromkeys([sentence, *(paraphrase(sentence, rng, OFTEN) for _ in range(times - 1))])
    return tuple(said)


def paraphrase(sentence: str, rng: np.random.Generator, variety: float) -> str:
    """Replace words by synonyms.

    Args:
        sentence: A sentence of `teleop.random_task`.
        rng: Source of chance.
        variety: Probability of each replacement.
    """

    def other(match: re.Match[str]) -> str:
        choices = [phrase for phrase in _GROUP_OF[match[0]] if phrase != match[0]]
        return choices[int(rng.integers(len(choices)))] if rng.random() < variety else match[0]

    return _PHRASES.sub(other, sentence)
