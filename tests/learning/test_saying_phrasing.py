"""How a language is spoken: names, words between them, agreement, and what of all that is saved."""

import json

import pytest

from learning.concept_id import Concept
from learning.grammar.pcfg import Pcfg
from learning.grammar.rcl import RclNode
from learning.saying.ordering import meaning, ordered
from learning.saying.phrasing import Phrasing
from learning.saying.wording import joined, marked, wording

TAKE = Concept("action", 1)
RED, BLUE = Concept("colour", 0), Concept("colour", 1)
CUBE, ROSE = Concept("shape", 0), Concept("shape", 1)


def leaf(concept: Concept, at: int = 0) -> RclNode:
    return RclNode(concept.space, concept, at, at)


def said(colour: Concept, shape: Concept, start: int = 3) -> RclNode:
    """Take the <colour> <shape>, with the words of the thing from `start` on."""
    thing = RclNode("entity", None, start, start + 1, (leaf(colour, start), leaf(shape, start + 1)))
    return RclNode("event", None, 1, start + 1, (leaf(TAKE, 1), thing))


@pytest.fixture
def spoken() -> tuple[Phrasing, Pcfg]:
    phrasing, grammar = Phrasing(), Pcfg()
    for words, tree in [
        ("take the red cube", said(RED, CUBE)),
        ("take the blue cube", said(BLUE, CUBE)),
        ("take the red rose", said(RED, ROSE)),
        ("grab the red cube", said(RED, CUBE)),
    ] * 3:
        phrasing.hear(words.split(), tree)
        for left, right in tree.rules():
            grammar.add_rule(left, right)
    return phrasing, grammar


def thing(colour: Concept, shape: Concept) -> RclNode:
    return meaning("entity", leaf(shape), leaf(colour))


def test_a_meaning_is_said_in_the_usual_order_with_the_words_that_stand_between(spoken: tuple[Phrasing, Pcfg]) -> None:
    phrasing, grammar = spoken
    found = wording(meaning("event", leaf(TAKE), thing(BLUE, ROSE)), grammar, phrasing)
    assert found is not None
    assert found.text == "take the blue rose"  # never heard as a whole
    colour = next(node for node in found.tree.nodes() if node.concept == BLUE)
    assert (colour.first, colour.last) == (3, 3)
    assert found.score < 0.0


def test_a_thing_by_itself_is_told_as_in_a_command(spoken: tuple[Phrasing, Pcfg]) -> None:
    phrasing, grammar = spoken
    found = wording(thing(RED, CUBE), grammar, phrasing)
    assert found is not None and found.text == "the red cube"


def test_what_was_never_said_so_is_not_said(spoken: tuple[Phrasing, Pcfg]) -> None:
    phrasing, grammar = spoken
    assert wording(meaning("entity", leaf(RED)), grammar, phrasing) is None
    assert wording(thing(Concept("colour", 9), CUBE), grammar, phrasing) is None
    assert ordered(meaning("entity", leaf(CUBE)), grammar) is None


def test_the_name_agrees_with_the_one_beside_it_and_with_its_like() -> None:
    """`-a` stands beside one sort of noun and `-o` beside the other; a new pair goes by the noun's other adjectives."""
    phrasing, grammar = Phrasing(), Pcfg()
    nouns = {"casa": Concept("shape", 0), "rosa": Concept("shape", 1), "cubo": Concept("shape", 2)}
    colours = {"ross": RED, "giall": BLUE, "ner": Concept("colour", 2)}
    for noun, shape in nouns.items():
        for stem, colour in colours.items():
            if (noun, stem) == ("rosa", "giall"):
                continue  # never heard
            ending = "o" if noun == "cubo" else "a"
            thing_heard = RclNode("entity", None, 2, 3, (leaf(shape, 2), leaf(colour, 3)))
            tree = RclNode("event", None, 1, 3, (leaf(TAKE, 1), thing_heard))
            for _ in range(4):
                phrasing.hear(("prendi", noun, stem + ending), tree)
                for left, right in tree.rules():
                    grammar.add_rule(left, right)
    found = wording(meaning("entity", leaf(BLUE), leaf(nouns["rosa"])), grammar, phrasing)
    assert found is not None and found.text == "rosa gialla"


def test_a_name_that_means_something_else_more_often_is_not_used() -> None:
    phrasing = Phrasing()
    for word, concept, times in (("light", RED, 1), ("light", BLUE, 5), ("red", RED, 2)):
        for _ in range(times):
            phrasing.hear((word,), RclNode("entity", None, 1, 1, (leaf(concept, 1),)))
    assert [name for name, _ in phrasing.names_of(RED)] == ["red"]


def test_what_is_saved_speaks_alike(spoken: tuple[Phrasing, Pcfg]) -> None:
    phrasing, grammar = spoken
    again = Phrasing.from_json(json.loads(json.dumps(phrasing.to_json())))
    tree = meaning("event", leaf(TAKE), thing(BLUE, CUBE))
    first, second = wording(tree, grammar, phrasing), wording(tree, grammar, again)
    assert first is not None and second is not None and first.words == second.words
    assert again.sentences == phrasing.sentences
    with pytest.raises(ValueError, match="count of 'red'"):
        Phrasing.from_json(phrasing.to_json() | {"names": {"colour_0": {"red": -1}}})


def test_a_concept_that_turns_out_to_be_another_keeps_its_names(spoken: tuple[Phrasing, Pcfg]) -> None:
    phrasing, grammar = spoken
    phrasing.rename(BLUE, Concept("colour", 7))
    found = wording(thing(Concept("colour", 7), CUBE), grammar, phrasing)
    assert found is not None and found.text == "the blue cube"
    assert BLUE not in set(phrasing.concepts())


def test_parts_of_words_are_marked_and_joined_again() -> None:
    pieces, origin = ("w", "lift", "ha", "now"), (0, 0, 0, 1)
    assert marked(pieces, origin) == ("w+", "lift", "+ha", "now")
    assert joined(marked(pieces, origin)) == (("wliftha", "now"), origin)
