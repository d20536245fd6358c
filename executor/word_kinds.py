"""Kinds of meaning by which words are coloured: a handful, whatever feature spaces there are."""

from enum import StrEnum

from learning.concept_id import ACTION_SPACE, REFERENCE_SPACE, Concept
from learning.grammar.innate import COLLECTIVES
from learning.grounding.table_scene import NAMED, SIZE_SPACE


class WordKind(StrEnum):
    """What a word is about."""

    ACTION = "action"
    COLOUR = "colour"
    SHAPE = "shape"
    SIZE = "size"
    """How large or heavy something is."""
    PLACE = "place"
    """Where something is or goes, by itself or beside another thing."""
    WHICH = "which"
    """How many, or which of several: a count or a rank."""
    IT = "it"
    """What was spoken of before."""
    FUNCTION = "function"
    """Means nothing by itself."""
    UNSURE = "unsure"
    """Was heard, but too seldom to tell what it means."""
    UNKNOWN = "unknown"
    """Was never heard."""


_BY_SPACE = {
    ACTION_SPACE: WordKind.ACTION,
    REFERENCE_SPACE: WordKind.IT,
    "colour": WordKind.COLOUR,
    "shape": WordKind.SHAPE,
    SIZE_SPACE: WordKind.SIZE,
    "weight": WordKind.SIZE,
    "count": WordKind.WHICH,
    "rank": WordKind.WHICH,
}


def kind_of(concept: Concept | None) -> WordKind:
    """The kind of a meaning; None is none by itself.

    Spaces that nothing is said of here, such as those that a user adds, are about where things are or how they look:
    they are shown as places.
    """
    if concept is None:
        return WordKind.FUNCTION
    if concept in COLLECTIVES:
        return WordKind.SHAPE
    return _BY_SPACE.get(concept.space.removeprefix(NAMED), WordKind.PLACE)
