"""Bounds of grammar induction: a supervised grammar above, chunking without meaning and right branching below."""

import math
from collections import Counter
from collections.abc import Iterable, Sequence

from learning.concept_id import REFERENCE, Concept
from learning.evaluation.public_tree import PublicNode, Span
from learning.evaluation.table_gold import GoldLeaf, GoldSentence
from learning.grammar.rcl import RclNode
from learning.grammar.table_chart import ELEMENTS
from learning.grounding.tongue import Tongue

SUPERVISED = (
    "PCFG counted from the true trees, smoothed, with the parser of ours: same chart, same division of words and "
    "same allowance for unknown words"
)
RELATION = {"direction": "relation", "distance": "relation"}
"""Elements that the public annotation does not tell apart; neither does the sub-tree score."""
SPACES = {element: space for space, element in ELEMENTS.items()}
UNSUPERVISED = "chunks by mutual information of neighbouring words, the closest joined first; brackets without labels"


def supervised(sentences: Iterable[GoldSentence]) -> Tongue:
    """A tongue whose words and rules are counted from true trees."""
    tongue = Tongue()
    given = [each for each in sentences if each.tree is not None]
    for sentence in given:
        tongue.joined.hear(sentence.words)
    numbers: dict[str, int] = {}
    for sentence in given:
        _count(tongue, sentence, numbers)
    return tongue


def _count(tongue: Tongue, sentence: GoldSentence, numbers: dict[str, int]) -> None:
    passed = set(range(1, len(sentence.words) + 1))
    for leaf in sentence.leaves:
        passed -= set(range(leaf.head[0], leaf.head[1] + 1))
        ngram = _pieces_of(tongue, sentence, leaf)
        concept = _concept(leaf, numbers)
        tongue.grounding.add(ngram, concept)
        tongue.grammar.add_terminal(concept.space, ngram)
    for at in passed:
        for piece in tongue.joined.pieces(sentence.words[at - 1]):
            tongue.grounding.add(piece, None)
    if sentence.tree is None:
        return
    tongue.grammar.add_rule("command", (sentence.tree.label,))
    for node in sentence.tree.nodes():
        if node.children:
            tongue.grammar.add_rule(node.label, tuple(child.label for child in node.children))


def _pieces_of(tongue: Tongue, sentence: GoldSentence, leaf: GoldLeaf) -> str:
    """The pieces of a leaf's head; of a joined word the stem, or its ending for a pronoun."""
    words = sentence.words[leaf.head[0] - 1 : leaf.head[1]]
    pieces = [piece for word in words for piece in tongue.joined.pieces(word)]
    if len(words) == 1 and len(pieces) > 1:
        return pieces[-1] if leaf.element == "reference" else max(pieces, key=len)
    return " ".join(pieces)


def _concept(leaf: GoldLeaf, numbers: dict[str, int]) -> Concept:
    if leaf.element == "reference":
        return REFERENCE
    space = SPACES.get(leaf.element, leaf.element)
    return Concept(space, numbers.setdefault(f"{space}:{leaf.value}", len(numbers)))


def public_from(tree: RclNode | None, gold: GoldSentence) -> PublicNode | None:
    """A tree of ours as one to score: a leaf around a head of its element, within the phrase, is at that head."""
    if tree is None:
        return None
    if tree.concept is not None:
        span = tree.first, tree.last
        for leaf in gold.leaves:
            within = leaf.phrase[0] <= tree.first <= leaf.head[0] and leaf.head[1] <= tree.last <= leaf.phrase[1]
            if leaf.element == tree.label and within:
                span = leaf.head
        return PublicNode(RELATION.get(tree.label, tree.label), str(tree.concept), span)
    children = [public_from(child, gold) for child in tree.children]
    return PublicNode(tree.label, None, None, tuple(child for child in children if child is not None))


class Chunker:
    """Unsupervised brackets: neighbours that go together more than chance are joined first (after Ponvert 2011)."""

    def __init__(self, sentences: Iterable[Sequence[str]]) -> None:
        """Count words and neighbours."""
        self._words: Counter[str] = Counter()
        self._pairs: Counter[tuple[str, str]] = Counter()
        for words in sentences:
            self._words.update(words)
            self._pairs.update(zip(words, words[1:], strict=False))

    def brackets(self, words: Sequence[str]) -> Counter[Span]:
        """Spans of all chunks with more than one word, from 1."""
        units = [(at + 1, at + 1) for at in range(len(words))]
        found: Counter[Span] = Counter()
        while len(units) > 1:
            bonds = [self._bond(words[a[1] - 1], words[b[0] - 1]) for a, b in zip(units, units[1:], strict=False)]
            at = max(range(len(bonds)), key=lambda index: (bonds[index], -index))
            units[at : at + 2] = [(units[at][0], units[at + 1][1])]
            found[units[at]] += 1
        return found

    def _bond(self, one: str, two: str) -> float:
        total = max(1, self._words.total())
        chance = (self._words[one] + 0.5) * (self._words[two] + 0.5) / total
        return math.log((self._pairs[one, two] + 0.1) / chance)


def right_branching(words: Sequence[str]) -> Counter[Span]:
    """Spans from each word to the end, from 1."""
    return Counter((at + 1, len(words)) for at in range(len(words) - 1))


def bracket_f1(ours: Counter[Span], gold: PublicNode) -> float:
    """F1 over spans of more than one word, labels apart."""
    spans = {span for node in gold.nodes() if (span := node.span()) is not None and span[0] < span[1]}
    wanted = Counter(spans)
    total = ours.total() + wanted.total()
    return 2.0 * (ours & wanted).total() / total if total else 1.0
