"""What a reading leaves out: words that surely name what a thing is like and were passed over, or that nothing fits."""

from collections.abc import Iterator, Mapping

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import element_of
from learning.grounding.tongue import Tongue
from learning.interpretation.interpretation import ESTABLISHED, MEANINGFUL
from learning.saying.table_understanding import TableDenotation

UNNAMED = ("reference", "spatial-relation")
"""Parts of entities that do not say what a thing is like."""


def unheeded_nodes(
    tongue: Tongue, words: tuple[str, ...], tree: RclNode, spaces: Mapping[str, object]
) -> list[RclNode]:
    """Words with a sure meaning that a tree passes over, each as an entity that it may name.

    Args:
        tongue: The language.
        words: The sentence.
        tree: Its tree.
        spaces: Spaces of what things are like.
    """
    heeded = {at for node in tree.nodes() if node.concept is not None for at in range(node.first, node.last + 1)}
    found = []
    for at, word in enumerate(words, start=1):
        concept = None if at in heeded else _surely(tongue, word)
        if concept is not None and element_of(concept) in spaces:
            found.append(RclNode("entity", None, at, at, (RclNode(element_of(concept), concept, at, at),)))
    return found


def absent_phrases(words: tuple[str, ...], nodes: list[RclNode], denotation: TableDenotation) -> Iterator[str]:
    """Walk the words of entities that nothing is; of one that would be somewhere else, with where it should be."""
    for node in nodes:
        if node.label != "entity" or any(child.label == "reference" for child in node.children):
            continue
        named = tuple(child for child in node.children if child.label not in UNNAMED)
        if not denotation.things(RclNode("entity", None, node.first, node.last, named)):
            yield " ".join(" ".join(words[leaf.first - 1 : leaf.last]) for leaf in named)
        elif not denotation.things(node):
            yield " ".join(words[node.first - 1 : node.last])


def _surely(tongue: Tongue, word: str) -> Concept | None:
    """What a word means in most of its uses; None where it was heard too seldom or in too many ways."""
    row = tongue.grounding.counts.get(word)
    if row is None:
        return None
    concept, count = max(row.items(), key=lambda each: each[1], default=(None, 0.0))
    return concept if count >= max(ESTABLISHED, MEANINGFUL * sum(row.values())) else None
