"""One layout of the board in a Train-Robots release: the gripper and the blocks, each in a cell."""

from dataclasses import dataclass

from twin.board import CELLS

Cell = tuple[int, int, int]
"""Cell x, y (0..7) and height z in blocks (0..7)."""

COLOUR_OF_CODE = {
    "B": "blue",
    "C": "cyan",
    "R": "red",
    "Y": "yellow",
    "G": "green",
    "M": "magenta",
    "X": "gray",
    "W": "white",
}
Shape = str
"""`cube` or `prism`; in the extended release also `sphere` or `cylinder`."""
SHAPE_OF_CODE: dict[str, Shape] = {"1": "cube", "2": "prism"}
GRIPPER_CODES = ("O", "C")
GROUP_IMAGES = range(1, 6)
"""Images that every group of layouts has."""
COORDINATES = range(CELLS)


@dataclass(frozen=True, slots=True)
class Block:
    """One block: cell, colour and shape as the release names them."""

    cell: Cell
    colour: str
    shape: Shape


@dataclass(frozen=True, slots=True)
class Layout:
    """One layout: `image` 1..5 of a group.

    Attributes:
        group: Group number, from 1.
        image: Image number in the group, 1..5.
        gripper: Cell of the gripper.
        closed: Whether the gripper is closed.
        blocks: The blocks in the order of the file.
    """

    group: int
    image: int
    gripper: Cell
    closed: bool
    blocks: tuple[Block, ...]

    @property
    def held(self) -> int | None:
        """Index of the block in the closed gripper, or None."""
        if not self.closed:
            return None
        return next((i for i, block in enumerate(self.blocks) if block.cell == self.gripper), None)
