import networkx as nx
import numpy as np
import pytest

from learning.concepts import ConceptSpaces, fit_demo
from learning.graphs import Graphlet, StateGraph
from learning.graphs.graphlets import graphlets_of
from learning.graphs.state_graph import GRIPPER
from learning.perception import observe_key_frames, percept_of
from tests.learning.board_demos import Cell, blocks, key_frames, random_demo
from tests.learning.test_graphs_action_graphlet import MOVE

CELLS: list[Cell] = [(2, 2, 0), (2, 2, 1), (4, 5, 0), (4, 6, 0)]
GOAL = (4, 5, 1)


@pytest.fixture(scope="module")
def spaces() -> ConceptSpaces:
    rng = np.random.default_rng(0)
    known = ConceptSpaces()
    for kind in ("move", "take", "drop") * 12:
        known.update(fit_demo(random_demo(rng, kind, columns=14).observation, rng))
    return known


@pytest.fixture(scope="module")
def graph(spaces: ConceptSpaces) -> StateGraph:
    objects = blocks(*zip(CELLS, ("red", "green", "blue", "white"), ("cube", "prism", "cube", "cube"), strict=True))
    observation = observe_key_frames(key_frames(CELLS, 1, GOAL, "move"), objects, np.random.default_rng(1))
    spaces.update(fit_demo(observation, np.random.default_rng(2)))
    return StateGraph.of(observation, spaces)


def test_states_differ_and_come_in_order(graph: StateGraph) -> None:
    frames = [state.first_frame for state in graph.states]
    assert frames[0] == 0
    assert frames == sorted(set(frames))
    for before, after in zip(graph.states, graph.states[1:], strict=False):
        assert (before.gripper_closed, before.objects, before.relations) != (
            after.gripper_closed,
            after.objects,
            after.relations,
        )
    assert graph.action == MOVE


def test_what_rests_keeps_its_nodes_and_what_is_moved_changes_place(graph: StateGraph) -> None:
    for thing in (0, 2, 3):
        assert len({state.objects[thing] for state in graph.states}) == 1
    first, last = graph.states[0], graph.states[-1]
    assert dict(first.objects[1])["location"] == dict(first.objects[0])["location"]  # in one column
    assert dict(last.objects[1])["location"] == dict(last.objects[2])["location"]
    assert dict(first.objects[1])["colour"] == dict(last.objects[1])["colour"]


def test_relations_are_those_of_near_pairs_and_of_gripper_and_moved_object(graph: StateGraph) -> None:
    first, last = graph.states[0], graph.states[-1]
    assert set(first.relations) == {(0, 1), (1, 0), (2, 3), (3, 2), (GRIPPER, 1)}
    # (1, 3) is across the corner of two cells, 63 mm.
    assert set(last.relations) == {(1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (GRIPPER, 1)}
    assert first.relations[1, 0] == last.relations[1, 2]  # above, and as far
    assert first.relations[1, 0] != first.relations[0, 1]


def test_states_agree_with_the_percept(spaces: ConceptSpaces, graph: StateGraph) -> None:
    objects = blocks(*zip(CELLS, ("red", "green", "blue", "white"), ("cube", "prism", "cube", "cube"), strict=True))
    observation = observe_key_frames(key_frames(CELLS, 1, GOAL, "move"), objects, np.random.default_rng(1))
    percept = percept_of(observation, spaces)
    for thing in range(4):
        for space, number in graph.states[0].objects[thing]:
            assert percept.properties[space][thing] == number
    for pair, concepts in graph.states[0].relations.items():
        if GRIPPER not in pair:
            assert dict(concepts) == {name: percept.relations[name][pair] for name in ("direction", "distance")}


def test_graphlets_are_all_combinations(graph: StateGraph) -> None:
    three = graphlets_of("object", (("colour", 1), ("shape", 0), ("location", 7)))
    assert len(three) == 7
    assert Graphlet("object", frozenset({("colour", 1), ("location", 7)})) in three
    assert graphlets_of("object", graph.states[0].objects[2]) <= graph.object_graphlets()
    assert graphlets_of("relation", graph.states[0].relations[1, 0]) <= graph.relation_graphlets()
    tree = Graphlet("relation", frozenset({("direction", 2), ("distance", 0)})).to_networkx()
    assert nx.is_arborescence(tree)
    assert {tree.nodes[node]["label"] for node in tree} == {"relation", "direction_2", "distance_0"}


def test_the_graph_is_a_dag_with_two_layers_a_state(graph: StateGraph) -> None:
    dag = graph.to_networkx()
    assert nx.is_directed_acyclic_graph(dag)
    labels = [dag.nodes[node]["label"] for node in dag]
    states = len(graph.states)
    assert labels.count("state") == labels.count("gripper") == states
    assert labels.count("object") == 4 * states
    assert labels.count("open") + labels.count("closed") == states
    assert labels.count("relation") == sum(len(state.relations) for state in graph.states)
