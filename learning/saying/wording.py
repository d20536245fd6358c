"""Meanings put into words: the likeliest names and words between them, found by dynamic programming over the leaves."""

import math
from dataclasses import dataclass

from learning.concept_id import ACTION_SPACE
from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode
from learning.saying.juncture import EDGE, Juncture, Path, juncture_of, paths_of
from learning.saying.ordering import ordered
from learning.saying.phrasing import UNHEARD, Name, Phrasing, beside, use_of

JOIN = "+"
"""Marks a part of a word on the side where it is joined to what is beside it."""
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
    """The words up to a leaf whose name was chosen."""

    score: float
    pieces: tuple[str, ...]


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
    states: dict[Name, _Said] = {EDGE: _Said(score, ())}
    before: Path | None = None
    label = EDGE
    for path in (*paths_of(tree), None):
        leaf = None if path is None else path[-1]
        where = juncture_of(before, path)
        if before is None and tree.label == "entity":
            where, label = AFTER_ACTION, ACTION_SPACE  # a thing is told as it is in a command
        names = [EDGE] if leaf is None or leaf.concept is None else [n for n, _ in phrasing.names_of(leaf.concept)]
        agrees = before is not None and path is not None and beside(before, path)
        reached: dict[Name, _Said] = {}
        for name in names:
            options = []
            for known, said in states.items():
                own = 0.0
                if path is not None and leaf is not None and leaf.concept is not None:
                    chance = phrasing.name_probability(leaf.concept, name, use_of(path), known if agrees else EDGE)
                    own = math.log(max(chance, UNHEARD)) + 2.0 * math.log(phrasing.clarity(name, leaf.concept))
                right = (EDGE, EDGE) if leaf is None else (leaf.label, name)
                for between, share in phrasing.fillers_at((label, known), where, right)[:TRIED]:
                    more = (*between.split(" "),) if between else ()
                    named = () if leaf is None else tuple(name.split(" "))
                    total = said.score + own + math.log(max(share, UNHEARD))
                    options.append(_Said(total, (*said.pieces, *more, *named)))
            if options:
                reached[name] = max(options, key=lambda each: each.score)
        if not reached:
            return None
        states = reached
        before, label = path, EDGE if leaf is None else leaf.label
    best = states[EDGE]
    return Wording(joined(best.pieces), best.score, tree)


def joined(pieces: tuple[str, ...]) -> tuple[str, ...]:
    """Words out of pieces, some of which are marked as joined to what is beside them."""
    words: list[str] = []
    open_end = False
    for piece in pieces:
        text = piece.strip(JOIN)
        if words and (open_end or piece.startswith(JOIN)):
            words[-1] += text
        else:
            words.append(text)
        open_end = piece.endswith(JOIN)
    return tuple(words)


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
