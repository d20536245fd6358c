"""What annotators say of a demo."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from teleop.errors import TaskError

from .annotator import Annotator, choose, misspelt
from .facts import BESIDE, Destination, OrderingFacts, Relation, TableFacts, Thing
from .grammar import GRAMMARS, Grammar, Noun
from .told import Told

ORDERING_COLOURS = ("red", "white", "blue", "green", "yellow", "black", "orange")
VAGUE = 0.04
"""How often a thing is named by words that fit others too."""
_OPPOSITE: dict[Relation, Relation] = {"left": "right", "right": "left", "front": "behind", "behind": "front"}


def tell_ordering(facts: OrderingFacts, language: str, rng: np.random.Generator) -> Told:
    """One sentence of anyone about a demo with one object.

    Args:
        facts: What there is to say.
        language: Its language's tag.
        rng: Who speaks, and their choice of words.

    Raises:
        TaskError: Nobody speaks the language.
    """
    grammar = grammar_of(language)
    who = grammar.annotators[int(rng.integers(len(grammar.annotators)))]
    wrong = rng.random() < who.wrong
    mistakes: list[str] = []
    colour = facts.colour
    if wrong and rng.random() < 0.6:
        colour = str(rng.choice([each for each in ORDERING_COLOURS if each != colour]))
        mistakes.append(f"colour: {colour} for {facts.colour}")
    size = facts.size if rng.random() < who.sized else None
    noun = grammar.noun(who, facts.shape, colour, size)
    verb = choose(who.verbs[facts.action], rng)
    order = "topic" if "topic" in who.orders and rng.random() < 0.3 else "plain"
    text = grammar.command(verb, noun, "", "topic" if order == "topic" else "plain", verb)
    return _finished(grammar, who, text, language, f"{facts.action}: {order}", mistakes, wrong, rng)


def tell_table(facts: TableFacts, count: int, language: str, rng: np.random.Generator) -> list[Told]:
    """Sentences of different people about a demo at a table.

    Args:
        facts: What there is to say.
        count: How many.
        language: Their language's tag.
        rng: Who speaks, and their choice of words.

    Raises:
        TaskError: Nobody speaks the language, or fewer do.
    """
    grammar = grammar_of(language)
    if count > len(grammar.annotators):
        raise TaskError(f"{count} sentences in {language!r} need as many people, there are {len(grammar.annotators)}")
    people = rng.permutation(len(grammar.annotators))[:count]
    return [_one(grammar, grammar.annotators[number], facts, language, rng) for number in sorted(people.tolist())]


def grammar_of(language: str) -> Grammar:
    """The grammar of a language.

    Raises:
        TaskError: Nobody speaks it.
    """
    if language not in GRAMMARS:
        raise TaskError(f"nobody here speaks {language!r}; choose from {', '.join(GRAMMARS)}")
    return GRAMMARS[language]


def _one(grammar: Grammar, who: Annotator, facts: TableFacts, language: str, rng: np.random.Generator) -> Told:
    wrong = rng.random() < who.wrong
    kind = str(rng.choice(("colour", "side", "typo"), p=(0.4, 0.2, 0.4))) if wrong else ""
    mistakes: list[str] = []
    target, destination = facts.target, facts.destination
    if kind == "colour":
        others = sorted({each.colour for each in facts.things if each.colour != target.colour}) or ["white"]
        target = replace(target, colour=str(rng.choice(others)))
        mistakes.append(f"colour: {target.colour} for {facts.target.colour}")
    said = destination.relation if destination is not None else None
    if kind == "side" and destination is not None and said is not None and (other := _OPPOSITE.get(said)):
        mistakes.append(f"relation: {other} for {said}")
        destination = replace(destination, relation=other)
    noun, how = _named(grammar, who, facts, target, rng, whole=bool(mistakes))
    where, only_beside = _where(grammar, who, facts, destination, rng)
    order = who.orders[0] if rng.random() < 0.5 else who.orders[int(rng.integers(len(who.orders)))]
    if order == "two steps" and facts.action != "move":
        order = "plain"
    verb, second = choose(who.verbs[facts.action], rng), ""
    if order == "two steps":
        verb, second = choose(who.verbs["pick up"], rng), choose(who.verbs["move"], rng)
    text = grammar.command(verb, noun, where, order, second)
    told = _finished(grammar, who, text, language, f"{facts.action}: {order}, {how}", mistakes, wrong, rng)
    return replace(told, only_beside=only_beside)


def _finished(
    grammar: Grammar,
    who: Annotator,
    text: str,
    language: str,
    template: str,
    mistakes: Sequence[str],
    wrong: bool,
    rng: np.random.Generator,
) -> Told:
    """Add what is polite, and a typo where a mistake is due and none was made."""
    word, often = who.polite
    if word and rng.random() < often:
        text = grammar.with_politeness(text, word)
    found = list(mistakes)
    if wrong and not found:
        text, typo = misspelt(text, rng)
        found += [typo] if typo else []
    return Told(text, language, who.name, template, tuple(found))


def _named(
    grammar: Grammar,
    who: Annotator,
    facts: TableFacts,
    thing: Thing,
    rng: np.random.Generator,
    *,
    whole: bool = False,
    may_locate: bool = True,
) -> tuple[Noun, str]:
    """A noun phrase that means a thing, and how it does: by its look, or by where it is."""
    others = [each for each in facts.things if each.id != thing.id]
    vague = not whole and rng.random() < VAGUE
    alone_in_shape = vague or all(each.shape != thing.shape for each in others)
    alone_in_colour = all(each.colour != thing.colour for each in others)
    noun, how = grammar.noun(who, thing.shape, thing.colour), "colour and shape"
    if not whole and rng.random() < who.brief:
        if alone_in_shape:
            noun, how = grammar.noun(who, thing.shape, None), "shape"
        elif alone_in_colour:
            noun, how = grammar.noun(who, None, thing.colour), "colour"
    held = facts.held and thing.id == facts.target.id
    if may_locate and not held and rng.random() < who.located:
        near = [each for each in others if np.hypot(each.x - thing.x, each.y - thing.y) < BESIDE]
        if near and rng.random() < 0.5:
            beside = near[int(rng.integers(len(near)))]
            there = grammar.relation(who, "beside", grammar.noun(who, beside.shape, beside.colour))
            return grammar.located(noun, there), f"{how}, beside another"
        return grammar.located(noun, grammar.at_place(who, thing.place)), f"{how}, place"
    return noun, how


def _where(
    grammar: Grammar, who: Annotator, facts: TableFacts, destination: Destination | None, rng: np.random.Generator
) -> tuple[str, bool]:
    """Where a thing went, empty where it went nowhere; and whether that tells no more than next to what."""
    if destination is None:
        return "", False
    if destination.relation is None or destination.reference is None:
        return grammar.at_place(who, destination.place or ("middle", "middle")), False
    reference, _ = _named(grammar, who, facts, facts.thing(destination.reference), rng, may_locate=False)
    beside = destination.relation not in ("in", "on") and rng.random() < who.beside
    return grammar.relation(who, "beside" if beside else destination.relation, reference), beside
