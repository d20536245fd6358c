import json

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.graphs import ActionGraphlet, ActionLibrary, GraphletState


def graphlet(text: str) -> ActionGraphlet:
    """Read `O apart 0, O touch 0`."""
    states = [part.split() for part in text.split(", ")]
    return ActionGraphlet.of(GraphletState(grip == "C", touch == "touch", int(at)) for grip, touch, at in states)


TAKE = graphlet("O apart 0, O touch 0, C touch 0, C touch 1")
DROP = graphlet("C touch 0, C touch 1, O touch 1, O apart 1")
MOVE = graphlet("O apart 0, O touch 0, C touch 0, C touch 1, O touch 1, O apart 1")
SHIFT = graphlet("C touch 0, C touch 1")
graphlets = st.lists(
    st.builds(GraphletState, st.booleans(), st.booleans(), st.integers(0, 3)), min_size=1, max_size=8
).map(ActionGraphlet.of)


def test_taking_and_then_dropping_is_moving() -> None:
    assert TAKE.followed_by(DROP) == MOVE
    assert DROP.followed_by(TAKE) == graphlet(
        "C touch 0, C touch 1, O touch 1, O apart 1, O touch 1, C touch 1, C touch 2"
    )
    assert MOVE.contains(TAKE) and MOVE.contains(DROP) and MOVE.contains(MOVE) and MOVE.contains(SHIFT)
    assert not TAKE.contains(DROP) and not DROP.contains(TAKE) and not TAKE.contains(MOVE)


def test_the_form_is_canonical() -> None:
    assert graphlet("O apart 7, O touch 7, C touch 7, C touch 4, C touch 4, C touch 2") == TAKE
    there_and_back = graphlet("O touch 3, C touch 3, C touch 5, C touch 3, O touch 3")
    assert there_and_back == graphlet("O touch 0, C touch 0, O touch 0")
    assert str(SHIFT) == "[C touch 0][C touch 1]"


@given(graphlets)
def test_canonical_graphlets_stay_as_they_are(one: ActionGraphlet) -> None:
    assert ActionGraphlet.of(one.states) == one
    assert one.states[0].object_location == 0
    assert all(a != b for a, b in zip(one.states, one.states[1:], strict=False))
    renamed = ActionGraphlet.of(GraphletState(s.gripper_closed, s.touching, 9 - s.object_location) for s in one.states)
    assert renamed == one
    assert ActionGraphlet.from_json(json.loads(json.dumps(one.to_json()))) == one


@given(graphlets, graphlets)
def test_equal_graphlets_match_and_others_do_not(one: ActionGraphlet, other: ActionGraphlet) -> None:
    assert one.matches(other) == (one == other)
    assert nx.is_directed_acyclic_graph(one.to_networkx())


@given(graphlets, graphlets)
def test_every_graphlet_contains_itself_and_containing_is_an_order(one: ActionGraphlet, other: ActionGraphlet) -> None:
    assert one.contains(one)
    if one.contains(other) and other.contains(one):
        assert one == other


@given(graphlets)
def test_nothing_comes_of_following_nothing(one: ActionGraphlet) -> None:
    nothing = ActionGraphlet(())
    assert one.followed_by(nothing) == one == nothing.followed_by(one)
    assert one.followed_by(one).states[0] == one.states[0]


def test_the_library_matches_or_adds() -> None:
    library = ActionLibrary()
    assert [library.match_or_add(one) for one in (MOVE, TAKE, MOVE, DROP, TAKE)] == [1, 2, 1, 3, 2]
    assert len(library) == 3
    assert library[2] == TAKE
    assert library.find(SHIFT) is None
    assert library.parts_of(MOVE) == (1, 2, 3)
    assert library.parts_of(DROP) == (3,)
    again = ActionLibrary.from_json(json.loads(json.dumps(library.to_json())))
    assert again.numbered == library.numbered


@pytest.mark.parametrize("number", [0, 4, -1])
def test_an_unknown_action_is_named(number: int) -> None:
    with pytest.raises(KeyError, match=f"action_{number} is not known; known are 1..3"):
        ActionLibrary([MOVE, TAKE, DROP])[number]


@pytest.mark.parametrize("row", [[2, 0, 0], [0, -1, 0], [0, 0, -1]])
def test_wrong_states_are_refused(row: list[int]) -> None:
    with pytest.raises(ValueError, match="must be .closed 0 or 1"):
        ActionGraphlet.from_json([row])
