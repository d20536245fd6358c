import json

import numpy as np
import pytest

from learning.concepts import ConceptSpaces, fit_demo
from learning.errors import KnowledgeError, PerceptionError
from learning.perception import KeyFrame, observe_key_frames, perceive, percept_of
from tests.learning.board_demos import BoardDemo, blocks, random_demo

KINDS = ("move", "take", "drop")


@pytest.fixture(scope="module")
def taught() -> tuple[ConceptSpaces, list[BoardDemo]]:
    rng = np.random.default_rng(0)
    demos = [random_demo(rng, KINDS[i % 3]) for i in range(60)]
    spaces = ConceptSpaces()
    for demo in demos:
        spaces.update(fit_demo(demo.observation, rng))
        perceive(demo.observation, spaces)
    return spaces, demos


def test_as_many_concepts_come_out_as_there_are(taught: tuple[ConceptSpaces, list[BoardDemo]]) -> None:
    spaces, demos = taught
    found = {name: len(mixture.components) for name, mixture in spaces.mixtures.items()}
    places = {cell[:2] for demo in demos for cell in (*demo.cells, demo.goal)}
    assert found["location"] == len(places)
    assert found["shape"] == 2
    assert 8 <= found["colour"] <= 9  # eight colours; one more may be an odd light
    assert 6 <= found["direction"] <= 27  # the cells around a cell are 26
    assert 3 <= found["distance"] <= 6  # at it, beside, across the corner, far
    assert len(spaces.actions) == 3


@pytest.mark.parametrize("space", ["colour", "shape", "location"])
def test_a_concept_means_one_thing(space: str, taught: tuple[ConceptSpaces, list[BoardDemo]]) -> None:
    spaces, demos = taught
    truths: dict[int, list[object]] = {}
    for demo in demos:
        percept = percept_of(demo.observation, spaces)
        for number, thing, cell in zip(percept.properties[space], demo.objects, demo.cells, strict=True):
            truth = cell[:2] if space == "location" else getattr(thing, space)
            truths.setdefault(int(number), []).append(truth)
    right = sum(max(values.count(value) for value in set(values)) for values in truths.values())
    assert right >= 0.99 * sum(map(len, truths.values()))


def test_the_fit_is_a_pure_function() -> None:
    demo = random_demo(np.random.default_rng(1))
    first, second = (fit_demo(demo.observation, np.random.default_rng(2)) for _ in range(2))
    assert first.components.keys() == second.components.keys()
    for name, components in first.components.items():
        for one, other in zip(components, second.components[name], strict=True):
            assert np.array_equal(one.mean, other.mean)
            assert np.array_equal(one.covariance, other.covariance)


def test_json_goes_on_where_it_stopped(taught: tuple[ConceptSpaces, list[BoardDemo]]) -> None:
    spaces, demos = taught
    text = json.dumps(spaces.to_json())
    again = ConceptSpaces.from_json(json.loads(text))
    assert json.dumps(again.to_json()) == text
    for _ in range(2):
        concepts = fit_demo(demos[0].observation, np.random.default_rng(3))
        for one in (first := ConceptSpaces.from_json(json.loads(text)), again):
            one.update(concepts)
        assert first.to_json() == again.to_json()
        text = json.dumps(again.to_json())


@pytest.mark.parametrize("broken", [{}, {"spaces": {}, "actions": []}, {"spaces": None, "actions": None}])
def test_a_broken_file_is_named(broken: dict[str, object]) -> None:
    with pytest.raises(KnowledgeError, match="^concepts: "):
        ConceptSpaces.from_json(broken)


def test_a_broken_graphlet_is_named() -> None:
    data = ConceptSpaces().to_json()
    data["actions"] = [[[0, 2, 0]]]
    with pytest.raises(KnowledgeError, match="touching 0 or 1"):
        ConceptSpaces.from_json(data)


def test_without_concepts_nothing_is_perceived() -> None:
    spaces = ConceptSpaces()
    with pytest.raises(PerceptionError, match="nothing is known of feature space"):
        percept_of(random_demo(np.random.default_rng(4)).observation, spaces)
    with pytest.raises(PerceptionError, match="nothing is known of feature space 'distance'"):
        _ = spaces.touching


def test_an_empty_board_and_a_lone_block_teach_what_they_show() -> None:
    rng = np.random.default_rng(5)
    nothing = [KeyFrame(np.array([0.1, 0.1, 0.3]), False, np.zeros((0, 3)))]
    assert all(not found for found in fit_demo(observe_key_frames(nothing, (), rng), rng).components.values())
    alone = blocks(((3, 4, 0), "red", "cube"))
    still = [KeyFrame(np.array([0.1, 0.1, 0.3]), False, np.array([alone[0].position]))]
    found = fit_demo(observe_key_frames(still, alone, rng), rng).components
    assert {name: len(components) for name, components in found.items()} == {
        "colour": 1,
        "shape": 1,
        "location": 1,
        "direction": 0,
        "distance": 0,
    }
