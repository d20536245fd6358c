"""What every word that was heard means, and how sure that is: of the board's language and of those of tables."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from executor.table_words import LEAST_SHARE
from executor.word_kinds import WordKind, kind_of
from learning.concept_id import Concept
from learning.grounding.reading_learner import ReadingLearner
from learning.grounding.scripts import script_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from learning import Knowledge


SURE = 0.4
"""Least share of a word's main meaning from which on it counts as known."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One word.

    Attributes:
        word: The word.
        kind: What it is about.
        concept: What it mostly means; None where that is nothing by itself.
        share: How sure that is, 0..1.
        heard: How often it was heard or read.
    """

    word: str
    kind: WordKind
    concept: Concept | None
    share: float
    heard: float


def lexicon(knowledge: "Knowledge") -> list[Entry]:
    """All single words, the most frequent first."""
    entries = [*_of_board(knowledge), *_of_tables(knowledge)]
    return sorted(entries, key=lambda entry: (-entry.heard, entry.word))


def entry_of(knowledge: "Knowledge", word: str) -> Entry:
    """What one word means, of kind `UNKNOWN` where it was never heard, `UNSURE` where it was never read."""
    tongue = knowledge.table_language.tongues.get(script_of((word,)))
    if tongue is not None:
        pieces = tongue.joined.pieces(word)
        rows = [tongue.grounding.counts[piece] for piece in pieces if piece in tongue.grounding.counts]
        # A word may be several joined ones; what it is about is what says something.
        told = [entry for row in rows if (entry := _table_entry(word, row)) is not None]
        told.sort(key=lambda entry: (entry.concept is None, -entry.share))
        heard = max((tongue.joined.counts.get(piece, 0.0) for piece in (word, *pieces)), default=0.0)
        return told[0] if told else Entry(word, WordKind.UNSURE if heard else WordKind.UNKNOWN, None, 0.0, heard)
    return next((entry for entry in _of_board(knowledge, (word,))), Entry(word, WordKind.UNKNOWN, None, 0.0, 0.0))


def heard_words(knowledge: "Knowledge", like: str) -> "Mapping[str, float]":
    """Single words of the language that a word is of, as they were heard, with how often; letters decide on it."""
    tongues = knowledge.table_language.tongues
    if tongues:
        tongue = tongues.get(script_of((like,)))
        return {} if tongue is None else tongue.joined.counts
    language = knowledge.language
    if isinstance(language, ReadingLearner):
        return language.alignment.word_counts
    return {word: sum(row.values()) for word, row in language.grounding.counts.items() if " " not in word}


def _of_board(knowledge: "Knowledge", only: tuple[str, ...] | None = None) -> "Iterator[Entry]":
    language = knowledge.language
    if isinstance(language, ReadingLearner):
        heard = language.alignment.word_counts
        for word in heard if only is None else [each for each in only if each in heard]:
            entry = _entry(word, language.meanings(word), heard[word])
            if entry is not None:
                yield entry
        return
    counts = language.grounding.counts
    for word in counts if only is None else [each for each in only if each in counts]:
        entry = _entry(word, counts[word], sum(counts[word].values()))
        if entry is not None and " " not in word:
            yield entry


def _of_tables(knowledge: "Knowledge") -> "Iterator[Entry]":
    for tongue in knowledge.table_language.tongues.values():
        for ngram, row in tongue.grounding.counts.items():
            entry = _table_entry(ngram, row)
            if entry is not None and " " not in ngram:
                yield entry


def _table_entry(word: str, row: "Mapping[Concept | None, float]") -> Entry | None:
    """An entry of a language of tables, where words that mean something are passed over in many sentences, too."""
    meant: dict[Concept | None, float] = {concept: count for concept, count in row.items() if concept is not None}
    said = max(meant.values(), default=0.0) >= LEAST_SHARE * sum(row.values())
    return _entry(word, meant if said else row, sum(row.values()))


def _entry(word: str, row: "Mapping[Concept | None, float]", heard: float) -> Entry | None:
    """An entry by the largest share of a row of counts or probabilities; None where nothing is left of them."""
    total = sum(max(0.0, value) for value in row.values())
    if total <= 0.0:
        return None
    concept, value = max(row.items(), key=lambda pair: pair[1])
    share = value / total
    return Entry(word, kind_of(concept) if share >= SURE else WordKind.UNSURE, concept, share, heard)
