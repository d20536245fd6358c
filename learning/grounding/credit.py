"""Which readings of a sentence are credited, and what of it: words used for what or passed over, and features."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping

from learning.concept_id import Concept
from learning.grammar.clauses import CommandReading
from learning.grammar.in_vain import words_in_vain
from learning.grammar.phrase import Feature
from learning.grounding.alignment import Meaning
from learning.grounding.shares import shares_of
from learning.grounding.word_uses import passed_feature
from learning.percept import ShownAction

LEAST_PART = 0.05
"""Added to how likely each of some words means what they mean together, so that none is ruled out for ever."""
LEAST_SHARE = 0.02
"""Readings whose share of the credit is smaller are not counted."""

Grounded = tuple[tuple[str, Concept | None, float], ...]
"""Words with what they were used for (None: passed over), and how much of the credit."""


def right_readings(readings: Iterable[CommandReading], shown: ShownAction) -> tuple[list[CommandReading], list[float]]:
    """The readings that do what was shown, and their shares of the credit.

    One that leaves several moves open predicted the one that was shown by so much less.
    """
    right = [reading for reading in readings if reading.does(shown.moved, shown.placement)]
    return right, shares_of([reading.score - math.log(reading.choices) for reading in right])


def grounded_words(
    words: tuple[str, ...],
    kept: tuple[int, ...],
    readings: list[CommandReading],
    credit: list[float],
    meanings: Callable[[str], Mapping[Meaning, float]],
) -> Grounded:
    """Which words were used for what, and which were passed over, by readings of some credit.

    Of words that mean something together ("and put") one is why they do: they share it as likely as each means it.

    Args:
        words: The sentence.
        kept: Positions in the sentence of the words that the readings' positions count; the others mean nothing.
        readings: Readings that are credited.
        credit: Their shares.
        meanings: P(meaning | word).
    """
    grounded: list[tuple[str, Concept | None, float]] = [
        (words[position], None, 1.0) for position in sorted(set(range(len(words))).difference(kept))
    ]
    for reading, share in zip(readings, credit, strict=True):
        if share < LEAST_SHARE:
            continue
        meant = dict(_told(reading))
        together = _together(reading)
        for position, original in enumerate(kept):
            word, concept = words[original], meant.get(position)
            part = 1.0
            if concept is not None and position in together:
                likely = [meanings(words[kept[other]]).get(concept, 0.0) + LEAST_PART for other in together[position]]
                part = likely[together[position].index(position)] / sum(likely)
                grounded.append((word, None, share * (1.0 - part)))
            grounded.append((word, concept, share * part))
    return tuple(grounded)


def _together(reading: CommandReading) -> dict[int, tuple[int, ...]]:
    """For each position of a word that means something together with others, the positions of all of them."""
    found = {}
    for phrase in reading.phrases():
        for leaf in phrase.leaves():
            if leaf.concept is not None and len(leaf.used) > 1:
                found.update(dict.fromkeys(leaf.used, leaf.used))
    return found


def _meant(reading: CommandReading) -> Iterator[tuple[int, Concept]]:
    for phrase in reading.phrases():
        for leaf in phrase.leaves():
            if leaf.concept is not None:
                for position in leaf.used:
                    yield position, leaf.concept


def _told(reading: CommandReading) -> Iterator[tuple[int, Concept]]:
    """What words meant, without ranks and sides that ruled nothing out: who says such a word may say nothing by it."""
    idle = {position for phrase in reading.phrases() for part in phrase.walk() for position in words_in_vain(part)}
    return ((position, concept) for position, concept in _meant(reading) if position not in idle)


def add_features(
    gradient: defaultdict[Feature, float], words: tuple[str, ...], reading: CommandReading, amount: float
) -> None:
    """Add a reading's features to a gradient, so many times; words that it passes over are features, too."""
    if abs(amount) < 1e-3:
        return
    for feature in reading.all_features():
        gradient[feature] += amount
    used = {position for position, _ in _meant(reading)}
    for position, word in enumerate(words):
        if position not in used:
            gradient[passed_feature(word)] += amount
