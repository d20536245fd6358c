"""Junctures: where in a tree one meaningful word ends and the next begins, in terms of elements alone."""

from collections.abc import Iterator
from typing import NamedTuple

from learning.grammar.rcl import RclNode

EDGE = "edge"
"""Stands for what is before the first and after the last word that means something."""


class Juncture(NamedTuple):
    """Between two leaves.

    Attributes:
        within: Element of the smallest part of the tree that holds both.
        left: Element of its child that ends here.
        right: Element of its child that begins here.
    """

    within: str
    left: str
    right: str


Path = tuple[RclNode, ...]
"""A leaf with all that it is part of, the root first."""


def paths_of(tree: RclNode) -> list[Path]:
    """The leaves of a tree with their paths, from left to right as the children stand."""
    return list(_walk(tree, ()))


def _walk(node: RclNode, above: Path) -> Iterator[Path]:
    path = (*above, node)
    if node.concept is not None:
        yield path
    for child in node.children:
        yield from _walk(child, path)


def juncture_of(left: Path | None, right: Path | None) -> Juncture:
    """The juncture between two leaves that follow each other; None stands for the edge of the sentence."""
    if left is None or right is None:
        known = left or right or ()
        part = known[-2].label if len(known) > 1 else EDGE
        return Juncture(EDGE, EDGE if left is None else part, EDGE if right is None else part)
    shared = 0
    while shared < min(len(left), len(right)) - 1 and left[shared] is right[shared]:
        shared += 1
    if shared == 0:
        return Juncture(EDGE, left[0].label, right[0].label)
    return Juncture(left[shared - 1].label, left[shared].label, right[shared].label)
