"""What was learned of the languages of tables: the words of each concept in each language, and translations."""

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from executor.commands.output import Output
    from learning import Knowledge
    from learning.concept_id import Concept
    from learning.grounding.table_language import TableLanguage
    from learning.grounding.tongue import Tongue

WORDS = 6
"""Most n-grams shown with one concept."""
LEAST_SUPPORT = 1.5
"""An n-gram stands with a concept when it was read so at least this often,"""
LEAST_SHARE = 0.2
"""and in at least this share of all its readings."""


def table_words(knowledge: "Knowledge") -> dict[str, dict[str, dict[str, float]]]:
    """Script of each language to concept to n-gram to Φ."""
    return {
        script: {
            str(concept): {ngram: round(share, 3) for ngram, share, _ in entries}
            for concept, entries in sorted(meanings_of(tongue).items())
        }
        for script, tongue in sorted(knowledge.table_language.tongues.items())
    }


def tell_table_words(out: "Output", knowledge: "Knowledge") -> None:
    """Print the words of each concept in each language, function words, rules and translations; if any were learned."""
    from learning.grounding.translation import translations

    language = knowledge.table_language
    scripts = sorted(language.tongues)
    if not scripts:
        return
    words = {script: meanings_of(tongue) for script, tongue in language.tongues.items()}
    concepts = sorted({concept for row in words.values() for concept in row})
    rows = [(str(concept), *(_spoken(words[script].get(concept, [])) for script in scripts)) for concept in concepts]
    out.table("Words at tables (Φ)", ("concept", *(script.lower() for script in scripts)), rows)
    out.table(
        "Words that mean nothing by themselves",
        ("script", "words"),
        [(script.lower(), ", ".join(_passed(language.tongues[script]))) for script in scripts],
    )
    rules = [
        (script.lower(), left, " ".join(right), f"{count:.0f}")
        for script in scripts
        for left, row in sorted(language.tongues[script].grammar.rules.items())
        for right, count in sorted(row.items(), key=lambda entry: -entry[1])[:3]
        if count >= 1.0
    ]
    out.table("Grammar of each language", ("script", "element", "becomes", "count"), rules)
    out.table("Size of what is known of languages [kB]", ("part", "kB"), _sizes(language))
    found = translations(language)
    if found:
        pairs = [(each.ngram, each.other, str(each.concept)) for each in found if each.script == scripts[0]]
        out.table("Translations", (scripts[0].lower(), "is", "both mean"), pairs)


def main_words(tongue: "Tongue") -> "dict[Concept, str]":
    """The most frequent word of each concept in one language."""
    return {concept: entries[0][0] for concept, entries in meanings_of(tongue).items()}


def _sizes(language: "TableLanguage") -> list[tuple[str, str]]:
    """Parts of the table language as they are saved, and how much room each takes [kB]."""
    data = language.to_json()
    tongues = data.pop("tongues")
    parts = {
        **data,
        **{f"{script.lower()}: {name}": part for script, row in tongues.items() for name, part in row.items()},
    }
    sizes = {name: len(json.dumps(part, ensure_ascii=False).encode()) for name, part in parts.items()}
    return [(name, f"{size / 1000:.1f}") for name, size in (*sizes.items(), ("all", sum(sizes.values())))]


def meanings_of(tongue: "Tongue") -> "dict[Concept, list[tuple[str, float, float]]]":
    """Concepts to n-grams with Φ and how often they were read so, the most frequent first."""
    found: dict[Concept, list[tuple[str, float, float]]] = {}
    for ngram, row in tongue.grounding.counts.items():
        total = sum(row.values())
        for concept, count in row.items():
            if concept is not None and count >= LEAST_SUPPORT and count >= LEAST_SHARE * total:
                found.setdefault(concept, []).append((ngram, count / total, count))
    return {concept: sorted(entries, key=lambda entry: -entry[2]) for concept, entries in found.items()}


def _spoken(entries: list[tuple[str, float, float]]) -> str:
    return ", ".join(f"{ngram} ({share:.2f})" for ngram, share, _ in entries[:WORDS])


def _passed(tongue: "Tongue") -> list[str]:
    """Words that are mostly passed over, the most frequent first."""
    rows = tongue.grounding.counts
    passed = {
        ngram: row[None]
        for ngram, row in rows.items()
        if row.get(None, 0.0) >= LEAST_SUPPORT and row[None] > 0.5 * sum(row.values())
    }
    return sorted(passed, key=lambda word: -passed[word])[:20]
