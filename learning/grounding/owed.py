"""What a sentence owes: concepts that are seldom left untold, and that no other word of it tells (explaining away).

Model 1 takes every word by itself. A rare word for something that is there in every scene, and for which there is a
frequent word, then never gets its meaning: "brick" is not told from any other word of its few sentences. But a
sentence without "block" still has to call the thing something.
"""

import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from learning.concept_id import ACTION_SPACE, REFERENCE, Concept
from robots.pose import FloatArray

MOST_ODDS = 1.0
"""Largest log odds that a concept is told."""
AGAIN = math.log(0.3)
"""Log of how much less likely a word is said of what another word of the sentence tells already."""
TRUSTED = 30.0
"""A word heard so often is left to its own statistics by half, one heard more often by more."""
WITH_WAYS = (ACTION_SPACE, REFERENCE.space)
"""Spaces of what is told in some ways of speaking only, and has odds with these: nothing is owed of them."""


def is_in_ways(meaning: Concept | None) -> bool:
    """Whether a meaning is told in some ways of speaking only."""
    return meaning is not None and meaning.space in WITH_WAYS


def log_odds_told(concept: Concept, salient: float, told: float, certain: bool = False) -> float:
    """Log odds that a concept is told when it is salient, 0 for what depends on the way of speaking.

    Args:
        concept: The concept.
        salient: Number of sentences in which it was salient.
        told: Number of these in which it was told.
        certain: Whether it is told for certain in the sentence at hand.
    """
    if is_in_ways(concept):
        return 0.0
    if certain:
        return MOST_ODDS
    share = (told + 1.0) / (salient + 3.0)
    return min(MOST_ODDS, max(-MOST_ODDS, math.log(share / max(1e-9, 1.0 - share))))


def log_untold(
    words: Sequence[str], shares: FloatArray, in_ways: npt.NDArray[np.bool_]
) -> tuple[FloatArray, FloatArray]:
    """Log probability that a meaning is told by no word at all, and by no other word than each.

    Args:
        words: The sentence.
        shares: Probability that each word is said of each meaning, (words, meanings).
        in_ways: Whether a meaning is told in some ways of speaking only, (meanings,).

    Returns:
        By no word, (meanings,), and by no other, (words, meanings). The same word twice is no other word, as two things
        may be red, but for an action, which is told once.
    """
    free = np.log1p(-np.minimum(shares, 0.999))
    total = free.sum(axis=0)
    own = free
    if len(set(words)) < len(words):
        kinds = {word: number for number, word in enumerate(dict.fromkeys(words))}
        kind = np.array([kinds[word] for word in words])
        own = np.where(in_ways, free, (kind[:, None] == kind) @ free)
    return total, total - own


def with_owed(shares: FloatArray, untold: FloatArray, odds: FloatArray, heard: FloatArray) -> FloatArray:
    """Shift words towards what is owed, and away from what others tell; rare words more than frequent ones.

    Args:
        shares: Probability that each word is said of each meaning, of none first, (words, meanings).
        untold: Log probability that no other word tells it, (words, meanings).
        odds: Log odds that it is told, (meanings,).
        heard: How often each word was heard, (words,).
    """
    alone = np.exp(untold)
    shift = (TRUSTED / (TRUSTED + heard))[:, None] * (alone * odds + (1.0 - alone) * AGAIN)
    shift[:, 0] = 0.0
    shifted: FloatArray = shares * np.exp(shift)
    shifted /= shifted.sum(axis=1, keepdims=True)
    return shifted
