"""Words that tell nothing where they stand: "nearest" of one thing, "left" of what is on the left all the same."""

from collections.abc import Iterator

from learning.grammar.innate import NEAREST_ONE
from learning.grammar.phrase import Phrase
from learning.grammar.phrase_chart import IN_VAIN

IDLE_SPACES = ("rank", "side")
"""Spaces of concepts that are often true of all that is spoken of."""


def words_in_vain(phrase: Phrase) -> Iterator[int]:
    """Walk the positions of words for ranks and sides that rule nothing out in a phrase; those of its parts apart.

    Which of several is nearest is decided after all else was said of them, so a phrase with a modifier may have the
    word for it further down.

    Args:
        phrase: Any phrase of a reading.
    """
    if IN_VAIN not in phrase.features:
        return
    modified = phrase.children[0].label == phrase.label
    while phrase.children[0].label == phrase.label:
        phrase = phrase.children[0]
    for child in phrase.children:
        concept = child.concept
        if concept is not None and (concept == NEAREST_ONE if modified else concept.space in IDLE_SPACES):
            yield from child.used
