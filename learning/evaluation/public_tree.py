"""Robot Control Language trees with the public labels, and how alike two of them are."""

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

Span = tuple[int, int]


@dataclass(frozen=True, slots=True)
class PublicNode:
    """One node of a tree with public labels (`color`, `type`, `relation`, ...).

    Attributes:
        label: Public label.
        value: Public value of a leaf (`red`, `prism`, `above`, the number of an id), else None.
        tokens: First and last token that the node itself is aligned to, 1-based, else None.
        children: Sub-trees in order.
    """

    label: str
    value: str | None = None
    tokens: Span | None = None
    children: tuple["PublicNode", ...] = ()

    def nodes(self) -> Iterator["PublicNode"]:
        """Walk the tree, this node first."""
        yield self
        for child in self.children:
            yield from child.nodes()

    def span(self) -> Span | None:
        """First and last token of the node and all below it; None when nothing is aligned."""
        spans = [node.tokens for node in self.nodes() if node.tokens is not None]
        if not spans:
            return None
        return min(first for first, _ in spans), max(last for _, last in spans)

    def values(self, label: str) -> list[str]:
        """Values of all nodes with a label, in order."""
        return [node.value for node in self.nodes() if node.label == label and node.value is not None]

    def without_tokens(self) -> "PublicNode":
        """Return the tree without its alignment: labels, values and structure."""
        return PublicNode(self.label, self.value, None, tuple(child.without_tokens() for child in self.children))

    def __str__(self) -> str:
        """Write the tree in the form of the release."""
        parts = [] if self.value is None else [self.value]
        if self.tokens is not None:
            first, last = self.tokens
            parts.append(f"(token: {first})" if first == last else f"(token: {first} {last})")
        parts += [str(child) for child in self.children]
        return f"({self.label}: {' '.join(parts)})"


def labelled_spans(tree: PublicNode) -> Counter[tuple[str, int, int]]:
    """Count (label, first token, last token) of all aligned nodes; ids and implied nodes have no span: left out."""
    found: Counter[tuple[str, int, int]] = Counter()
    for node in tree.nodes():
        span = node.span()
        if span is not None:
            found[node.label, span[0], span[1]] += 1
    return found


def subtree_f1(ours: PublicNode | None, theirs: PublicNode) -> float:
    """F1 in 0..1 over (label, first token, last token) of all nodes (thesis 6.5); no tree of ours gives 0."""
    if ours is None:
        return 0.0
    mine, wanted = labelled_spans(ours), labelled_spans(theirs)
    total = mine.total() + wanted.total()
    return 2.0 * (mine & wanted).total() / total if total else 1.0


def same_tree(ours: PublicNode | None, theirs: PublicNode) -> bool:
    """Whether labels, values and structure are equal; alignment is left to the sub-tree score."""
    return ours is not None and ours.without_tokens() == theirs.without_tokens()
