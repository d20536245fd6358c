"""Places for things on a table: as the words say, free, and as people would choose them."""

import numpy as np
import pytest

from executor.tables.places import FARTHEST_BESIDE, LEAST_ROOM, TableThings, spots_for
from learning.concept_id import Concept
from learning.concepts import TABLE, ConceptSpaces
from learning.concepts.gaussian import Gaussian
from learning.grounding.table_scene import BESIDE, OVER, SIDE_PLACES, RestingPlaces, relation_of
from learning.interpretation.table_interpreter import TableGoal

FAR, NEAR, LEFT, RIGHT = SIDE_PLACES
EXTENT = np.array([0.06, 0.06, 0.1])


def resting() -> RestingPlaces:
    """A table on which things stood at six places."""
    found = RestingPlaces()
    for x in (0.53, 0.77):
        for y in (-0.25, 0.0, 0.25):
            found.add(np.array([x, y, 0.05]))
    return found


def spaces() -> ConceptSpaces:
    """Five directions, as they are learned from things beside and on each other."""
    known = ConceptSpaces(TABLE)
    ways = np.array([[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0], [0, 0, 1.0]])
    for way in ways:
        for _ in range(4):
            known.mixtures["direction"].update([Gaussian(way, 0.01 * np.eye(3), 10.0)])
    return known


def direction(known: ConceptSpaces, way: list[float]) -> Concept:
    return next(iter(relation_of(0.25 * np.array(way), known)))


def things(*centres: list[float]) -> TableThings:
    return TableThings(np.array(centres), np.tile(EXTENT, (len(centres), 1)))


def test_a_part_of_the_table_is_met_at_a_free_place_well_inside_it() -> None:
    table, known = things([0.6, 0.0, 0.05], [0.78, 0.25, 0.05]), resting()
    spots = spots_for(TableGoal(frozenset({FAR, LEFT}), ()), 0, table, ConceptSpaces(TABLE), known)
    assert spots
    for spot in spots:
        assert {FAR, LEFT} <= known.at(spot.position)
        assert np.linalg.norm(spot.position[:2] - [0.78, 0.25]) > np.hypot(0.06, 0.06) + LEAST_ROOM
        assert spot.position[2] == pytest.approx(0.05)
    alone = spots_for(TableGoal(frozenset({NEAR, RIGHT}), ()), 0, table, ConceptSpaces(TABLE), known)[0]
    assert alone.position[:2] == pytest.approx([0.51, -0.25], abs=0.03)  # a grid of 2 cm


@pytest.mark.parametrize("way", [[1.0, 0, 0], [-1.0, 0, 0], [0, 1.0, 0], [0, -1.0, 0]])
def test_beside_a_thing_is_in_the_direction_that_is_meant_and_not_on_others(way: list[float]) -> None:
    known, table = spaces(), things([0.5, -0.3, 0.05], [0.65, 0.0, 0.05], [0.9, 0.3, 0.05])
    meant = frozenset({direction(known, way)})
    spots = spots_for(TableGoal(meant, (1,)), 0, table, known, resting())
    assert spots
    offset = spots[0].position - table.location[1]
    assert offset[:2] / np.linalg.norm(offset[:2]) == pytest.approx(way[:2], abs=0.27)  # a grid of 15 degrees
    assert all(meant <= relation_of(spot.position - table.location[1], known) for spot in spots)


def test_beside_long_things_among_others_is_not_so_far_off_that_it_is_hardly_meant() -> None:
    known = spaces()
    table = TableThings(
        np.array([[0.5, -0.3, 0.02], [0.6, 0.0, 0.02], [0.6, 0.1, 0.02]]),
        np.array([[0.16, 0.05, 0.04], [0.16, 0.05, 0.04], [0.02, 0.02, 0.04]]),
    )
    left = frozenset({direction(known, [0, 1.0, 0])})
    off = [
        np.linalg.norm((spot.position - table.location[1])[:2])
        for spot in spots_for(TableGoal(left, (1,)), 0, table, known, resting())
    ]
    assert off and max(off) <= FARTHEST_BESIDE
    # Where only places further off are free, there is none.
    wall = np.array([[0.6 + x, y, 0.02] for x in np.arange(-0.16, 0.17, 0.04) for y in np.arange(0.02, 0.2, 0.04)])
    crowd = TableThings(
        np.vstack([table.location[:2], wall]),
        np.vstack([table.extent[:2], np.tile([0.03, 0.03, 0.04], (len(wall), 1))]),
    )
    assert spots_for(TableGoal(left, (1,)), 0, crowd, known, resting()) == []


