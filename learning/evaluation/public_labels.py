"""Our RCL tree written with the labels of the public annotation."""

from collections.abc import Mapping, Sequence

from learning.concept_id import Concept
from learning.evaluation.public_tree import PublicNode
from learning.grammar.rcl import RclNode

LEAF_LABELS = {
    "action": "action",
    "colour": "color",
    "shape": "type",
    "reference": "type",
    "direction": "relation",
    "distance": "relation",
    "location": "entity",
}
"""Feature space of a leaf to the public label. A location is spoken of as an entity of its own ("the left corner")."""
_RANK = {
    name: rank
    for rank, name in enumerate(
        (
            *("action", "measure", "relation", "id", "cardinal", "indicator", "color", "type", "reference-id"),
            *("entity", "spatial-relation", "destination"),
        )
    )
}
"""The release writes the children of a node in this order, whatever the order of the words."""


def public_tree(tree: RclNode, names: Mapping[Concept, str], word_tokens: Sequence[int]) -> PublicNode:
    """Write a tree with public labels and values.

    Args:
        tree: Our tree; its words are counted without punctuation marks.
        names: Public value of each concept; a concept without one gets `?`, which equals nothing.
        word_tokens: Token number of each word.
    """
    refers = any(node.label == "reference" for node in tree.nodes())
    return _Writer(names, word_tokens, refers).node(tree)


class _Writer:
    def __init__(self, names: Mapping[Concept, str], word_tokens: Sequence[int], refers: bool) -> None:
        self._names = names
        self._tokens = word_tokens
        self._antecedent_due = refers

    def node(self, node: RclNode) -> PublicNode:
        """Write one node and what is below it."""
        if node.concept is not None:
            value = "reference" if node.label == "reference" else self._names.get(node.concept, "?")
            span = self._tokens[node.first - 1], self._tokens[node.last - 1]
            return PublicNode(LEAF_LABELS.get(node.label, node.label), value, span)
        extra: list[PublicNode] = []
        if node.label == "entity":
            if any(child.label == "reference" for child in node.children):
                extra.append(PublicNode("reference-id", "1"))
            elif self._antecedent_due:  # what "it" refers to is the first thing that was spoken of
                extra.append(PublicNode("id", "1"))
                self._antecedent_due = False
        children = [*extra, *(self.node(child) for child in node.children)]
        children.sort(key=lambda child: _RANK.get(child.label, len(_RANK)))
        return PublicNode(node.label, None, None, tuple(children))
