"""Meanings put into words: the likeliest names and words between them, found by dynamic programming over the leaves."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from learning.concept_id import ACTION_SPACE
from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode
from learning.saying.juncture import EDGE, Juncture, Path, juncture_of, paths_of
from learning.saying.ordering import ordered
from learning.saying.phrasing import JOIN, UNHEARD, Name, Phrasing, beside, element, use_of

AFTER_ACTION = Juncture("event", ACTION_SPACE, "entity")
TRIED = 3
"""Words between that are tried at each juncture."""


@dataclass(frozen=True, slots=True)
class Wording:
    """A sentence.

    Attributes:
        words: Its words.
        score: Log probability of its rules, names and words between.
        tree: Its meaning, parts in the order of speech.
    """

    words: tuple[str, ...]
    score: float
    tree: RclNode

    @property
    def text(self) -> str:
        """The sentence as people write it."""
        return " ".join(self.words)


@dataclass(frozen=True, slots=True)
class _Said:
    """The words up to a leaf whose name was chosen.

    Attributes:
        score: Log probability.
        pieces: The words so far, parts of words apart.
        spans: First and last piece of each leaf so far, from 0.
    """

    score: float
    pieces: tuple[str, ...]
    spans: tuple[tuple[int, int], ...] = ()


def wording(tree: RclNode, grammar: Pcfg, phrasing: Phrasing) -> Wording | None:
    """Say a meaning; None where it has a part that was never said so, or a concept without a name.

    Args:
        tree: What to say; see `meaning`.
        grammar: Π, for the order of parts.
        phrasing: Names and words between.
    """
    arranged = ordered(tree, grammar)
    if arranged is None:
        return None
    tree, score = arranged
    # By the name that was said last, as all that follows depends on no more of what was said.
    states: dict[Name, _Said] = {EDGE: _Said(score, ())}
    before: Path | None = None
    for path in (*paths_of(tree), None):
        states = _extended(states, before, path, phrasing)
        before = path
    best = states.get(EDGE)
    if best is None:
        return None
    words, origin = joined(best.pieces)
    leaves = iter([(origin[first] + 1, origin[last] + 1) for first, last in best.spans])
    return Wording(words, best.score, _spanned(tree, leaves))


def _spanned(node: RclNode, leaves: Iterator[tuple[int, int]]) -> RclNode:
    """A tree with the words of its leaves, counted from 1."""
    if node.concept is not None:
        first, last = next(leaves)
        return replace(node, first=first, last=last)
    children = tuple(_spanned(child, leaves) for child in node.children)
    first, last = min(child.first for child in children), max(child.last for child in children)
    return replace(node, first=first, last=last, children=children)


def _extended(
    states: dict[Name, _Said], before: Path | None, path: Path | None, phrasing: Phrasing
) -> dict[Name, _Said]:
    """The likeliest words up to each name of the next leaf, or up to the end where there is none."""
    left, where = (EDGE if before is None else element(before)), juncture_of(before, path)
    if before is None and path is not None and path[0].label == "entity":
        left, where = ACTION_SPACE, AFTER_ACTION  # a thing by itself is told as it is in a command
    reached: dict[Name, _Said] = {}
    for known, said in states.items():
        for name, own in _named(known, before, path, phrasing):
            right = (EDGE, EDGE) if path is None else (element(path), name)
            for between, share in phrasing.fillers_at((left, known), where, right)[:TRIED]:
                total = said.score + own + math.log(max(share, UNHEARD))
                if name not in reached or reached[name].score < total:
                    named = () if path is None else tuple(name.split(" "))
                    pieces = (*said.pieces, *between.split(), *named)
                    span = ((len(pieces) - len(named), len(pieces) - 1),) if named else ()
                    reached[name] = _Said(total, pieces, (*said.spans, *span))
    return reached


def _named(known: Name, before: Path | None, path: Path | None, phrasing: Phrasing) -> list[tuple[Name, float]]:
    """Names of a leaf with their log probabilities, unclear ones lowered."""
    concept = None if path is None else path[-1].concept
    if path is None or concept is None:
        return [(EDGE, 0.0)]
    agrees = before is not None and beside(before, path)
    shares = phrasing.names_beside(concept, element(path), use_of(path), known if agrees else EDGE)
    return [
        (name, math.log(max(shares[name], UNHEARD)) + 2.0 * math.log(phrasing.clarity(name, concept)))
        for name, _ in phrasing.names_of(concept)
    ]


def different(wordings: Iterable[Wording], count: int) -> list[Wording]:
    """The likeliest of different sentences, the best first."""
    found: dict[tuple[str, ...], Wording] = {}
    for each in wordings:
        if each.words not in found or found[each.words].score < each.score:
            found[each.words] = each
    return sorted(found.values(), key=lambda each: -each.score)[:count]


def joined(pieces: tuple[str, ...]) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Words out of pieces, some of which are marked as joined to what is beside them; and the word of each piece."""
    words: list[str] = []
    origin: list[int] = []
    open_end = False
    for piece in pieces:
        text = piece.strip(JOIN)
        if words and (open_end or piece.startswith(JOIN)):
            words[-1] += text
        else:
            words.append(text)
        origin.append(len(words) - 1)
        open_end = piece.endswith(JOIN)
    return tuple(words), tuple(origin)


def marked(pieces: tuple[str, ...], origin: tuple[int, ...]) -> tuple[str, ...]:
    """Pieces with marks where they are joined to the longest piece of their word.

    Args:
        pieces: Pieces of a sentence.
        origin: Index of the word that each belongs to.
    """
    found = []
    for index, piece in enumerate(pieces):
        stem = max((at for at in range(len(pieces)) if origin[at] == origin[index]), key=lambda at: len(pieces[at]))
        found.append(f"{piece}{JOIN}" if index < stem else f"{JOIN}{piece}" if index > stem else piece)
    return tuple(found)
