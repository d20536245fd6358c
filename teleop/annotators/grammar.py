"""How English and Arabic put words together: noun phrases, places, commands."""

from dataclasses import dataclass
from typing import Protocol

from . import arabic, english
from .annotator import Annotator, Order
from .facts import Place

_PARTICLES = (" up", " down")
_MOVING = ("move", "shift", "bring")
"""Verbs that bring a thing to a part of the table, not into it."""
_PLACES: tuple[str, ...] = (
    "in the centre",
    "in the middle",
    "in the top",
    "in the bottom",
    "in the far",
    "in the near",
    "on the top",
)
_PLACES += ("on the bottom", "on the far", "on the near", "on the left side", "on the right side")


@dataclass(frozen=True, slots=True)
class Noun:
    """A noun phrase.

    Attributes:
        text: Its words.
        gender: `m` or `f`, where the language has any.
    """

    text: str
    gender: str = ""


class Grammar(Protocol):
    """What a language offers to annotators."""

    @property
    def annotators(self) -> tuple[Annotator, ...]:
        """Who speaks it."""

    def noun(self, who: Annotator, shape: str | None, colour: str | None, size: str | None = None) -> Noun:
        """A definite noun phrase; without a shape that of any thing."""

    def located(self, noun: Noun, where: str) -> Noun:
        """A noun phrase with where the thing is."""

    def at_place(self, who: Annotator, place: Place) -> str:
        """Where a part of the table is."""

    def relation(self, who: Annotator, relation: str, to: Noun) -> str:
        """Where something is that stands in a relation to a thing."""

    def command(self, verb: str, noun: Noun, where: str, order: Order, second: str) -> str:
        """A command.

        Args:
            verb: What to do.
            noun: With what.
            where: Where to; empty for nowhere.
            order: How the sentence is built; `two steps` takes the thing with `verb` and brings it with `second`.
            second: The verb of the second step.
        """

    def with_politeness(self, sentence: str, word: str) -> str:
        """A sentence with a polite word."""


class English:
    """English: adjectives before the noun, particles after a pronoun."""

    annotators = english.ANNOTATORS

    def noun(self, who: Annotator, shape: str | None, colour: str | None, size: str | None = None) -> Noun:
        """See `Grammar`."""
        what = english.ANYTHING if shape is None else who.nouns.get(shape, english.SHAPES[shape])
        words = ["the", size, None if colour is None else who.colours.get(colour, english.COLOURS[colour]), what]
        return Noun(" ".join(word for word in words if word))

    def located(self, noun: Noun, where: str) -> Noun:
        """See `Grammar`."""
        return Noun(f"{noun.text} that is {where}")

    def at_place(self, who: Annotator, place: Place) -> str:
        """See `Grammar`."""
        return english.at_place(place, who.name in english.FAR, english.MIDDLE.get(who.name, "centre"))

    def relation(self, who: Annotator, relation: str, to: Noun) -> str:
        """See `Grammar`."""
        return f"{who.relations.get(relation, english.RELATIONS[relation])} {to.text}"

    def command(self, verb: str, noun: Noun, where: str, order: Order, second: str) -> str:
        """See `Grammar`."""
        if (second or verb) in _MOVING and where.startswith(_PLACES):
            where = f"to {where[3:]}"
        return _ordered(order, verb, noun.text, where, f" and {_with_it(second)}", f", {_with_it(verb)}")

    def with_politeness(self, sentence: str, word: str) -> str:
        """See `Grammar`."""
        return f"{word} {sentence}"


class Arabic:
    """Modern standard Arabic: adjectives after the noun, agreeing in gender and article; pronouns joined to verbs."""

    annotators = arabic.ANNOTATORS

    def noun(self, who: Annotator, shape: str | None, colour: str | None, size: str | None = None) -> Noun:
        """See `Grammar`."""
        if shape is None:
            word, gender = arabic.ANYTHING
        elif shape in who.nouns:
            word, gender = arabic.NOUNS[who.nouns[shape]]
        else:
            word, gender = arabic.SHAPES[shape]
        which = 1 if gender == "f" else 0
        words = [word]
        if colour is not None:
            words.append(arabic.COLOURS[who.colours.get(colour, colour)][which])
        if size is not None:
            words.append(arabic.SIZES[size][which])
        return Noun(" ".join(f"ال{word}" for word in words), gender)

    def located(self, noun: Noun, where: str) -> Noun:
        """See `Grammar`."""
        return Noun(f"{noun.text} {'التي' if noun.gender == 'f' else 'الذي'} {where}", noun.gender)

    def at_place(self, who: Annotator, place: Place) -> str:
        """See `Grammar`."""
        return arabic.at_place(place, who.name in arabic.FAR, arabic.MIDDLE.get(who.name, "وسط"))

    def relation(self, who: Annotator, relation: str, to: Noun) -> str:
        """See `Grammar`."""
        return f"{who.relations.get(relation, arabic.RELATIONS[relation])} {to.text}"

    def command(self, verb: str, noun: Noun, where: str, order: Order, second: str) -> str:
        """See `Grammar`."""
        if (second or verb) in arabic.MOVING and where.startswith(arabic.PLACES):
            where = f"إلى{where.removeprefix('في')}"
        return _ordered(
            order,
            verb,
            noun.text,
            where,
            f" و{arabic.joined(second, noun.gender)}",
            f"، {arabic.joined(verb, noun.gender)}",
        )

    def with_politeness(self, sentence: str, word: str) -> str:
        """See `Grammar`."""
        return f"{word} {sentence}"


def _ordered(order: Order, verb: str, noun: str, where: str, and_second: str, then_verb: str) -> str:
    """The parts of a command in an order.

    Args:
        order: The order.
        verb: What to do.
        noun: With what.
        where: Where to; empty for nowhere.
        and_second: Follows the noun where a second verb brings it there.
        then_verb: Follows a noun that comes first.
    """
    ending = f" {where}" if where else ""
    if order == "two steps" and where:
        return f"{verb} {noun}{and_second}{ending}"
    if order == "topic":
        return f"{noun}{then_verb}{ending}"
    if order == "destination first" and where:
        return f"{where} {verb} {noun}"
    return f"{verb} {noun}{ending}"


GRAMMARS: dict[str, Grammar] = {"en": English(), "ar": Arabic()}
"""By language tag (BCP 47)."""


def _with_it(verb: str) -> str:
    """A verb with `it` as its object, before a particle of its own: `pick it up`, `press down on it`."""
    for particle in _PARTICLES:
        if verb.endswith(particle):
            return f"{verb.removesuffix(particle)} it{particle}"
    return f"{verb} it"