def test_onto_a_thing_is_on_its_top() -> None:
    known, table = spaces(), things([0.5, -0.3, 0.05], [0.65, 0.0, 0.05])
    for above in (direction(known, [0, 0, 1.0]), OVER):
        (spot,) = spots_for(TableGoal(frozenset({above}), (1,)), 0, table, known, resting())
        assert spot.onto == 1
        assert spot.position == pytest.approx([0.65, 0.0, 0.15])


def test_where_all_is_full_there_is_no_place() -> None:
    crowd = [[x, y, 0.05] for x in np.arange(0.3, 1.0, 0.07) for y in np.arange(-0.6, 0.6, 0.07)]
    table = things([0.6, 0.0, 0.4], *crowd)
    assert spots_for(TableGoal(frozenset({FAR}), ()), 0, table, ConceptSpaces(TABLE), resting()) == []
    assert spots_for(TableGoal(frozenset({BESIDE}), (50,)), 0, table, spaces(), resting()) == []


def test_room_is_kept_around_the_outline_of_a_thing_as_it_lies() -> None:
    place, extent = np.array([[0.6, 0.0, 0.02], [0.5, 0.3, 0.02]]), np.array([[0.04, 0.04, 0.04], [0.16, 0.02, 0.02]])
    across = TableThings(place, extent, np.array([0.0, np.pi / 2]))
    along = TableThings(place, extent, np.array([0.0, 0.0]))
    unknown = TableThings(place, extent, np.array([0.0, np.nan]))
    spot = np.array([0.6, 0.12])
    assert along.room(1, spot) == pytest.approx(0.12 - 0.02 - 0.01, abs=1e-9)
    assert across.room(1, spot) == pytest.approx(0.12 - 0.02 - 0.08, abs=1e-9)
    assert unknown.room(1, spot) == pytest.approx(0.12 - 0.02 - 0.5 * np.hypot(0.16, 0.02), abs=1e-9)
    for way, half in (([0.0, 1.0], 0.01), ([1.0, 0.0], 0.08)):
        assert along.half_width(1, np.array(way)) == pytest.approx(half)
    assert TableThings(place[:1], extent[:1]).room(0, spot) == np.inf


def test_a_long_thing_goes_nearer_where_it_lies_along_the_other() -> None:
    known, place = spaces(), np.array([[0.6, 0.0, 0.02], [0.45, -0.3, 0.02]])
    extent = np.array([[0.05, 0.05, 0.04], [0.16, 0.02, 0.02]])
    goal = TableGoal(frozenset({direction(known, [0, 1.0, 0])}), (0,))
    away = []
    for yaw in (0.0, np.pi / 2):
        best = spots_for(goal, 1, TableThings(place, extent, np.array([0.0, yaw])), known, resting())[0]
        away.append(best.position[1])
    assert away[0] == pytest.approx(0.025 + 0.01 + 0.05, abs=0.02)  # the usual gap, on a grid
    assert away[1] == pytest.approx(0.025 + 0.08 + 0.05, abs=0.02)


def test_a_thing_is_brought_a_way_where_there_are_places_for_that() -> None:
    known, table = spaces(), things([0.5, -0.15, 0.05], [0.5, 0.0, 0.05])
    goal = TableGoal(frozenset({direction(known, [0, -1.0, 0])}), (1,))
    here = table.location[0, :2]
    near = spots_for(goal, 0, table, known, resting())[0].position[:2]
    far = spots_for(goal, 0, table, known, resting(), 0.09)[0].position[:2]
    assert np.linalg.norm(near - here) < 0.05 < 0.07 < np.linalg.norm(far - here)
    assert spots_for(goal, 0, table, known, resting(), 9.0)  # better a little than not at all
