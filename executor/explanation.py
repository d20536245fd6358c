"""How a sentence is understood, in rows that people can read."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from learning.concept_id import Concept
from learning.grammar.viterbi import Bracket

MEANINGS = 3
"""Meanings of a word that are told, the most frequent first."""
MAINLY = 0.6
"""Share of its readings that the main meaning of a word has at least."""
LEAST_SHARE = 0.05
"""Rarer meanings are not told."""


@dataclass(frozen=True, slots=True)
class WordRow:
    """One word.

    Attributes:
        word: The word.
        meant: What it is taken to mean here; empty where it is passed over.
        usual: What it usually means, with shares of its readings.
    """

    word: str
    meant: str
    usual: str


@dataclass(frozen=True, slots=True)
class Referent:
    """What a part of the sentence is about.

    Attributes:
        words: The part.
        what: Its element.
        found: What it denotes in the scene.
    """

    words: str
    what: str
    found: str


@dataclass(frozen=True, slots=True)
class Alternative:
    """Another way to understand the sentence.

    Attributes:
        tree: Its tree on one line.
        does: What it would do.
        share: Its share of all readings.
        why: Why it lost.
    """

    tree: str
    does: str
    share: float
    why: str


@dataclass(frozen=True, slots=True)
class Explanation:
    """All that there is to tell.

    Attributes:
        understood: Whether there is something to do.
        summary: What was understood, or why nothing was.
        words: Its words.
        tree: Its tree, as indented text; None where there is none.
        referents: What its parts are about.
        alternatives: Other ways to understand it, the likeliest first.
        plain: Its tree by grammar and words alone, on one line, without a look at the scene; None where there is none.
        notes: Words that are not taken to mean what they usually do: no reading with it fits the scene as well.
        unknown: Words that were never heard.
        confidence: Share of what was understood among all readings; None where readings have no shares.
    """

    understood: bool
    summary: str
    words: tuple[WordRow, ...]
    tree: str | None
    referents: tuple[Referent, ...] = ()
    alternatives: tuple[Alternative, ...] = ()
    plain: str | None = None
    notes: tuple[str, ...] = ()
    unknown: tuple[str, ...] = field(default_factory=tuple)
    confidence: float | None = None


def usual_meanings(row: Mapping[Concept | None, float]) -> str:
    """What a word was read as, with shares."""
    total = sum(max(0.0, count) for count in row.values())
    if total <= 0.0:
        return "-"
    told = sorted(((count / total, concept) for concept, count in row.items()), key=lambda each: -each[0])
    parts = [
        f"{'nothing' if concept is None else concept} ({share:.2f})"
        for share, concept in told[:MEANINGS]
        if share >= LEAST_SHARE
    ]
    return ", ".join(parts)


def main_meaning(row: Mapping[Concept | None, float]) -> Concept | None:
    """What a word mainly means; None where that is nothing, or no one thing."""
    total = sum(max(0.0, count) for count in row.values())
    return next((concept for concept, count in row.items() if total and count > MAINLY * total), None)


def bracketed(tree: Bracket, words: tuple[str, ...]) -> str:
    """A tree on one line."""
    if not tree.children:
        return f"{tree.label} “{' '.join(words[tree.first : tree.after])}”"
    return f"{tree.label}({', '.join(bracketed(child, words) for child in tree.children)})"


def on_one_line(lines: Iterable[str]) -> str:
    """Parts of a list in one line."""
    return "; ".join(lines) or "-"
