"""The true trees of sentences about tables, from what the sidecar tells of each: for scoring only.

Annotators are programs with a known grammar, so that a sentence, its speaker and how it is built give its tree without
doubt. Elements are those of the thesis (table 5.1); a leaf is aligned to its head (`table_vocabulary`).
"""

from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import dataclass, field
from typing import Any

from learning.evaluation.public_tree import PublicNode, Span
from learning.evaluation.table_vocabulary import Entry, Words, entries_of, verbs_of
from learning.grounding.ngrams import words_of

LOOKS = ("colour", "shape", "size")
RELATIVE = ("that", "الذي", "التي")
"""Words that begin a clause about where a thing is."""
_AND = "و"
_PRONOUNS = ("ها", "ه")


@dataclass(frozen=True, slots=True)
class GoldLeaf:
    """A leaf of a true tree.

    Attributes:
        element: RCL element.
        value: True value.
        head: First and last word of its head, counted from 1.
        phrase: First and last word of the phrase around it.
    """

    element: str
    value: str
    head: Span
    phrase: Span


@dataclass(frozen=True, slots=True)
class GoldSentence:
    """A sentence with all that is true of it.

    Attributes:
        words: Its words.
        language: Its language's tag.
        leaves: Its leaves from left to right.
        tree: Its tree; None where the grammar of the annotators does not explain it.
        mistakes: What its speaker got wrong.
    """

    words: Words
    language: str
    leaves: tuple[GoldLeaf, ...]
    tree: PublicNode | None
    mistakes: tuple[str, ...] = ()


@dataclass(slots=True)
class _Event:
    """Children of an event in order, and what is known while it is read."""

    children: list[PublicNode] = field(default_factory=list)


def gold_sentences(truth: Mapping[str, Any]) -> list[GoldSentence]:
    """The sentences of a sidecar with their trees; empty where it tells of none."""
    things = truth.get("objects", {})
    shapes = frozenset(str(thing.get("shape", "")) for thing in things.values())
    return [gold_sentence(said, str(truth.get("action", "")), shapes) for said in truth.get("sentences", ())]


def gold_sentence(said: Mapping[str, Any], action: str, shapes: Set[str] = frozenset()) -> GoldSentence:
    """One sentence of a sidecar with its tree.

    Args:
        said: Its entry: text, language, annotator, template, mistakes.
        action: What was done.
        shapes: Shapes of the things that were there: a word that some say of two shapes means one of these.
    """
    words = words_of(str(said["text"]))
    language, annotator = str(said["language"]), str(said["annotator"])
    mistakes = tuple(str(each) for each in said.get("mistakes", ()))
    steps = "two steps" in str(said.get("template", ""))
    leaves = tuple(_leaves(_righted(words, mistakes), language, annotator, action, steps, shapes))
    return GoldSentence(words, language, leaves, _tree(words, leaves), mistakes)


def _righted(words: Words, mistakes: Sequence[str]) -> Words:
    """Words as they were meant, where one is misspelt."""
    slips = dict(each.removeprefix("typo: ").split(" for ") for each in mistakes if each.startswith("typo: "))
    slips = {word_of_text: right for wrong, right in slips.items() for word_of_text in words_of(wrong)}
    meant = {wrong: (words_of(right) or (right,))[0] for wrong, right in slips.items()}
    return tuple(meant.get(word, word) for word in words)


def _leaves(
    words: Words, language: str, annotator: str, action: str, steps: bool, shapes: Set[str]
) -> Iterator[GoldLeaf]:
    """Leaves of a sentence, by the longest phrase at each position."""
    entries, verbs = entries_of(language, annotator), verbs_of(language, annotator)
    entries = sorted(entries, key=lambda each: not _is_of(each, shapes))
    entries = sorted(entries, key=lambda each: -len(each.phrase))
    at, acted = 0, 0
    while at < len(words):
        verb, joined = _verb_at(words, at, verbs, language)
        entry = next((each for each in entries if words[at : at + len(each.phrase)] == each.phrase), None)
        if verb and (entry is None or len(entry.phrase) <= verb):
            acted += 1
            value = "pick up" if steps and acted == 1 else action
            yield GoldLeaf("action", value, (at + 1, at + 1), (at + 1, at + verb))
            if joined:
                yield GoldLeaf("reference", "reference", (at + verb, at + verb), (at + verb, at + verb))
            at += verb
        elif entry is not None:
            for first, last, element, value in entry.heads:
                begin, end = _around(entry.heads, first, last, len(entry.phrase))
                yield GoldLeaf(element, value, (at + first + 1, at + last + 1), (at + begin + 1, at + end))
            at += len(entry.phrase)
        else:
            at += 1


