"""State graphs of demos that a camera saw: several objects, some hidden now and then."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from learning.concepts import ConceptSpaces, fit_demo
from learning.concepts.feature_space import Location
from learning.concepts.gaussian import Gaussian
from learning.concepts.incremental_mixture import IncrementalMixture
from learning.concepts.space_set import TABLE
from learning.graphs import StateGraph
from learning.graphs.concept_chain import lasting_concepts
from learning.graphs.state_graph import GRIPPER
from learning.percept import NO_CONCEPT
from tests.learning.table_demos import table_demo

KINDS = ("move", "pick up", "put down")


@pytest.fixture(scope="module")
def spaces() -> ConceptSpaces:
    known = ConceptSpaces(TABLE)
    for seed in range(9):
        observation, _ = table_demo(np.random.default_rng([seed, 10]), KINDS[seed % 3], things=4)
        known.update(fit_demo(observation, np.random.default_rng(seed), TABLE))
    return known


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("things", [1, 2, 6])
def test_any_number_of_objects_makes_a_graph(kind: str, things: int, spaces: ConceptSpaces) -> None:
    observation, _ = table_demo(np.random.default_rng(things), kind, things=things)
    graph = StateGraph.of(observation, spaces)
    assert nx.is_directed_acyclic_graph(graph.to_networkx())
    frames = [state.first_frame for state in graph.states]
    assert frames[0] == 0 and frames == sorted(set(frames))
    for state in graph.states:
        assert set(state.objects) == {GRIPPER, *range(things)}
        assert all(0 <= first < things or first == GRIPPER for first, _ in state.relations)
    for before, after in zip(graph.states, graph.states[1:], strict=False):
        assert (before.gripper_closed, before.objects, before.relations) != (
            after.gripper_closed,
            after.objects,
            after.relations,
        )
    assert graph.object_graphlets() and graph.relation_graphlets()


def test_the_hand_is_at_what_it_holds(spaces: ConceptSpaces) -> None:
    observation, handled = table_demo(np.random.default_rng(3), "move", things=3)
    graph = StateGraph.of(observation, spaces)
    at_it = ("distance", spaces.touching)
    held = [state for state in graph.states if state.gripper_closed]
    assert held and all(at_it in state.relations[GRIPPER, handled] for state in held)
    assert at_it not in graph.states[0].relations[GRIPPER, handled]


def test_what_rests_has_one_place_and_flicker_makes_no_states(spaces: ConceptSpaces) -> None:
    observation, handled = table_demo(np.random.default_rng(4), "move", things=4)
    graph = StateGraph.of(observation, spaces)
    for index in set(range(4)) - {handled}:
        assert len({state.objects[index] for state in graph.states}) == 1
    assert len(graph.states) < 30  # a state for each predicate that changes on the way, and not for each frame


def test_hidden_frames_say_nothing_of_looks(spaces: ConceptSpaces) -> None:
    observation, _ = table_demo(np.random.default_rng(5), "move", things=2)
    assert observation.visible is not None
    colour = np.where(observation.visible[..., None], observation.colour, np.nan)
    seen, hidden = (StateGraph.of(each, spaces) for each in (observation, replace(observation, colour=colour)))
    assert [state.objects for state in seen.states] == [state.objects for state in hidden.states]


@pytest.fixture(scope="module")
def places() -> IncrementalMixture:
    mixture = IncrementalMixture(Location)
    mixture.update([Gaussian(np.array([x, 0.0]), 0.0001 * np.eye(2), 50.0) for x in (0.0, 0.2)])
    return mixture


def test_a_concept_must_last(places: IncrementalMixture) -> None:
    track = np.zeros((40, 2))
    track[10] = track[30:] = 0.2, 0.0
    assert lasting_concepts(track, places, 15.0).tolist() == [0] * 30 + [1] * 10
    track[28:31] = np.nan  # nothing is known of the frames around the change
    assert lasting_concepts(track, places, 15.0)[[27, 31]].tolist() == [0, 1]


def test_things_too_far_apart_have_no_relation(places: IncrementalMixture) -> None:
    near = np.repeat([3.0, -3.0], 10)
    assert lasting_concepts(np.zeros((20, 2)), places, 15.0, near).tolist() == [0] * 10 + [NO_CONCEPT] * 10
    assert lasting_concepts(np.zeros((3, 2)), IncrementalMixture(Location), 15.0).tolist() == [NO_CONCEPT] * 3
