"""A sentence that is understood as it is meant."""

from dataclasses import dataclass

from learning.grammar.rcl import RclNode


@dataclass(frozen=True, slots=True)
class Saying:
    """A sentence that was read back before it was said.

    Attributes:
        text: The sentence.
        tree: Its meaning, parts in the order of speech.
        score: Log probability of its words and order.
        share: Share of the readings that understand it as it is meant.
        tried: How many were read back until it was, itself included.
    """

    text: str
    tree: RclNode
    score: float
    share: float
    tried: int
