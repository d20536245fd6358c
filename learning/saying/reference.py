"""Ways to refer to things and to where they go."""

from dataclasses import dataclass

from learning.grammar.rcl import RclNode


@dataclass(frozen=True, slots=True)
class Reference:
    """A way to refer to something.

    Attributes:
        tree: Its meaning, an `entity`.
        mask: What fits it.
        size: Number of concepts in it.
        located: Whether it says where the thing is.
    """

    tree: RclNode
    mask: int
    size: int
    located: bool = False


@dataclass(frozen=True, slots=True)
class Destination:
    """A way to tell where something goes.

    Attributes:
        tree: Its meaning, a `spatial-relation`.
        mask: What fits it: placements of a board; at a table, the things that the place is told by.
        size: Number of concepts in it.
    """

    tree: RclNode
    mask: int
    size: int