def _is_of(entry: Entry, shapes: Set[str]) -> bool:
    """Whether an entry names a shape that was there."""
    return any(element == "shape" and value in shapes for _, _, element, value in entry.heads)


def _around(heads: Sequence[tuple[int, int, str, str]], first: int, last: int, length: int) -> tuple[int, int]:
    """Part of a phrase [begin, end) that may count as one head's: up to the neighbouring heads."""
    begin = max((other_last + 1 for _, other_last, _, _ in heads if other_last < first), default=0)
    end = min((other_first for other_first, _, _, _ in heads if other_first > last), default=length)
    return begin, end


def _verb_at(words: Words, at: int, verbs: Sequence[Words], language: str) -> tuple[int, bool]:
    """Length of the verb at a position, 0 for none, and whether a pronoun is joined to it."""
    for verb in verbs:
        if words[at : at + len(verb)] == verb:
            return len(verb), False
        if language == "en" and len(verb) > 1 and words[at : at + 2] == (verb[0], "it"):
            return 1, False
        if language == "ar":
            for pronoun in _PRONOUNS:
                *firsts, last = verb
                ending = f"علي{pronoun}" if last == "على" else f"{last}{pronoun}"
                for begin in ("", _AND):
                    joined = (*firsts, ending)
                    joined = (f"{begin}{joined[0]}", *joined[1:])
                    if words[at : at + len(verb)] == joined:
                        return len(verb), True
    return 0, False


def _tree(words: Words, leaves: Sequence[GoldLeaf]) -> PublicNode | None:
    """The tree over the leaves of a sentence."""
    events: list[_Event] = [_Event()]
    at = 0
    while at < len(leaves):
        leaf = leaves[at]
        if leaf.element == "action":
            if any(child.label == "action" for child in events[-1].children):
                events.append(_Event())
            events[-1].children.append(_node(leaf))
            at += 1
        elif leaf.element in LOOKS:
            entity, at = _entity(words, leaves, at, clause=True)
            events[-1].children.append(entity)
        elif leaf.element == "reference":
            events[-1].children.append(PublicNode("entity", None, None, (_node(leaf),)))
            at += 1
        else:
            where, at = _spatial(words, leaves, at)
            if where is None:
                return None
            events[-1].children.append(PublicNode("destination", None, None, (where,)))
    nodes = tuple(PublicNode("event", None, None, tuple(event.children)) for event in events if event.children)
    if not nodes or not all(any(child.label == "action" for child in node.children) for node in nodes):
        return None
    return nodes[0] if len(nodes) == 1 else PublicNode("sequence", None, None, nodes)


def _entity(words: Words, leaves: Sequence[GoldLeaf], at: int, *, clause: bool) -> tuple[PublicNode, int]:
    """Looks that follow each other, and where the thing is, if a clause says so."""
    parts: list[GoldLeaf] = []
    while at < len(leaves) and leaves[at].element in LOOKS:
        if parts and any(word in RELATIVE for word in words[leaves[at - 1].phrase[1] : leaves[at].phrase[0] - 1]):
            break
        parts.append(leaves[at])
        at += 1
    children = [_node(leaf) for leaf in parts]
    if clause and at < len(leaves) and leaves[at].element not in ("action", "reference"):
        between = words[parts[-1].phrase[1] : leaves[at].phrase[0] - 1]
        if any(word in RELATIVE for word in between):
            where, after = _spatial(words, leaves, at)
            if where is not None:
                children.append(where)
                at = after
    return PublicNode("entity", None, None, tuple(children)), at


def _spatial(words: Words, leaves: Sequence[GoldLeaf], at: int) -> tuple[PublicNode | None, int]:
    """A relation to a thing, or a place."""
    leaf = leaves[at]
    if leaf.element == "location":
        places = [leaf]
        while at + len(places) < len(leaves) and leaves[at + len(places)].element == "location":
            if leaves[at + len(places)].head[0] != places[-1].head[1] + 1:
                break
            places.append(leaves[at + len(places)])
        return PublicNode("spatial-relation", None, None, tuple(map(_node, places))), at + len(places)
    if at + 1 >= len(leaves) or leaves[at + 1].element not in LOOKS:
        # "on the object": a thing of which nothing is said
        return PublicNode("spatial-relation", None, None, (_node(leaf),)), at + 1
    entity, after = _entity(words, leaves, at + 1, clause=False)
    return PublicNode("spatial-relation", None, None, (_node(leaf), entity)), after


def _node(leaf: GoldLeaf) -> PublicNode:
    label = "relation" if leaf.element in ("direction", "distance") else leaf.element
    return PublicNode(label, leaf.value, leaf.head)
