"""Referring to blocks: the shortest description that fits one alone, by landmarks where looks do not do."""

import pytest

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.innate import ABOVE, CORNER, SIDES, WITHIN
from learning.grammar.rcl import RclNode
from learning.saying.board_references import BoardReferences
from twin.board import CELLS

RED, BLUE = Concept("colour", 0), Concept("colour", 1)
CUBE, PRISM = Concept("shape", 0), Concept("shape", 1)
NAMED = (RED, BLUE, CUBE, PRISM, ABOVE, WITHIN, CORNER, *SIDES)
TOGETHER = frozenset(
    tuple(sorted(each))
    for each in (
        ("colour", "shape"),
        ("shape",),
        ("colour", "shape", "spatial-relation"),
        ("side", "side", "kind"),
    )
)


@pytest.fixture
def references() -> BoardReferences:
    """A blue cube in a corner with a red prism on it, and on the board a red cube with a red prism on it."""
    corner, middle = 7 * CELLS + 7, 3 * CELLS + 3
    scene = BoardElements(Arrangement((corner, corner, middle, middle), (0, 1, 0, 1), (1, 0, 0, 0), (0, 1, 0, 1), None))
    return BoardReferences(scene, NAMED, TOGETHER)


def concepts(tree: RclNode) -> list[Concept]:
    return [node.concept for node in tree.nodes() if node.concept is not None]


def alone(references: BoardReferences, thing: int) -> list[list[Concept]]:
    return [concepts(each.tree) for each in references.of_thing(thing) if each.mask == 1 << thing]


def test_looks_are_enough_where_nothing_else_looks_so(references: BoardReferences) -> None:
    assert alone(references, 0)[0] == [BLUE, CUBE]
    assert alone(references, 2)[0] == [RED, CUBE]


def test_of_two_that_look_alike_one_is_told_by_what_it_is_on(references: BoardReferences) -> None:
    first = alone(references, 1)[0]
    assert first[:3] == [RED, PRISM, ABOVE] and first[3:] in ([BLUE, CUBE],)
    assert all(len(each) > 2 for each in alone(references, 3))  # red prism alone fits both


def test_where_a_thing_is_can_be_told_even_if_it_rules_nothing_out() -> None:
    scene = BoardElements(Arrangement((7 * CELLS + 7,), (0,), (0,), (0,), None))
    silent = BoardReferences(scene, NAMED, TOGETHER)
    telling = BoardReferences(scene, NAMED, TOGETHER, telling_where=True)
    assert not any(each.located for each in silent.of_thing(0))
    assert any({WITHIN, CORNER} <= set(concepts(each.tree)) for each in telling.of_thing(0) if each.located)


def test_what_has_no_name_is_not_said(references: BoardReferences) -> None:
    without = BoardReferences(references.scene, (RED, CUBE, PRISM), TOGETHER)
    assert BLUE not in {each for found in without.of_thing(0) for each in concepts(found.tree)}
    assert alone(without, 0) == []
