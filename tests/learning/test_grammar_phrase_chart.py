"""Phrases of a sentence and what they denote."""

from collections.abc import Callable, Sequence
from typing import cast

import pytest

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.clauses import Clause, CommandReading
from learning.grammar.in_vain import words_in_vain
from learning.grammar.innate import (
    ABOVE,
    COLLECTIVE,
    CORNER,
    COUNTS,
    EXTREMES,
    FURTHEST,
    NEAREST,
    NEAREST_ONE,
    RELATIONS,
    SIDES,
    UNIT,
    WITHIN,
)
from learning.grammar.phrase import Feature, Phrase
from learning.grammar.phrase_chart import Modifier, PhraseChart, Use
from learning.grammar.reading_tree import tree_of
from learning.grammar.weights import Weights
from twin.board import CELLS

RED, CUBE = Concept("colour", 0), Concept("shape", 0)
FRONT, BACK, LEFT, RIGHT = SIDES


@pytest.fixture
def scene() -> BoardElements:
    """A red cube at (4, 4)."""
    return BoardElements(Arrangement((4 * CELLS + 4,), (0,), (0,), (0,), None))


def chart_of(
    scene: BoardElements, concepts: Sequence[Concept], weight: Callable[[Feature], float] = lambda feature: 0.0
) -> PhraseChart:
    """A chart of one use a word."""
    uses = [Use(k, k + 1, concept, 0.0, (), f"w{k}", f"w{k + 1}") for k, concept in enumerate(concepts)]
    return PhraseChart(len(concepts), uses, [-1.0] * len(concepts), weight, scene)


def whole(chart: PhraseChart, label: str) -> list[Phrase]:
    """Phrases over all words."""
    cell = chart.cells[0][chart.length]
    return cell.get(label, []) if cell else []


def relations(chart: PhraseChart) -> set[Concept]:
    """Relations of the modifiers over all words that pass over none."""
    return {cast(Modifier, phrase.meaning).relation for phrase in whole(chart, "modifier") if phrase.score > -0.5}


@pytest.mark.parametrize("relation", [ABOVE, WITHIN])
def test_what_is_on_or_in_the_left_of_a_thing_is_left_of_it(scene: BoardElements, relation: Concept) -> None:
    assert LEFT in relations(chart_of(scene, (relation, LEFT, RED, CUBE)))


def test_nearest_to_a_side_is_not_a_relation_of_its_own(scene: BoardElements) -> None:
    assert LEFT not in relations(chart_of(scene, (NEAREST, LEFT, RED, CUBE)))


def test_a_side_of_a_place_is_part_of_the_place_first(scene: BoardElements) -> None:
    chart = chart_of(scene, (ABOVE, LEFT, CORNER), Weights().of)
    best = max(whole(chart, "modifier"), key=lambda phrase: phrase.score)
    assert cast(Modifier, best.meaning) == Modifier(ABOVE, scene.landmarks(CORNER, frozenset({2})))


def test_the_word_after_a_side_tells_what_the_side_is_said_of(scene: BoardElements) -> None:
    def weight(feature: Feature) -> float:
        return 3.0 if feature == ("followed", "relation", "w2") else 0.0

    best = max(whole(chart_of(scene, (ABOVE, LEFT, RED, CUBE), weight), "modifier"), key=lambda phrase: phrase.score)
    assert cast(Modifier, best.meaning).relation == LEFT


def test_a_measure_and_a_heading_are_a_shift(scene: BoardElements) -> None:
    (shift,) = [p for p in whole(chart_of(scene, (COUNTS[1], UNIT, FRONT)), "shift") if p.score > -0.5]
    assert shift.meaning == Modifier(FRONT, 0, False, 2)


def test_all_relations_restrict_or_place(scene: BoardElements) -> None:
    for relation in RELATIONS:
        assert relation in relations(chart_of(scene, (relation, RED, CUBE)))


def test_nearest_says_nothing_of_the_only_one(scene: BoardElements) -> None:
    def weight(feature: Feature) -> float:
        return -5.0 if feature == ("ranked", "in vain") else 0.0

    (entity,) = [p for p in whole(chart_of(scene, (NEAREST_ONE, RED, CUBE), weight), "entity") if p.score > -5.5]
    assert ("ranked", "in vain") in entity.features


def test_a_word_for_nearest_to_something_may_be_said_of_the_nearest_one(scene: BoardElements) -> None:
    found = whole(chart_of(scene, (NEAREST, RED, CUBE)), "entity")
    assert {child.concept for phrase in found for child in phrase.children} >= {NEAREST_ONE}


def test_a_stack_of_things_is_a_stack_in_one_leaf() -> None:
    two = BoardElements(Arrangement((0, 0), (0, 1), (0, 1), (0, 0), None))
    (best,) = whole(chart_of(two, (COLLECTIVE, CUBE)), "entity")
    assert best.meaning == (two.collectives(frozenset(), None), False, False)
    action = Phrase("action", 2, 3, 0.0, None, (), (), Concept("action", 1), (2,))
    reading = CommandReading((Clause(action, best, None),), False, False, 1, (), 0.0, ())
    entity = tree_of(reading, (0, 1, 2)).children[0]
    assert [(leaf.concept, leaf.first, leaf.last) for leaf in entity.children] == [(COLLECTIVE, 1, 2)]


@pytest.mark.parametrize("words", [(LEFT, FURTHEST), (FURTHEST, LEFT)])
def test_furthest_beside_a_side_is_one_leaf(words: tuple[Concept, Concept]) -> None:
    row = BoardElements(Arrangement((3, 5), (0, 0), (0, 0), (0, 0), None))
    entity = next(phrase for phrase in whole(chart_of(row, (*words, CUBE)), "entity") if phrase.score > -0.5)
    assert cast(tuple[int, bool, bool], entity.meaning)[0] == 0b10  # left is towards +y, the higher column here
    action = Phrase("action", 3, 4, 0.0, None, (), (), Concept("action", 1), (3,))
    reading = CommandReading((Clause(action, entity, None),), False, False, 1, (), 0.0, ())
    leaves = tree_of(reading, (0, 1, 2, 3)).children[0].children
    assert [(leaf.concept, leaf.first, leaf.last) for leaf in leaves] == [(EXTREMES[2], 1, 2), (CUBE, 3, 3)]


def test_the_nearest_of_what_a_modifier_leaves_alone_is_said_in_vain() -> None:
    """Of two red cubes one stands on a green one: "the red cube *which* on the green cube" needs no "nearest"."""
    green = Concept("colour", 1)
    scene = BoardElements(Arrangement((9, 9, 40), (0, 1, 0), (1, 0, 0), (0, 0, 0), None))
    chart = chart_of(scene, (RED, CUBE, NEAREST_ONE, ABOVE, green, CUBE))
    nearest = [phrase for phrase in whole(chart, "entity") if cast(tuple[int, bool, bool], phrase.meaning)[1]]
    best = max(nearest, key=lambda phrase: phrase.score)
    assert [*words_in_vain(best)] == [2]


def test_the_nearest_of_several_is_not_said_in_vain() -> None:
    scene = BoardElements(Arrangement((9, 40), (0, 0), (0, 0), (0, 0), None))
    (best,) = [p for p in whole(chart_of(scene, (RED, CUBE, NEAREST_ONE)), "entity") if p.score > -0.5]
    assert not [*words_in_vain(best)]
