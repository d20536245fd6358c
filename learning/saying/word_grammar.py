"""A language's learned grammar down to its words: Π, what meanings are called, and what is passed over between them.

It reads a sentence without a scene, as its words and their order alone have it.
"""

from collections.abc import Iterator

from learning.grammar.pcfg import Pcfg
from learning.grammar.table_chart import element_of
from learning.grammar.viterbi import Bracket, Production, ViterbiGrammar
from learning.saying.phrasing import Phrasing

START = "command"
PASSED = "passed"
"""Symbol of a word that means nothing by itself."""
LEAF = "'"
"""Marks the symbol of a leaf without the words that are passed over before it."""
LEAST_RULE = 0.5
"""Sightings of a rule or a name before it is one."""


def word_grammar(grammar: Pcfg, phrasing: Phrasing) -> ViterbiGrammar:
    """Join Π with the words of a language.

    Args:
        grammar: Π over elements.
        phrasing: Names of concepts, and words between them.
    """
    return ViterbiGrammar(_productions(grammar, phrasing), START)


def without_passed(tree: Bracket) -> Bracket | None:
    """A tree without words that are passed over; None where nothing else is left."""
    if tree.label == PASSED:
        return None
    children = [each for child in tree.children if (each := without_passed(child)) is not None]
    if tree.label.endswith(LEAF):
        return Bracket(tree.label.removesuffix(LEAF), tree.first, tree.after)
    if not children:
        return None
    if len(children) == 1 and children[0].label == tree.label:
        return children[0]
    return Bracket(tree.label, children[0].first, children[-1].after, tuple(children))


def _productions(grammar: Pcfg, phrasing: Phrasing) -> Iterator[Production]:
    names = _names(phrasing)
    rules = _rules(grammar, set(names))
    passed = _passed(phrasing)
    words = sum(passed.values())
    # After how many of the places where a word could be passed over one is, before and after each leaf.
    leaves = sum(sum(row.values()) for row in names.values()) + phrasing.sentences
    more = words / (words + leaves) if words else 0.0
    for left, row in rules.items():
        total = sum(row.values())
        stay = 1.0 - more if left == START else 1.0
        for right, count in row.items():
            yield Production(left, right, stay * count / total)
    for label, said in names.items():
        total = sum(said.values())
        yield Production(label, (f"{label}{LEAF}",), 1.0 - more)
        if more:
            yield Production(label, (PASSED, label), more)
        for name, count in said.items():
            yield Production(f"{label}{LEAF}", tuple(name.split(" ")), count / total, lexical=True)
    if more:
        yield Production(START, (START, PASSED), more)
        for word, count in passed.items():
            yield Production(PASSED, (word,), count / words, lexical=True)


def _names(phrasing: Phrasing) -> dict[str, dict[str, float]]:
    """Element of leaves to names to counts."""
    found: dict[str, dict[str, float]] = {}
    for concept, row in phrasing.names.items():
        said = found.setdefault(element_of(concept), {})
        for name, count in row.items():
            if count >= LEAST_RULE:
                said[name] = said.get(name, 0.0) + count
    return {label: row for label, row in found.items() if row}


def _rules(grammar: Pcfg, leaves: set[str]) -> dict[str, dict[tuple[str, ...], float]]:
    """Rules all of whose parts can be said."""
    rules = {
        left: {right: count for right, count in row.items() if count >= LEAST_RULE}
        for left, row in grammar.rules.items()
        if left not in leaves
    }
    while True:
        sayable = leaves | {left for left, row in rules.items() if row}
        kept = {
            left: {right: count for right, count in row.items() if set(right) <= sayable} for left, row in rules.items()
        }
        if kept == rules:
            return {left: row for left, row in kept.items() if row}
        rules = kept


def _passed(phrasing: Phrasing) -> dict[str, float]:
    """Words that were passed over, with how often."""
    found: dict[str, float] = {}
    for between, count in phrasing.between().items():
        for word in between.split():
            found[word] = found.get(word, 0.0) + count
    return found
