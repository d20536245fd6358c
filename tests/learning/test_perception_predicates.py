import numpy as np
import pytest

from learning.concepts import ConceptSpaces, fit_demo
from learning.errors import PerceptionError
from learning.percept import NO_CONCEPT
from learning.perception import KeyFrame, Observation, observe_key_frames, perceive, percept_of
from learning.perception.placements import clear_objects, column_of, landing_places
from tests.learning.board_demos import Cell, blocks, key_frames, random_demo
from twin.board import cell_centre

CELLS: list[Cell] = [(2, 2, 0), (2, 2, 1), (4, 5, 0), (4, 6, 0), (2, 3, 0)]
OBJECTS = blocks(
    *zip(CELLS, ("red", "green", "blue", "white", "red"), ("cube", "prism", "cube", "cube", "cube"), strict=True)
)


@pytest.fixture(scope="module")
def spaces() -> ConceptSpaces:
    rng = np.random.default_rng(0)
    known = ConceptSpaces()
    for kind in ("move", "take", "drop") * 20:
        known.update(fit_demo(random_demo(rng, kind, columns=14).observation, rng))
    return known


def watch(kind: str, moved: int, goal: Cell, cells: list[Cell] = CELLS) -> Observation:
    return observe_key_frames(key_frames(cells, moved, goal, kind), OBJECTS, np.random.default_rng(1))


@pytest.mark.parametrize(("kind", "moved", "goal"), [("move", 1, (4, 5, 1)), ("take", 4, (2, 3, 8))])
def test_the_scene_before_the_action_is_perceived(kind: str, moved: int, goal: Cell, spaces: ConceptSpaces) -> None:
    observation = watch(kind, moved, goal)
    percept, shown = perceive(observation, spaces)
    assert percept.held is None
    # At least eight frames are averaged: 1.1 mm, four of them.
    assert np.allclose(percept.location, [cell_centre(*cell) for cell in CELLS], atol=0.0045)
    colour, place = percept.properties["colour"], percept.properties["location"]
    assert colour[0] == colour[4]
    assert len(set(colour.tolist())) == 4
    assert place[0] == place[1]
    assert len(set(place.tolist())) == 4
    assert percept.clear.tolist() == [False, True, True, True, True]
    assert shown.moved == moved
    assert shown.placement == (None if kind == "take" else 8 * 4 + 5)
    assert np.allclose(shown.final_location, cell_centre(*goal), atol=0.008)  # three frames: 1.7 mm
    assert shown.action in shown.parts


def test_a_held_block_is_in_no_column_and_covers_nothing(spaces: ConceptSpaces) -> None:
    cells = [*CELLS[:1], (2, 2, 5), *CELLS[2:]]
    observation = watch("drop", 1, (2, 2, 1), cells)
    percept, shown = perceive(observation, spaces)
    assert percept.held == 1
    assert percept.clear.all()
    assert percept.support[8 * 2 + 2] == 0
    assert np.allclose(percept.placements[8 * 2 + 2], cell_centre(2, 2, 1))
    assert shown.placement == 8 * 2 + 2


def test_relations_are_seen_from_the_second_object(spaces: ConceptSpaces) -> None:
    observation = watch("move", 1, (4, 5, 1))
    direction = percept_of(observation, spaces).relations["direction"]
    above = spaces.predicates("direction", np.array([0.0, 0.0, 0.038]))
    left = spaces.predicates("direction", np.array([0.0, 0.05, 0.0]))
    assert direction[1, 0] == above
    assert direction[0, 1] != above
    assert direction[3, 2] == direction[4, 0] == left
    far = [(0, 2), (2, 0), (1, 3), (4, 2)]
    assert all(direction[pair] == NO_CONCEPT for pair in far)
    assert np.all(np.diag(direction) == NO_CONCEPT)
    distance = percept_of(observation, spaces).relations["distance"]
    assert np.array_equal(distance == NO_CONCEPT, direction == NO_CONCEPT)
    assert np.array_equal(distance, distance.T)


def test_placements_are_on_top_of_every_column(spaces: ConceptSpaces) -> None:
    percept = percept_of(watch("move", 1, (4, 5, 1)), spaces)
    assert percept.placements.shape == (64, 3)
    tops = {(2, 2): (2, 1), (4, 5): (1, 2), (4, 6): (1, 3), (2, 3): (1, 4)}
    for x in range(8):
        for y in range(8):
            level, support = tops.get((x, y), (0, -1))
            assert np.allclose(percept.placements[8 * x + y], cell_centre(x, y, level))
            assert percept.support[8 * x + y] == support
    direction = percept.placement_relations["direction"]
    above = spaces.predicates("direction", np.array([0.0, 0.0, 0.038]))
    assert direction.shape == (64, 5)
    for column, support in ((8 * 4 + 5, 2), (8 * 4 + 6, 3), (8 * 2 + 3, 4), (8 * 2 + 2, 1)):
        assert direction[column, support] == above
    place = percept.placement_properties["location"]
    assert place[8 * 4 + 5] == percept.properties["location"][2]


def test_a_placement_at_no_known_place_has_no_concept() -> None:
    rng = np.random.default_rng(2)
    known = ConceptSpaces()
    observation = watch("move", 1, (4, 5, 1))
    known.update(fit_demo(observation, rng))
    percept = percept_of(observation, known)
    seen = {column_of(cell_centre(*cell)) for cell in CELLS}
    for column, number in enumerate(percept.placement_properties["location"]):
        assert (number != NO_CONCEPT) == (column in seen)


def test_looking_does_not_change_what_is_known(spaces: ConceptSpaces) -> None:
    twice = key_frames(CELLS, 1, (4, 5, 1), "move") + key_frames(
        [CELLS[0], (4, 5, 1), *CELLS[2:]], 1, (7, 7, 0), "move"
    )
    observation = observe_key_frames(twice, OBJECTS, np.random.default_rng(3))
    before = spaces.to_json()
    _, shown = perceive(observation, spaces, learn_action=False)
    assert shown.action == NO_CONCEPT
    assert spaces.to_json() == before
    _, shown = perceive(observation, spaces)
    assert shown.action == len(spaces.actions)
    assert shown.placement == 63


def test_when_nothing_moves_there_is_a_percept_but_no_action(spaces: ConceptSpaces) -> None:
    still = KeyFrame(cell_centre(0, 0, 9), False, np.array([cell_centre(*cell) for cell in CELLS]))
    observation = observe_key_frames([still], OBJECTS, np.random.default_rng(4))
    assert percept_of(observation, spaces).object_ids.tolist() == [10, 11, 12, 13, 14]
    with pytest.raises(PerceptionError, match="no object was moved"):
        perceive(observation, spaces)


def test_columns_are_numbered_and_what_lies_beside_the_board_goes_to_its_edge() -> None:
    assert [column_of(cell_centre(x, y, 3)) for x, y in ((0, 0), (0, 7), (7, 0), (7, 7))] == [0, 7, 56, 63]
    assert column_of(np.array([-0.03, 0.41, 0.02])) == 7


def test_an_empty_board_has_64_places() -> None:
    places, support = landing_places(np.zeros((0, 3)), None)
    assert np.allclose(places[:, 2], cell_centre(0, 0, 0)[2])
    assert np.all(support == -1)
    assert clear_objects(np.zeros((0, 3)), None).shape == (0,)
