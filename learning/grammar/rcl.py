"""Robot Control Language trees Ψ (thesis 5.2, table 5.1)."""

from collections.abc import Iterator
from dataclasses import dataclass

from learning.concept_id import Concept


@dataclass(frozen=True, slots=True)
class RclNode:
    """One node of an RCL tree.

    Attributes:
        label: RCL element: `sequence`, `event`, `action`, `entity`, `destination`, `spatial-relation`, or a feature
            space (`colour`, `direction` ...).
        concept: The concept of a leaf, else None.
        first: First word of the node, 1-based.
        last: Last word of the node, 1-based.
        children: Sub-trees from left to right.
    """

    label: str
    concept: Concept | None
    first: int
    last: int
    children: tuple["RclNode", ...] = ()

    def nodes(self) -> Iterator["RclNode"]:
        """Walk the tree, this node first."""
        yield self
        for child in self.children:
            yield from child.nodes()

    def rules(self) -> Iterator[tuple[str, tuple[str, ...]]]:
        """Give the production of every inner node: left-hand side and the labels of its children."""
        for node in self.nodes():
            if node.children:
                yield node.label, tuple(child.label for child in node.children)

    def draw(self, words: tuple[str, ...], indent: int = 0) -> str:
        """Write the tree as indented text, leaves with their words and concepts."""
        pad = "  " * indent
        if self.concept is not None:
            return f"{pad}{self.label}: {self.concept}  “{' '.join(words[self.first - 1 : self.last])}”"
        return "\n".join([f"{pad}{self.label}", *(child.draw(words, indent + 1) for child in self.children)])
