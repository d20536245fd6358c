"""Our RCL tree written with the labels of the public annotation."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from learning.concept_id import Concept
from learning.evaluation.innate_names import AS_HEADING, AS_RELATION, AS_WORD
from learning.evaluation.public_tree import PublicNode
from learning.grammar.innate import OTHER, REFERENCES
from learning.grammar.rcl import RclNode
from learning.grammar.reading_tree import GROUP

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
    return _Writer(names, word_tokens, _antecedent(tree)).node(tree)


def _antecedent(tree: RclNode) -> RclNode | None:
    """What a tree refers back to: what is taken in a sequence, else the last thing spoken of before "one"."""
    entities = [node for node in tree.nodes() if node.label == "entity"]
    referring = [node for node in entities if any(child.concept in REFERENCES for child in node.children)]
    if tree.label == "sequence":
        return entities[0] if entities else None
    if not referring:
        return None
    before = [node for node in entities if node not in referring and node.first < referring[0].first]
    return max(before, key=lambda node: node.first, default=None)


class _Writer:
    def __init__(self, names: Mapping[Concept, str], word_tokens: Sequence[int], antecedent: RclNode | None) -> None:
        self._names = names
        self._tokens = word_tokens
        self._antecedent = antecedent

    def node(self, node: RclNode, parent: RclNode | None = None) -> PublicNode:
        """Write one node and what is below it."""
        if node.concept is not None:
            return self._leaf(node, node.concept, parent)
        if node.label == "measure":
            # The release has what is counted as an entity of its own.
            inner = _sorted([self._leaf(child, child.concept, node) for child in node.children if child.concept])
            return PublicNode("measure", None, None, (PublicNode("entity", None, None, inner),))
        extra = self._references(node) if node.label == "entity" else []
        said = [child for child in node.children if child.concept != OTHER]  # the release has no label for it
        children = [*extra, *(self.node(child, node) for child in said)]
        if node.label == "spatial-relation":
            children = _usual_relation(children, parent is not None and parent.label == "destination")
        if node.label == "entity":
            children += _implied_type(children)
        if node.label == "event" and parent is not None and node is not parent.children[0]:
            children += _implied_reference(children)
        return PublicNode(node.label, None, None, _sorted(children))

    def _leaf(self, node: RclNode, concept: Concept, parent: RclNode | None) -> PublicNode:
        span = self._tokens[node.first - 1], self._tokens[node.last - 1]
        label, value = LEAF_LABELS.get(node.label, node.label), self._names.get(concept, "?")
        if concept in AS_WORD:
            label, value = AS_WORD[concept]
        if concept in AS_RELATION and parent is not None and parent.label == "spatial-relation":
            measured = any(child.label == "measure" for child in parent.children)
            label, value = "relation", (AS_HEADING if measured else AS_RELATION)[concept]
        if node.label == GROUP:
            label, value = "type", f"{value}-group"
        return PublicNode(label, value, span)

    def _references(self, node: RclNode) -> list[PublicNode]:
        """Number of what an entity refers to, or by which it is referred to."""
        if any(child.concept in REFERENCES for child in node.children):
            return [PublicNode("reference-id", "1")]
        return [PublicNode("id", "1")] if node is self._antecedent else []


def _usual_relation(children: list[PublicNode], of_destination: bool) -> list[PublicNode]:
    """Name a relation to a place as the release does, where several relations to it amount to the same.

    A thing is `above` the board or an edge, never `within` them; it is put `within` a corner, never `nearest` to it.
    """
    grounds = {value for child in children if child.label == "entity" for value in child.values("type")[:1]}
    usual = {"within": "above"} if grounds & {"board", "edge"} else {}
    if of_destination and grounds & {"corner"}:
        usual["nearest"] = "within"
    return [
        replace(child, value=usual[child.value]) if child.label == "relation" and child.value in usual else child
        for child in children
    ]


def _implied_type(children: Sequence[PublicNode]) -> list[PublicNode]:
    """What the release says an entity is where no word does."""
    labels = [child.label for child in children]
    if "type" in labels:
        return []
    if "color" not in labels:
        return [PublicNode("type", "region" if "indicator" in labels else "cube")]
    return [PublicNode("type", "stack" if labels.count("color") > 1 else "cube")]


def _implied_reference(children: Sequence[PublicNode]) -> list[PublicNode]:
    """The release writes "it" in a second event also where nobody said it."""
    if any(child.label == "entity" for child in children):
        return []
    parts = (PublicNode("type", "reference"), PublicNode("reference-id", "1"))
    return [PublicNode("entity", None, None, parts)]


def _sorted(children: Sequence[PublicNode]) -> tuple[PublicNode, ...]:
    return tuple(sorted(children, key=lambda child: _RANK.get(child.label, len(_RANK))))
