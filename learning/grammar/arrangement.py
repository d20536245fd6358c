"""How blocks stand on the board, in whole numbers: all that language needs of a percept, and small enough to keep."""

from dataclasses import dataclass, replace

from learning.concept_id import Concept
from learning.percept import Percept
from learning.perception.placements import column_of
from twin.board import nearest_cell


@dataclass(frozen=True, slots=True)
class Arrangement:
    """N blocks in columns of cells.

    Attributes:
        columns: Column of each block, 0..63.
        levels: Level of each block, 0 on the board.
        colours: Colour concept number of each block.
        shapes: Shape concept number of each block.
        held: Index of the block in the gripper, or None.
    """

    columns: tuple[int, ...]
    levels: tuple[int, ...]
    colours: tuple[int, ...]
    shapes: tuple[int, ...]
    held: int | None

    @classmethod
    def of(cls, percept: Percept) -> "Arrangement":
        """Take down the arrangement of a percept."""
        return cls(
            columns=tuple(column_of(place) for place in percept.location),
            levels=tuple(nearest_cell(place)[2] for place in percept.location),
            colours=tuple(int(number) for number in percept.properties["colour"]),
            shapes=tuple(int(number) for number in percept.properties["shape"]),
            held=percept.held,
        )

    def renamed(self, old: Concept, new: Concept) -> "Arrangement":
        """The same with a concept that was merged into another under its new name."""
        if old.space == "colour":
            return replace(self, colours=tuple(new.number if n == old.number else n for n in self.colours))
        if old.space == "shape":
            return replace(self, shapes=tuple(new.number if n == old.number else n for n in self.shapes))
        return self
