import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learning.concepts import TABLE, ConceptSpaces, Gaussian, IncrementalMixture, TrackMixture, fit_demo
from learning.concepts.feature_space import Colour, FeatureSpace
from learning.concepts.part_mixture import PATIENCE
from learning.concepts.track_noise import TrackNoise
from learning.errors import PerceptionError
from tests.learning.camera_tracks import still_objects


class Plane(FeatureSpace):
    """Two dimensions, of which the second is noise."""

    name = "plane"
    dimension = 2
    grain = floor = 0.01
    resolution = 0.1
    correlation = 0.3
    kinds = "learned"


NOISE = TrackNoise(np.diag([0.01, 9.0]), 100.0)  # standard deviations 0.01 and 0.3


def sighting(x: float, y: float) -> Gaussian:
    return Gaussian(np.array([x, y]), 1e-4 * np.eye(2), 8.0)


def test_directions_in_which_things_differ_from_themselves_do_not_tell_kinds_apart() -> None:
    mixture = TrackMixture(Plane)
    rng = np.random.default_rng(0)
    for _ in range(20):
        first, second = rng.uniform(-1.0, 1.0, 2)
        mixture.update([sighting(0.0, first), sighting(0.4, second)], NOISE)
    assert len(mixture.components) == 2
    assert np.array_equal(mixture.classify(np.array([[0.0, 0.9], [0.4, -0.9]])), [0, 1])


def test_what_looked_like_one_kind_is_parted_again_when_more_is_known() -> None:
    mixture = TrackMixture(Plane)
    rough = TrackNoise(np.diag([0.04, 0.04]), 4.0)  # a bad first demo: standard deviation 0.1
    first = mixture.update([sighting(0.0, 0.0), sighting(0.3, 0.0)], rough)
    assert first == [0, 0]
    for _ in range(20):
        numbers = mixture.update([sighting(0.0, 0.0), sighting(0.3, 0.0)], NOISE)
    assert numbers[0] != numbers[1]
    assert 0 in numbers  # one of them keeps the number


def test_two_found_to_be_one_share_the_number_of_the_larger() -> None:
    mixture = TrackMixture(Plane)
    for _ in range(3):
        mixture.update([sighting(0.0, 0.0)], NOISE)
    assert mixture.update([sighting(1.0, 0.0)], NOISE) == [1]
    for _ in range(3):  # things of one kind are found to differ by as much
        mixture.update([sighting(0.0, 0.0)], TrackNoise(np.diag([100.0, 9.0]), 100.0))
    assert list(mixture.components) == [0]
    assert mixture.resolve(1) == 0


def test_noise_is_that_within_tracks() -> None:
    points = np.array([[0.0, 1.0], [0.0, 3.0], [5.0, 0.0], [5.0, 0.0]])
    noise = TrackNoise.within(points, np.array([7, 7, 2, 2]))
    assert np.array_equal(noise.scatter, [[0.0, 0.0], [0.0, 2.0]])
    assert noise.freedom == 2.0
    assert np.allclose(noise.plus(noise).covariance(0.1), [[0.01, 0.0], [0.0, 1.01]])
    assert TrackNoise.within(np.zeros((0, 2)), np.zeros(0, dtype=np.int64)).freedom == 0.0


def test_what_was_seen_once_and_never_again_is_forgotten() -> None:
    mixture = TrackMixture(Plane)
    mixture.update([sighting(0.0, 0.0), sighting(5.0, 0.0)], NOISE)
    for _ in range(PATIENCE - 1):
        mixture.update([sighting(0.0, 0.0)], NOISE)
    assert len(mixture.components) == 2
    mixture.update([sighting(0.0, 0.0)], NOISE)
    assert list(mixture.components) == [0]
    assert mixture.resolve(1) == 0
    assert np.allclose(mixture.components[0].mean, 0.0)  # the outlier left no trace


def test_names_join_and_part_concepts() -> None:
    mixture = TrackMixture(Plane)
    mixture.update([sighting(0.0, 0.0), sighting(1.0, 0.0)], NOISE, ["cup", "cup"])
    assert mixture.names == {0: "cup"}
    assert len(mixture.components) == 1
    parted = TrackMixture(Plane)
    parted.update([sighting(0.0, 0.0), sighting(0.02, 0.0)], NOISE, ["fork", "knife"])
    assert parted.names == {0: "fork", 1: "knife"}
    numbers = parted.update([sighting(0.021, 0.0), sighting(-0.001, 0.0)], NOISE)
    assert numbers == [1, 0]


