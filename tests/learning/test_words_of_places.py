"""One word for several relations: "in the corner", "in front of", "in the bowl"; and words that no reading bore out."""

import numpy as np
import pytest

from learning.concept_id import Concept
from learning.grammar.rcl import RclNode
from learning.grounding.table_scene import BESIDE, OVER, TableScene
from learning.grounding.tongue import Tongue
from learning.interpretation.left_out import absent_phrases, unheeded_nodes
from learning.saying.table_understanding import TableDenotation
from tests.learning.table_talk import COLOURS, SHAPES, table_talk


@pytest.fixture(scope="module")
def tongue() -> Tongue:
    """A language in which "in" is said of corners and of fronts, and by one of two people of what goes into a thing."""
    learned = Tongue()
    for said, record, scene, _ in table_talk(np.random.default_rng(5), 110, "en", people=2, inside=0.5):
        learned.learn(said, record, scene)
    learned.settle()
    return learned


def where(tongue: Tongue, sentence: str) -> set[Concept]:
    """What a sentence says of where the thing goes."""
    tree = tongue.parse(tuple(sentence.split()))
    assert tree is not None
    goals: list[RclNode] = [node for node in tree.nodes() if node.label == "destination"]
    return {node.concept for goal in goals for node in goal.nodes() if node.concept is not None}


def test_a_word_that_is_mostly_passed_over_says_the_relation_that_it_is_read_as(tongue: Tongue) -> None:
    assert tongue.grounding.counts["in"][None] > tongue.grounding.grounded("in")
    assert where(tongue, "move the red apple in the bowl") == {OVER, Concept("shape", SHAPES.index("bowl"))}


def test_that_word_says_nothing_where_it_belongs_to_others(tongue: Tongue) -> None:
    assert OVER not in where(tongue, "put the red apple in the top left corner")
    assert OVER not in where(tongue, "put the red apple in front of the blue bowl")


def test_what_a_function_word_was_read_as_once_is_no_meaning_of_it(tongue: Tongue) -> None:
    odd = Tongue.from_json(tongue.to_json())
    odd.grounding.add("of", OVER, 1.0)
    odd.grammar.add_terminal(OVER.space, "of", 1.0)
    assert OVER not in where(odd, "put the red apple of the bowl")


def test_a_word_that_was_never_read_as_a_relation_is_none(tongue: Tongue) -> None:
    """Without what was shown there is nothing that a guess could be checked by."""
    for word in ("of", "table", "please"):
        assert BESIDE not in where(tongue, f"put the red apple {word} the blue bowl"), word


def table(*things: tuple[str, str]) -> TableDenotation:
    """Things of some colour and shape that nobody touches."""
    looks = tuple(
        frozenset((Concept("colour", COLOURS.index(colour)), Concept("shape", SHAPES.index(shape))))
        for colour, shape in things
    )
    nowhere = (frozenset[Concept](),) * len(things)
    return TableDenotation(TableScene(looks, nowhere, {}, -1, 0, (), frozenset(), {}, None, {}))


@pytest.mark.parametrize(
    ("sentence", "absent"),
    [
        ("pick up the red apple", []),
        ("pick up the yellow apple", ["yellow apple"]),
        ("put the red apple to the left of the fork", ["fork"]),
        ("put the red mug to the left of the fork", ["red mug", "fork"]),
    ],
)
def test_what_is_not_there_is_named_in_the_words_of_the_sentence(
    tongue: Tongue, sentence: str, absent: list[str]
) -> None:
    words = tuple(sentence.split())
    tree = tongue.parse(words)
    assert tree is not None
    assert list(absent_phrases(words, list(tree.nodes()), table(("red", "apple"), ("blue", "bowl")))) == absent


def test_a_word_with_a_sure_meaning_that_is_passed_over_is_told(tongue: Tongue) -> None:
    words = ("pick", "up", "the", "red", "apple", "with", "the", "fork")
    tree = tongue.parse(words)
    assert tree is not None
    passed = unheeded_nodes(tongue, words, tree, {"colour": None, "shape": None})
    assert [words[node.first - 1] for node in passed] == ["fork"]
    assert list(absent_phrases(words, passed, table(("red", "apple")))) == ["fork"]
