"""True trees of what annotators say of tables: exact ones, in both languages, and for every sentence they may say."""

import numpy as np
import pytest

from learning.evaluation.table_gold import GoldSentence, gold_sentence
from teleop.annotators.facts import Destination, OrderingFacts, Relation, TableAction, TableFacts, Thing
from teleop.annotators.telling import tell_ordering, tell_table

CUBE = Thing(0, "cube", "red", 0.6, 0.1)
BOWL = Thing(1, "bowl", "white", 0.7, 0.1)
MUG = Thing(2, "mug", "gray", 0.55, -0.2)


def said(text: str, language: str, annotator: str, template: str, action: str) -> GoldSentence:
    return gold_sentence(
        {"text": text, "language": language, "annotator": annotator, "template": template, "mistakes": []}, action
    )


def test_a_relation_is_aligned_to_its_head() -> None:
    gold = said("place the red cube to the left of the bowl", "en", "en_1", "move: plain, shape", "move")
    assert str(gold.tree) == (
        "(event: (action: move (token: 1)) (entity: (colour: red (token: 3)) (shape: cube (token: 4))) "
        "(destination: (spatial-relation: (relation: left (token: 7)) (entity: (shape: bowl (token: 10))))))"
    )


def test_a_clause_about_where_a_thing_is_belongs_to_the_thing() -> None:
    gold = said(
        "please move the cube that is in the top left corner behind the bowl", "en", "en_3", "move: plain, x", "move"
    )
    assert str(gold.tree) == (
        "(event: (action: move (token: 2)) (entity: (shape: cube (token: 4)) (spatial-relation: "
        "(location: top (token: 9)) (location: left (token: 10)))) "
        "(destination: (spatial-relation: (relation: back (token: 12)) (entity: (shape: bowl (token: 14))))))"
    )


def test_a_pronoun_joined_to_an_arabic_verb_is_in_the_same_word() -> None:
    gold = said("خذ المكعب الأحمر وضعه فوق الوعاء", "ar", "ar_2", "move: two steps, colour and shape", "move")
    assert str(gold.tree) == (
        "(sequence: (event: (action: pick up (token: 1)) (entity: (shape: cube (token: 2)) (colour: red (token: 3)))) "
        "(event: (action: move (token: 4)) (entity: (reference: reference (token: 4))) "
        "(destination: (spatial-relation: (relation: above (token: 5)) (entity: (shape: bowl (token: 6)))))))"
    )


def test_a_misspelt_word_means_what_was_meant() -> None:
    entry = {"text": "lift the rde cube", "language": "en", "annotator": "en_4", "template": "pick up: plain, x"}
    gold = gold_sentence({**entry, "mistakes": ["typo: rde for red"]}, "pick up")
    assert [(leaf.element, leaf.value, leaf.head) for leaf in gold.leaves] == [
        ("action", "pick up", (1, 1)),
        ("colour", "red", (3, 3)),
        ("shape", "cube", (4, 4)),
    ]


@pytest.mark.parametrize("language", ["en", "ar"])
def test_every_sentence_about_a_table_has_a_tree(language: str) -> None:
    rng = np.random.default_rng(3)
    places = [Destination(place=("top", "left")), Destination(place=("middle", "middle"))]
    ways: tuple[Relation, ...] = ("left", "right", "front", "behind", "in", "on")
    related = [Destination(relation=way, reference=1) for way in ways]
    shown: list[tuple[TableAction, list[Destination | None]]] = [
        ("pick up", [None]), ("put down", [*places, *related]), ("move", [*places, *related])
    ]  # fmt: skip
    for action, goals in shown:
        for goal in goals:
            facts = TableFacts(action, CUBE, (CUBE, BOWL, MUG), goal, action == "put down")
            for told in (each for _ in range(4) for each in tell_table(facts, 8, language, rng)):
                gold = gold_sentence(told.truth(), action)
                assert gold.tree is not None, told.text
                labels = [node.label for node in gold.tree.nodes()]
                assert labels.count("action") == (2 if "two steps" in told.template else 1), told.text
                assert ("destination" in labels) == (goal is not None), told.text


@pytest.mark.parametrize("language", ["en", "ar"])
def test_every_sentence_about_a_counter_has_a_tree(language: str) -> None:
    rng = np.random.default_rng(4)
    for action in ("grasp", "lift", "hold", "lower", "drop", "press", "push"):
        for _ in range(20):
            told = tell_ordering(OrderingFacts.of_model(action, "small_blue_bottle"), language, rng)
            gold = gold_sentence(told.truth(), action)
            assert gold.tree is not None
            assert {leaf.element for leaf in gold.leaves} >= {"action", "shape", "colour"}, told.text


def test_a_word_that_some_say_of_two_shapes_means_the_one_that_was_there() -> None:
    entry = {"text": "lift the cup", "language": "en", "annotator": "en_2", "template": "lift: plain", "mistakes": []}
    for shape in ("cup", "mug"):
        leaves = gold_sentence(entry, "lift", frozenset((shape,))).leaves
        assert [leaf.value for leaf in leaves if leaf.element == "shape"] == [shape]