def test_naming_one_of_a_kind_names_the_concept_and_joins_a_splinter() -> None:
    mixture = TrackMixture(Plane)
    for _ in range(3):
        mixture.update([sighting(0.0, 0.0), sighting(1.0, 0.0)], NOISE)
    assert len(mixture.components) == 2
    mixture.update([sighting(0.0, 0.0)], NOISE, ["cup"])
    assert mixture.names == {0: "cup"}
    mixture.update([sighting(1.0, 0.0)], NOISE, ["cup"])
    assert list(mixture.components) == [0]
    assert mixture.resolve(1) == 0


def test_names_join_and_part_concepts_of_the_board_too() -> None:
    red, dark = np.array([0.8, 0.0, 0.5]), np.array([0.8, 0.0, 0.1])
    light = [Gaussian(mean, 0.0064 * np.eye(3), 40.0) for mean in (red, dark)]
    mixture = IncrementalMixture(Colour)
    assert mixture.update(light) == [0, 1]
    mixture.update([light[0]], None, ["red"])
    assert mixture.update([light[1]], None, ["red"]) == [0]
    assert list(mixture.components) == [0]
    assert mixture.names == {0: "red"}
    assert mixture.update([Gaussian(red, 0.0064 * np.eye(3), 40.0)], None, ["rose"]) != [0]
    again = IncrementalMixture.from_json(Colour, json.loads(json.dumps(mixture.to_json())))
    assert again.names == mixture.names


@settings(max_examples=30, deadline=None)
@given(st.lists(st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), max_size=4), max_size=12))
def test_a_saved_mixture_goes_on_where_it_stopped(demos: list[list[tuple[float, float]]]) -> None:
    mixture = TrackMixture(Plane)
    for demo in demos:
        numbers = mixture.update([sighting(x, y) for x, y in demo], NOISE)
        assert all(number in mixture.components for number in numbers)
    text = json.dumps(mixture.to_json())
    again = TrackMixture.from_json(Plane, json.loads(text))
    assert json.dumps(again.to_json()) == text
    for one in (mixture, again):
        one.update([sighting(0.5, 0.5)], NOISE)
    assert again.to_json() == mixture.to_json()
    assert {mixture.resolve(number) for number in range(mixture.numbers_given)} == set(mixture.components)
    assert sum(mixture.weights.values()) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("next", 7, "each a concept or an alias"),
        ("aliases", {"1": 1}, "each a concept or an alias|end at a concept"),
        ("parts", [], "each a concept or an alias"),
        ("noise", {"freedom": -1.0, "scatter": [0.0] * 3}, "degrees of freedom"),
        ("noise", {"freedom": 1.0, "scatter": [0.0] * 4}, "scatter must be 3 finite numbers"),
        ("noise", {"freedom": 1.0, "scatter": [-1.0, 0.0, 0.0]}, "variances must be 0 or more"),
    ],
)
def test_a_broken_mixture_is_named(field: str, value: object, message: str) -> None:
    mixture = TrackMixture(Plane)
    mixture.update([sighting(0.0, 0.0)], NOISE)
    with pytest.raises(ValueError, match=message):
        TrackMixture.from_json(Plane, {**mixture.to_json(), field: value})


def test_without_concepts_nothing_is_classified() -> None:
    with pytest.raises(PerceptionError, match="nothing is known of feature space 'plane'"):
        TrackMixture(Plane).classify(np.zeros(2))
    with pytest.raises(ValueError, match="'colour' has kinds that are tested"):
        TrackMixture(Colour)


def test_labels_name_objects_by_track_number() -> None:
    rng = np.random.default_rng(0)
    seen = still_objects(rng, [(0.0, 0.8, 0.4), (0.01, 0.8, 0.4)], [(0.5, 0.2), (0.5, -0.2)])
    spaces = ConceptSpaces(TABLE)
    spaces.update(fit_demo(seen, rng, TABLE, {10: {"colour": "red"}, 11: {"colour": "rose"}}))
    assert sorted(spaces.mixtures["colour"].names.values()) == ["red", "rose"]
    with pytest.raises(PerceptionError, match=r"about object 3; the demo's objects are \[10, 11\]"):
        fit_demo(seen, rng, TABLE, {3: {"colour": "red"}})
    with pytest.raises(PerceptionError, match="about 'direction'; properties are colour, shape, location"):
        fit_demo(seen, rng, TABLE, {10: {"direction": "left"}})


def test_one_demo_costs_the_same_after_many() -> None:
    mixture = TrackMixture(Plane)
    rng = np.random.default_rng(0)
    sizes = []
    for _ in range(300):
        mixture.update([sighting(float(rng.integers(4)), float(rng.normal(0.0, 0.3))) for _ in range(3)], NOISE)
        sizes.append(len(json.dumps(mixture.to_json())))
    assert len(mixture.components) == 4
    assert max(sizes[100:]) <= 1.1 * max(sizes[:100])  # digits of counts grow, nothing else
