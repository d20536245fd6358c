"""Phrases: parts of a reading, each over a span of words and with what it denotes in the scene."""

from collections.abc import Iterator
from dataclasses import dataclass

from learning.concept_id import Concept

Feature = tuple[str, ...]
"""A yes-or-no property of a reading whose weight is learned, such as ("means", "red", "colour_1")."""


@dataclass(slots=True, eq=False)
class Phrase:
    """One way to read a span of words.

    Attributes:
        label: Element: `word` (a colour, a shape, a kind of element ...), `relation`, `heading`, `number`, `unit`,
            `action`; `description` (words about one thing), `entity`, `modifier` (a relation to an entity),
            `measure` and `shift` (so many units to one side).
        first: Position of the first word.
        after: Position after the last word.
        score: Sum of the weights of all features, its children's too.
        meaning: What it denotes. Of phrases of one label, span and meaning only the best is kept.
        features: Features that are not its children's.
        children: Parts from left to right.
        concept: Concept of a lexical phrase, else None.
        used: Positions of the words that a lexical phrase consists of; its other words are passed over.
    """

    label: str
    first: int
    after: int
    score: float
    meaning: object
    features: tuple[Feature, ...] = ()
    children: tuple["Phrase", ...] = ()
    concept: Concept | None = None
    used: tuple[int, ...] = ()

    def leaves(self) -> Iterator["Phrase"]:
        """Walk the lexical phrases from left to right."""
        if self.concept is not None:
            yield self
        for child in self.children:
            yield from child.leaves()

    def walk(self) -> Iterator["Phrase"]:
        """Walk the phrase and all its parts."""
        yield self
        for child in self.children:
            yield from child.walk()

    def all_features(self) -> Iterator[Feature]:
        """Walk the features of the phrase and all its parts."""
        yield from self.features
        for child in self.children:
            yield from child.all_features()
