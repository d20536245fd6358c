"""What a block is called to tell it from others: in learned words, as far as they are ready."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from learning.concept_id import Concept
from learning.errors import KnowledgeError
from learning.grammar.innate import EXTREMES, SIDE_STEPS, SIDES
from learning.saying.speaker import Speaker
from twin.board import nearest_cell

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.percept import Percept
    from learning.perception import Observation

CLEARLY = 0.5
"""A word stands for a concept when it was used so in at least this share of its uses."""


class BoardNames:
    """Names blocks in what was learned.

    Args:
        knowledge: What was learned.
    """

    def __init__(self, knowledge: "Knowledge") -> None:
        self.knowledge = knowledge
        try:
            self._speaker: Speaker | None = Speaker(knowledge)
        except KnowledgeError:  # knowledge that does not say how a language is spoken
            self._speaker = None

    def word_for(self, concept: Concept) -> str | None:
        """The word that was used for a concept most, of those that mean it clearly."""
        best: tuple[float, str] | None = None
        for word, row in self.knowledge.language.grounding.counts.items():
            count = row.get(concept, 0.0)
            if count > 0.0 and count >= CLEARLY * sum(row.values()):
                best = max(best or (0.0, ""), (count, word))
        return best[1] if best else None

    def looks(self, percept: "Percept", index: int) -> str:
        """A block's looks in words, such as “red cube”."""
        said = []
        for space in ("colour", "shape"):
            word = self.word_for(Concept(space, int(percept.properties[space][index])))
            if word:
                said.append(word)
        return " ".join(said) or "block"

    def apart(self, observation: "Observation", percept: "Percept", indices: Sequence[int]) -> tuple[str, ...]:
        """Names of several blocks, each of which tells it from the others.

        Args:
            observation: What was seen.
            percept: The same in concepts.
            indices: Indices of the blocks.
        """
        found = []
        for index in indices:
            found.append(self._said(observation, index) or self._told_by_side(percept, index, indices))
        if len(set(found)) < len(found):
            found = [f"{name} {self._place(percept, index)}" for name, index in zip(found, indices, strict=True)]
        return tuple(found)

    def name(self, observation: "Observation", percept: "Percept", index: int) -> str:
        """The name of one block: its looks where they tell it from all others, else where it is as well."""
        looks = self.looks(percept, index)
        alike = [other for other in range(len(percept.object_ids)) if self.looks(percept, other) == looks]
        return f"the {looks}" if len(alike) == 1 else self.apart(observation, percept, (index,))[0]

    def _said(self, observation: "Observation", index: int) -> str | None:
        """A phrase that was read back as this block alone."""
        if self._speaker is None:
            return None
        saying = self._speaker.thing(observation, index)
        return saying.text if saying is not None else None

    def _told_by_side(self, percept: "Percept", index: int, among: Sequence[int]) -> str:
        """Looks, and the side on which it is the outermost of several."""
        looks = self.looks(percept, index)
        cells = {each: nearest_cell(percept.location[each]) for each in among}
        for side, extreme, (dx, dy) in zip(SIDES, EXTREMES, SIDE_STEPS, strict=True):
            reach = {each: dx * cell[0] + dy * cell[1] for each, cell in cells.items()}
            if len(reach) > 1 and all(reach[index] > value for each, value in reach.items() if each != index):
                word = self.word_for(extreme) or self.word_for(side)
                if word:
                    return f"the {looks} on the {word}"
        return f"the {looks} {self._place(percept, index)}"

    def _place(self, percept: "Percept", index: int) -> str:
        x, y, z = nearest_cell(percept.location[index])
        return f"in cell ({x}, {y}, {z})"
