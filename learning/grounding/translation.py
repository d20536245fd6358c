"""Words of two languages that mean the same concept: a lexicon that nobody wrote (thesis 6.4.2)."""

from dataclasses import dataclass

from learning.concept_id import Concept
from learning.grounding.table_language import TableLanguage
from learning.grounding.tongue import Tongue

LEAST_COUNT = 3.0
"""Readings of a word before it is translated,"""
MAINLY = 0.5
"""and the share of them that must have one meaning."""


@dataclass(frozen=True, slots=True)
class Translation:
    """A word and what it is in another language.

    Attributes:
        ngram: The word, or words.
        script: Script of its language.
        other: What it is in the other language.
        other_script: That language's script.
        concept: What both mean.
    """

    ngram: str
    script: str
    other: str
    other_script: str
    concept: Concept


def translations(language: TableLanguage) -> list[Translation]:
    """Each n-gram with one main meaning, and the most frequent n-gram of each other language with that meaning."""
    names = {script: named_concepts(tongue) for script, tongue in sorted(language.tongues.items())}
    found = []
    for script, own in names.items():
        for other_script, others in names.items():
            if other_script == script:
                continue
            for concept, ngrams in sorted(own.items()):
                if concept in others:
                    found += [Translation(each, script, others[concept][0], other_script, concept) for each in ngrams]
    return found


def named_concepts(tongue: Tongue) -> dict[Concept, list[str]]:
    """Concepts with the n-grams whose main meaning they are, the most frequent first."""
    found: dict[Concept, list[tuple[float, str]]] = {}
    for ngram, row in tongue.grounding.counts.items():
        total = sum(row.values())
        for concept, count in row.items():
            if concept is not None and count >= LEAST_COUNT and count >= MAINLY * total:
                found.setdefault(concept, []).append((-count, ngram))
    return {concept: [ngram for _, ngram in sorted(entries)] for concept, entries in found.items()}
