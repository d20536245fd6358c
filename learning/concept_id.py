"""Names of concepts: a feature space and a number, written `colour_3`. They carry no meaning (thesis 3.3.4)."""

from typing import NamedTuple

OBJECT_SPACES = ("colour", "shape", "location")
RELATION_SPACES = ("direction", "distance")
ACTION_SPACE = "action"
REFERENCE_SPACE = "reference"


class Concept(NamedTuple):
    """One visual concept: component `number` of feature space `space`."""

    space: str
    number: int

    def __str__(self) -> str:
        """Write the concept as `space_number`."""
        return f"{self.space}_{self.number}"

    @classmethod
    def parse(cls, text: str) -> "Concept":
        """Read `space_number`; raises ValueError when the text has another form."""
        space, _, number = text.rpartition("_")
        if not space or not number.lstrip("-").isdigit():
            raise ValueError(f"'{text}' is not a concept id; expected a form such as 'colour_3'")
        return cls(space, int(number))


REFERENCE = Concept(REFERENCE_SPACE, 1)
"""The one innate concept of language: the thing that was spoken of before."""
