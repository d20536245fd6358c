"""Noun phrases that mean exactly one block of a scene."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from twin.board import BLOCK, CELL, CELLS, nearest_cell
from twin.scene_spec import ObjectSpec, SceneSpec

COLOUR_WORDS: dict[str, tuple[str, ...]] = {
    "blue": ("blue",),
    "cyan": ("cyan", "turquoise"),
    "red": ("red",),
    "yellow": ("yellow",),
    "green": ("green",),
    "magenta": ("magenta", "pink", "purple"),
    "gray": ("gray", "grey"),
    "white": ("white",),
}
SHAPE_WORDS: dict[str, tuple[str, ...]] = {"cube": ("cube", "block", "brick"), "prism": ("prism", "pyramid")}
"""The first word is the plain one. A block or brick is a cube, as in the public commands."""

CORNERS: dict[tuple[int, int], str] = {
    (CELLS - 1, CELLS - 1): "front left corner",
    (CELLS - 1, 0): "front right corner",
    (0, CELLS - 1): "back left corner",
    (0, 0): "back right corner",
}
"""Cell (x, y) to its words: front is +x, where the robot looks; left is +y."""
DIRECTIONS: dict[tuple[int, int], tuple[str, ...]] = {
    (0, 1): ("to the left of", "left of"),
    (0, -1): ("to the right of", "right of"),
    (1, 0): ("in front of",),
    (-1, 0): ("behind",),
}
"""Step (x, y) from the reference, one cell, to its words."""
ON_WORDS = ("on top of", "on", "onto")


@dataclass(frozen=True, slots=True)
class Words:
    """Chooses between plain words and synonyms.

    Attributes:
        rng: Source of chance.
        variety: Probability of a synonym where there is one.
        relative: Whether a block may be named by where it stands.
    """

    rng: np.random.Generator
    variety: float
    relative: bool = True

    def one_of(self, words: tuple[str, ...]) -> str:
        """Return the first word or, with probability `variety`, another one."""
        if len(words) > 1 and self.rng.random() < self.variety:
            return words[1 + int(self.rng.integers(len(words) - 1))]
        return words[0]

    def look(self, colour: str | None, shape: str) -> str:
        """Name a look, such as `the red cube`; without a colour, `the cube`."""
        noun = self.one_of(SHAPE_WORDS[shape])
        return f"the {self.one_of(COLOUR_WORDS[colour])} {noun}" if colour else f"the {noun}"


Cell = tuple[int, int, int]


class Board:
    """The blocks of a scene by cell: what stands on what, and who looks like whom."""

    def __init__(self, spec: SceneSpec) -> None:
        """Take a scene whose blocks stand in cells; what is held is left out of `at` but still looks like something."""
        self.blocks = spec.objects
        self.held = spec.held
        self.cell: dict[int, Cell] = {each.id: nearest_cell(np.array(each.position)) for each in spec.objects}
        self.at: dict[Cell, ObjectSpec] = {self.cell[each.id]: each for each in spec.objects if each.id != spec.held}

    def height(self, x: int, y: int) -> int:
        """Number of blocks that stand in a column."""
        return sum(1 for cx, cy, _ in self.at if (cx, cy) == (x, y))

    def clear(self, block: ObjectSpec) -> bool:
        """Whether nothing stands on a standing block."""
        x, y, z = self.cell[block.id]
        return block.id != self.held and (x, y, z + 1) not in self.at

    def free_cell(self, x: int, y: int) -> Cell | None:
        """Where a block let go over a column would come to rest; None off the board, on a prism, or at the top."""
        if not (0 <= x < CELLS and 0 <= y < CELLS):
            return None
        z = self.height(x, y)
        if z >= CELLS or (z > 0 and self.at[x, y, z - 1].shape == "prism"):
            return None
        return x, y, z

    def same_look(self, colour: str | None, shape: str) -> list[ObjectSpec]:
        """Blocks of a look; a colour of None fits all."""
        return [each for each in self.blocks if each.shape == shape and colour in (None, each.colour)]

    def phrases(self, block: ObjectSpec, words: Words) -> Iterator[str]:
        """Noun phrases that mean this block and no other of the scene, the simplest first.

        Args:
            block: The block to name.
            words: Chooses synonyms, and says whether to name it by where it stands too.
        """
        alike = self.same_look(block.colour, block.shape)
        if len(alike) == 1:
            if len(self.same_look(None, block.shape)) == 1 and words.rng.random() < words.variety:
                yield words.look(None, block.shape)
            yield words.look(block.colour, block.shape)
            return
        if not words.relative or block.id == self.held:
            return
        noun = words.look(block.colour, block.shape)
        x, y, z = self.cell[block.id]
        below = self.at.get((x, y, z - 1))
        if below is not None and self._only(alike, block, lambda each: self._stands_on(each, below)):
            yield f"{noun} that is {words.one_of(ON_WORDS[:2])} {words.look(below.colour, below.shape)}"
        corner = CORNERS.get((x, y))
        if corner is not None and self._only(alike, block, lambda each: self.cell[each.id][:2] == (x, y)):
            yield f"{noun} that is in the {corner}"

    def phrase(self, block: ObjectSpec, words: Words) -> str | None:
        """Choose one of `phrases`, or None where there is none."""
        found = list(self.phrases(block, words))
        return found[int(words.rng.integers(len(found)))] if found else None

    def _only(self, alike: list[ObjectSpec], block: ObjectSpec, fits: Callable[[ObjectSpec], bool]) -> bool:
        return [each.id for each in alike if each.id != self.held and fits(each)] == [block.id]

    def _stands_on(self, block: ObjectSpec, look: ObjectSpec) -> bool:
        """Whether a block stands directly on one that looks like `look`."""
        x, y, z = self.cell[block.id]
        below = self.at.get((x, y, z - 1))
        return below is not None and (below.colour, below.shape) == (look.colour, look.shape)


def standing_position(cell: Cell) -> tuple[float, float, float]:
    """Centre of a block at rest in a cell [m]."""
    x, y, z = cell
    return (x + 0.5) * CELL, (y + 0.5) * CELL, (z + 0.5) * BLOCK
