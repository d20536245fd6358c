"""Words that call things of several concepts by one name: perception may divide what people do not."""

from collections.abc import Container, Iterator

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grounding.table_scene import NAMED
from learning.grounding.tongue import Tongue

LEAST_SHARE = 0.3
"""Share of the likeliest meaning of a word that another one of its space has at least, to be meant too."""


def also_meant(
    tongue: Tongue, words: tuple[str, ...], tree: RclNode, measured: Container[str]
) -> dict[Concept, frozenset[Concept]]:
    """Concepts of a tree with the others of their space that its words name as well ("tub", of which there are two).

    Args:
        tongue: The language.
        words: The sentence.
        tree: How it is understood.
        measured: Spaces of what things look like.
    """
    found: dict[Concept, frozenset[Concept]] = {}
    for node in tree.nodes():
        concept = node.concept
        if concept is not None and _space(concept) in measured:
            others = frozenset(_others(tongue, words[node.first - 1 : node.last], concept))
            if others:
                found[concept] = found.get(concept, frozenset()) | others
    return found


def _others(tongue: Tongue, said: tuple[str, ...], concept: Concept) -> Iterator[Concept]:
    pieces, _ = tongue.joined.split(said)
    for ngram in dict.fromkeys((" ".join(said), *pieces)):
        meanings = tongue.meanings(ngram)
        of_space = {
            each: share for each, share in meanings.items() if each is not None and _space(each) == _space(concept)
        }
        if concept in of_space:
            least = LEAST_SHARE * max(of_space.values())
            for each, share in of_space.items():
                if each != concept and share >= least and _usual_name(tongue, each) == ngram:
                    yield each


def _usual_name(tongue: Tongue, concept: Concept) -> str:
    """What a concept is called most often: what has a name of its own is not meant by that of another."""
    counts = tongue.grounding.counts
    return max(counts, key=lambda ngram: (counts[ngram].get(concept, 0.0), ngram), default="")


def _space(concept: Concept) -> str:
    return concept.space.removeprefix(NAMED)
