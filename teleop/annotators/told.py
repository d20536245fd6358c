"""A sentence with what is true of how it was made."""

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Told:
    """What an annotator said.

    Attributes:
        text: The sentence.
        language: Its language's tag.
        annotator: Who said it.
        template: How it is built.
        mistakes: What is wrong in it, such as `colour: blue for red`; mostly nothing.
        only_beside: Whether it says that a thing goes next to another, and not on which side of it.
    """

    text: str
    language: str
    annotator: str
    template: str
    mistakes: tuple[str, ...] = ()
    only_beside: bool = False

    def truth(self) -> dict[str, Any]:
        """For the sidecar that only evaluation opens."""
        return {
            "text": self.text,
            "language": self.language,
            "annotator": self.annotator,
            "template": self.template,
            "mistakes": list(self.mistakes),
        }
