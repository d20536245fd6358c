"""What the words of the annotators of tables mean: for scoring only, the learner never sees it.

An entry is a phrase with the part of it that carries the meaning, its *head*: of `to the left of` it is `left`. Which
of the function words around a head a system takes to belong to it is no difference of meaning.
"""

from collections.abc import Iterator
from dataclasses import dataclass

from teleop.annotators import arabic, english
from teleop.annotators.annotator import Annotator

Words = tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Entry:
    """A phrase and what it means.

    Attributes:
        phrase: Its words.
        heads: For each element in it: first and last word of its head, counted from 0, the element and its true value.
    """

    phrase: Words
    heads: tuple[tuple[int, int, str, str], ...]


_ROWS = {"top": "top", "far": "top", "bottom": "bottom", "near": "bottom"}
_COLUMNS = {"left": "left", "right": "right"}
_MIDDLES = ("centre", "middle")
_SIDES_EN = {"left": "left", "right": "right"}
_AR_ROWS = {"العلوية": "top", "البعيدة": "top", "السفلية": "bottom", "القريبة": "bottom"}
_AR_COLUMNS = {"اليسرى": "left", "اليمنى": "right"}
_AR_MIDDLES = ("وسط", "منتصف")
_AR_SIDES = {"يسار": "left", "يمين": "right"}
CLOSE = "close"
"""True value of being beside, of the classes of `concepts_truth.band_of`."""


def entries_of(language: str, annotator: str) -> list[Entry]:
    """All that an annotator may say that means something, but for actions; the longest phrases first.

    Args:
        language: `en` or `ar`.
        annotator: Name of the annotator, whose words for colours and things are their own.
    """
    people = english.ANNOTATORS if language == "en" else arabic.ANNOTATORS
    who = next((each for each in people if each.name == annotator), None)
    found = list(_english(who) if language == "en" else _arabic(who))
    return sorted(found, key=lambda entry: -len(entry.phrase))


def verbs_of(language: str, annotator: str) -> list[Words]:
    """Verbs of an annotator, the longest first."""
    people = english.ANNOTATORS if language == "en" else arabic.ANNOTATORS
    verbs = {
        tuple(verb.split(" "))
        for each in people
        if each.name == annotator
        for words in each.verbs.values()
        for verb in words
    }
    return sorted(verbs, key=lambda verb: (-len(verb), verb))


def _one(text: str, element: str, value: str) -> Entry:
    words = tuple(text.split(" "))
    return Entry(words, ((0, len(words) - 1, element, value),))


def _headed(text: str, head: str, element: str, value: str) -> Entry:
    words = tuple(text.split(" "))
    at = words.index(head)
    return Entry(words, ((at, at, element, value),))


def _english(who: Annotator | None) -> Iterator[Entry]:
    nouns = {} if who is None else who.nouns
    colours = {} if who is None else who.colours
    for shape, word in english.SHAPES.items():
        yield _one(nouns.get(shape, word), "shape", shape)
    for colour, word in english.COLOURS.items():
        yield _one(colours.get(colour, word), "colour", colour)
    for size in ("small", "large"):
        yield _one(size, "size", size)
    yield _one("it", "reference", "reference")
    for side, value in _SIDES_EN.items():
        for form in ("to the {} of", "on the {} of", "{} of"):
            yield _headed(form.format(side), side, "direction", value)
    yield _headed("in front of", "front", "direction", "front")
    yield _one("behind", "direction", "back")
    for word in ("into", "inside", "in", "on", "over", "onto"):
        yield _one(word, "direction", "above")
    yield _headed("on top of", "top", "direction", "above")
    for form in ("next to", "near", "close to"):
        yield _headed(form, form.split(" ")[0], "distance", CLOSE)
    for before in ("in", "on", "to"):
        for middle in _MIDDLES:
            yield _headed(f"{before} the {middle} of the table", middle, "location", "centre")
        for word, value in (_ROWS | _COLUMNS).items():
            yield _headed(f"{before} the {word} side of the table", word, "location", value)
        for row, one in _ROWS.items():
            for column, two in _COLUMNS.items():
                yield Entry((before, "the", row, column, "corner"), ((2, 2, "location", one), (3, 3, "location", two)))


def _arabic(who: Annotator | None) -> Iterator[Entry]:
    for shape, (word, _) in arabic.SHAPES.items():
        own = word if who is None or shape not in who.nouns else arabic.NOUNS[who.nouns[shape]][0]
        yield _one(f"ال{own}", "shape", shape)
    for colour in english.COLOURS:
        said = colour if who is None else who.colours.get(colour, colour)
        for form in arabic.COLOURS[said]:
            yield _one(f"ال{form}", "colour", colour)
    for size, forms in arabic.SIZES.items():
        for form in forms:
            yield _one(f"ال{form}", "size", size)
    for side, value in _AR_SIDES.items():
        for text in (f"إلى {side}", f"على {side}", side):
            yield _headed(text, side, "direction", value)
    yield _one("أمام", "direction", "front")
    for word in ("خلف", "وراء"):
        yield _one(word, "direction", "back")
    for word in ("في", "داخل", "فوق", "على"):
        yield _one(word, "direction", "above")
    for word in ("بجانب", "قرب", "بجوار"):
        yield _one(word, "distance", CLOSE)
    for before in ("في", "إلى"):
        for middle in _AR_MIDDLES:
            yield _headed(f"{before} {middle} الطاولة", middle, "location", "centre")
        for word, value in (_AR_ROWS | _AR_COLUMNS).items():
            yield _headed(f"{before} الجهة {word} من الطاولة", word, "location", value)
        for row, one in _AR_ROWS.items():
            for column, two in _AR_COLUMNS.items():
                yield Entry((before, "الزاوية", row, column), ((2, 2, "location", one), (3, 3, "location", two)))
