"""How the board's blocks, towers and places are measured."""

import pytest

from learning.concept_id import Concept
from learning.grammar.arrangement import Arrangement
from learning.grammar.board_elements import BoardElements
from learning.grammar.board_places import board_places
from learning.grammar.description import fits, senses
from learning.grammar.innate import (
    ABOVE,
    BESIDE,
    COLLECTIVE,
    CORNER,
    EDGE,
    EXTREMES,
    IT,
    NEAREST,
    SELF,
    SIDES,
    SINGLE,
    WHOLE,
    WITHIN,
)
from learning.grammar.scene import bits
from twin.board import CELLS

RED, BLUE = Concept("colour", 0), Concept("colour", 1)
CUBE, PRISM = Concept("shape", 0), Concept("shape", 1)
FRONT, BACK, LEFT, RIGHT = SIDES
ANYWHERE: frozenset[int] = frozenset()


def column(x: int, y: int) -> int:
    return x * CELLS + y


@pytest.fixture
def scene() -> BoardElements:
    """A red cube in the back right corner, a tower of blue, red and a blue prism, and a red cube at (4, 4)."""
    return BoardElements(
        Arrangement(
            columns=(column(0, 0), column(2, 5), column(2, 5), column(2, 5), column(4, 4)),
            levels=(0, 0, 1, 2, 0),
            colours=(0, 1, 0, 1, 0),
            shapes=(0, 0, 0, 1, 0),
            held=None,
        ),
        bearing_shapes=frozenset({0}),
    )


def test_blocks_are_told_by_looks_and_by_what_is_on_them(scene: BoardElements) -> None:
    assert bits(scene.looking(RED)) == [0, 2, 4]
    assert bits(scene.clear) == [0, 3, 4]
    assert bits(scene.ranked(SINGLE, scene.blocks)[0]) == [0, 4]
    assert scene.below(3) == 2
    assert scene.colours_below(2) == {RED, BLUE}


def test_nothing_can_be_put_on_what_bears_nothing(scene: BoardElements) -> None:
    assert not scene.usable >> column(2, 5) & 1
    assert scene.usable >> column(4, 4) & 1


def test_a_tower_has_exactly_the_colours_that_are_named(scene: BoardElements) -> None:
    two = scene.collectives(frozenset({RED, BLUE}), 2)
    assert two.bit_count() == 1
    # Both prefixes of the column, of two and of three blocks, are red and blue.
    assert scene.collectives(frozenset({RED, BLUE}), None).bit_count() == 2
    assert scene.collectives(frozenset({RED}), None) == 0
    assert bits(scene.related(ABOVE, two, scene.blocks)[0]) == [3]


def test_nearness_is_ranked_among_candidates(scene: BoardElements) -> None:
    corner = scene.landmarks(CORNER, frozenset({1, 3}))
    assert [bits(mask) for mask in scene.related(NEAREST, corner, scene.looking(RED))][0] == [0]
    front = scene.landmarks(EDGE, frozenset({0}))
    assert [bits(mask) for mask in scene.related(NEAREST, front, scene.looking(RED))][0] == [4]
    assert bits(scene.nearest_to_robot(scene.blocks)) == [0]
    assert bits(scene.ranked(EXTREMES[2], scene.looking(RED))[0]) == [4]  # among what is clear


def test_places_are_related_to_and_landed_on(scene: BoardElements) -> None:
    corner = scene.landmarks(CORNER, frozenset({1, 3}))
    assert bits(scene.related(WITHIN, corner, scene.blocks)[0]) == [0]
    assert bits(scene.landing(WITHIN, corner)) == [column(0, 0)]
    floor = scene.landmarks(WHOLE, ANYWHERE)
    assert scene.landing(WITHIN, floor).bit_count() == CELLS * CELLS - 3
    assert bits(scene.landing(ABOVE, 1 << 4)) == [column(4, 4)]
    assert scene.landing(ABOVE, 1 << 1) == 0  # something is on it
    assert sorted(bits(scene.landing(BESIDE, 1))) == [column(0, 1), column(1, 0)]
    assert bits(scene.landing(LEFT, 1 << 4)) == [column(4, 5)]


def test_steps_end_at_the_edge_of_the_board(scene: BoardElements) -> None:
    assert bits(scene.shifted(FRONT, 2, 1 << 4)) == [column(6, 4)]
    assert scene.shifted(FRONT, 4, 1 << 4) == 0
    assert scene.shifted(RIGHT, 1, 1) == 0


def test_corners_lie_towards_two_sides_and_the_robot_has_no_cell() -> None:
    places = board_places()
    corners = [place for place in places if place.kind == CORNER]
    assert {place.sides for place in corners} == {frozenset({a, b}) for a in (0, 1) for b in (2, 3)}
    assert all(place.cells.bit_count() == 1 for place in corners)
    assert [place.cells for place in places if place.kind == SELF] == [0]


def test_descriptions_mean_things_towers_or_places(scene: BoardElements) -> None:
    assert [bits(sense.elements) for sense in senses(frozenset({RED, CUBE}), scene)][0] == [0, 2, 4]
    assert senses(frozenset({BLUE, RED, COLLECTIVE}), scene)[0].elements.bit_count() == 2
    (corner,) = senses(frozenset({BACK, RIGHT, CORNER}), scene)
    assert corner.elements == scene.landmarks(CORNER, frozenset({1, 3}))
    assert senses(frozenset({RED, CORNER}), scene) == []  # places have no colour
    assert senses(frozenset({IT}), scene)[0].refers


def test_one_thing_is_not_described_twice_in_one_respect() -> None:
    assert fits(frozenset({RED}), BLUE)  # a tower may have several colours
    assert not fits(frozenset({CUBE}), PRISM)
    assert not fits(frozenset({FRONT}), BACK)
    assert fits(frozenset({FRONT}), LEFT)
    assert not fits(frozenset({RED}), IT)


def test_what_is_in_the_gripper_stands_nowhere() -> None:
    held = BoardElements(Arrangement((column(0, 0), column(4, 4)), (0, 0), (0, 0), (0, 0), 0))
    back = held.landmarks(EDGE, frozenset({1}))
    assert not any(mask & 1 for mask in held.related(WITHIN, back, held.blocks))


def test_a_rank_says_something_only_of_several_clear_things(scene: BoardElements) -> None:
    assert scene.open_to_choice(scene.looking(RED))
    assert not scene.open_to_choice(1 << 0 | 1 << 2)
    (left,) = senses(frozenset({LEFT, PRISM}), scene)
    assert left.idle
