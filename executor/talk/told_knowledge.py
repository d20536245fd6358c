"""What was learned, as the page shows it: words and how sure they are, rules, concepts and action graphlets drawn."""

from html import escape
from typing import TYPE_CHECKING

from executor.knowledge_page import knowledge_sections
from executor.learned_tables import rule_rows
from executor.lexicon import Entry, lexicon
from executor.word_kinds import WordKind

if TYPE_CHECKING:
    from learning import Knowledge

MOST_WORDS = 400
"""Words that are listed; more would make the page slow."""
MOST_RULES = 40
NAMES = {WordKind.FUNCTION: "no meaning"}
"""What kinds of words are called, where that is not their own name."""
Section = dict[str, str]


def told_knowledge(knowledge: "Knowledge") -> dict[str, object]:
    """Plain values for the page: counts, the kind of each word, and sections of HTML."""
    entries = lexicon(knowledge)
    sections = [_section("words", "Words", _words(entries)), _section("grammar", "Grammar", _grammar(knowledge))]
    sections += [_section(name, title, html) for name, title, html in knowledge_sections(knowledge)]
    spaces = knowledge.spaces.mixtures.values()
    return {
        "type": "knowledge",
        "demos": knowledge.demos,
        "sentences": knowledge.sentences,
        "concepts": sum(len(mixture.components) for mixture in spaces),
        "actions": len(knowledge.spaces.actions),
        "words": {entry.word: [str(entry.kind), round(entry.share, 3)] for entry in entries[:MOST_WORDS]},
        "sections": sections,
    }


def _section(name: str, title: str, html: str) -> Section:
    return {"name": name, "title": title, "html": html}


def _words(entries: list[Entry]) -> str:
    """The lexicon as a table."""
    if not entries:
        return "<p>No word was heard yet.</p>"
    rows = "".join(
        f'<tr><th scope="row" dir="auto">{escape(entry.word)}</th>'
        f'<td><span class="word" data-kind="{entry.kind}"><b>{NAMES.get(entry.kind, entry.kind)}</b></span></td>'
        f"<td>{'' if entry.concept is None else escape(str(entry.concept))}</td>"
        f'<td><meter min="0" max="1" value="{entry.share:.3f}" aria-label="how sure"></meter> {entry.share:.2f}</td>'
        f"<td>{entry.heard:.0f}</td></tr>"
        for entry in entries[:MOST_WORDS]
    )
    more = len(entries) - MOST_WORDS
    note = f"<p>And {more} rarer ones.</p>" if more > 0 else ""
    return (
        '<table><thead><tr><th scope="col">word</th><th scope="col">about</th><th scope="col">concept</th>'
        f'<th scope="col">how sure</th><th scope="col">heard</th></tr></thead><tbody>{rows}</tbody></table>{note}'
    )


def _grammar(knowledge: "Knowledge") -> str:
    """The rules between elements, of the board's language or of each language of tables."""
    rows = [(left, right, probability, count) for left, right, probability, count in rule_rows(knowledge, MOST_RULES)]
    for script, tongue in sorted(knowledge.table_language.tongues.items()):
        grammar = tongue.grammar
        named = [
            (f"{left} ({script.lower()})", " ".join(right), grammar.probability(left, right), count)
            for left, row in grammar.rules.items()
            for right, count in row.items()
            if count > 0.0
        ]
        rows += sorted(named, key=lambda row: -row[3])[:MOST_RULES]
    if not rows:
        return "<p>No rule yet: a few sentences more are needed.</p>"
    body = "".join(
        f'<tr><th scope="row">{escape(left)}</th><td>{escape(right)}</td><td>{probability:.2f}</td>'
        f"<td>{count:.0f}</td></tr>"
        for left, right, probability, count in rows
    )
    return (
        '<table><thead><tr><th scope="col">element</th><th scope="col">is made of</th>'
        f'<th scope="col">probability</th><th scope="col">times</th></tr></thead><tbody>{body}</tbody></table>'
    )
