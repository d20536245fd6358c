import json
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learning.concepts import FeatureSpace, Gaussian, IncrementalMixture
from learning.concepts.feature_space import Colour, Location
from learning.concepts.gaussian import merged
from learning.errors import PerceptionError
from robots.pose import FloatArray


class Line(FeatureSpace):
    """Numbers, for tests."""

    name = "line"
    dimension = 1
    grain = 0.1
    floor: ClassVar[float] = 0.1
    resolution = 0.5
    correlation = 0.3


def batch(values: FloatArray, demos: int = 1) -> Gaussian:
    """Maximum likelihood estimate of one component from all its values."""
    mean = values.mean(axis=0)
    return Gaussian(mean, (values - mean).T @ (values - mean) / len(values), float(len(values)), demos)


def at(mean: float, spread: float = 0.2, count: float = 30.0, demos: int = 1) -> Gaussian:
    return Gaussian(np.array([mean]), np.array([[spread**2]]), count, demos)


@settings(max_examples=50, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 40), st.integers(2, 40), st.integers(1, 4))
def test_merging_equals_the_estimate_from_all_values(seed: int, first: int, second: int, dimension: int) -> None:
    rng = np.random.default_rng(seed)
    values = rng.normal(rng.normal(0, 5, dimension), 1.0, (first + second, dimension))
    together = merged(batch(values[:first]), batch(values[first:]), 2)
    expected = batch(values)
    # A.1 and A.2 are exact: only rounding is left.
    assert np.allclose(together.mean, expected.mean, atol=1e-10)
    assert np.allclose(together.covariance, expected.covariance, atol=1e-9)
    assert together.count == expected.count


def test_a_stream_of_demos_gives_the_batch_estimate_and_weights_by_counts() -> None:
    rng = np.random.default_rng(3)
    mixture = IncrementalMixture(Line)
    low, high = rng.normal(0.0, 0.3, (400, 1)), rng.normal(5.0, 0.3, (600, 1))
    for demo in range(20):
        mixture.update([batch(low[20 * demo : 20 * demo + 20]), batch(high[30 * demo : 30 * demo + 30])])
    assert list(mixture.components) == [0, 1]
    for number, values in ((0, low), (1, high)):
        component = mixture.components[number]
        assert np.allclose(component.mean, values.mean(axis=0), atol=1e-12)
        assert np.allclose(component.covariance, np.cov(values.T, bias=True), atol=1e-12)
        assert component.demos == 20
    assert mixture.weights == pytest.approx({0: 0.4, 1: 0.6})  # A.3


def test_what_is_new_becomes_a_concept_and_the_others_only_lose_weight() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0), at(2.0)])
    before = mixture.components
    assert mixture.update([at(7.0, count=60.0)]) == [2]
    assert mixture.components[0] is before[0]  # A.5: mean and covariance stay
    assert mixture.weights == pytest.approx({0: 0.25, 1: 0.25, 2: 0.5})  # A.4 and A.5


def test_the_light_of_a_demo_makes_no_new_colour() -> None:
    # Within a demo the standard deviation is 0.03, and all its values share a shift of 0.02: with a hundred values a
    # demo, T-squared for independent values would reject equal means in nearly every demo.
    rng = np.random.default_rng(11)
    mixture = IncrementalMixture(Colour)
    for _ in range(300):
        found = []
        for grey in (0.5, 0.95):
            values = np.array([0.0, 0.0, grey]) + rng.normal(0, 0.02, 3) + rng.normal(0, 0.03, (100, 3))
            component = batch(values)
            found.append(Gaussian(component.mean, component.covariance + Colour.floor**2 * np.eye(3), 100.0))
        mixture.update(found)
    assert mixture.numbers_given == 2
    assert mixture.components[0].mean[2] == pytest.approx(0.5, abs=0.005)  # 300 shifts of 0.02 average to 0.0012


def test_a_wide_component_does_not_swallow_two_narrow_ones() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0), at(2.0)])
    assert mixture.update([at(1.0, spread=1.0, count=60.0)]) == [2]
    assert mixture.update([at(0.0), at(2.0)]) == [0, 1]


def test_the_likelier_of_two_equivalent_concepts_wins() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0, demos=50, count=1500.0), at(0.75, demos=50, count=1500.0)])
    assert list(mixture.components) == [0, 1]
    assert mixture.update([at(0.3)]) == [0]
    assert mixture.update([at(0.5)]) == [1]


def test_old_concepts_that_turn_out_equal_keep_the_smaller_number() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0, demos=5, count=100.0), at(5.0)])
    mixture.update([at(0.9, demos=5, count=100.0)])
    assert mixture.components.keys() == {0, 1, 2}
    for _ in range(20):  # what lies between them draws the two together
        mixture.update([at(0.35, count=200.0), at(0.55, count=200.0)])
    assert mixture.components.keys() == {0, 1}
    assert (mixture.resolve(2), mixture.resolve(1), mixture.resolve(0)) == (0, 1, 0)
    assert mixture.update([at(-9.0)]) == [3]  # number 2 is not given again
    assert set(mixture.classify(np.array([[0.0], [0.9], [5.0], [-9.0]])).tolist()) == {0, 1, 3}


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000))
def test_numbers_keep_their_meaning_and_json_gives_the_same_back(seed: int) -> None:
    rng = np.random.default_rng(seed)
    mixture = IncrementalMixture(Location)
    for _ in range(12):
        found = [
            Gaussian(
                rng.integers(0, 4, 2) * 0.05 + rng.normal(0, 0.006, 2), 8e-5 * np.eye(2), float(rng.integers(1, 20))
            )
            for _ in range(int(rng.integers(1, 5)))
        ]
        given_before = mixture.numbers_given
        numbers = mixture.update(found)
        assert all(number == mixture.resolve(number) and number in mixture.components for number in numbers)
        assert mixture.numbers_given >= given_before
        for number in range(mixture.numbers_given):
            assert mixture.resolve(number) <= number
            assert mixture.resolve(number) in mixture.components
    again = IncrementalMixture.from_json(Location, json.loads(json.dumps(mixture.to_json())))
    assert again.to_json() == mixture.to_json()
    points = rng.uniform(0, 0.2, (50, 2))
    assert np.array_equal(again.classify(points), mixture.classify(points))
    assert again.update(found) == mixture.update(found)
    assert again.to_json() == mixture.to_json()


def test_classification_is_by_mahalanobis_distance() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0, spread=0.1), at(3.0, spread=1.0)])
    numbers, distance = mixture.classify_with_distance(np.array([[0.2], [0.4], [2.0]]))
    # 0.4 is nearer to 0 in metres, but 4 deviations from it and 2.6 from 3 (eq. 3.1).
    assert numbers.tolist() == [0, 1, 1]
    assert distance == pytest.approx([2.0, 2.6, 1.0])


def test_nothing_known_is_said() -> None:
    with pytest.raises(PerceptionError, match="nothing is known of feature space 'line'"):
        IncrementalMixture(Line).classify(np.zeros((1, 1)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"next": 9}, "numbers of line must be"),
        ({"aliases": {"1": 1}}, "numbers of line must be"),
        ({"next": 3, "aliases": {"2": 2}}, "must point to smaller numbers"),
    ],
)
def test_wrong_numbers_are_refused(change: dict[str, object], message: str) -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0), at(5.0)])
    with pytest.raises(ValueError, match=message):
        IncrementalMixture.from_json(Line, {**mixture.to_json(), **change})


def test_a_variance_must_be_positive() -> None:
    mixture = IncrementalMixture(Line)
    mixture.update([at(0.0)])
    data = mixture.to_json()
    data["components"]["0"]["covariance"] = [0.0]
    with pytest.raises(ValueError, match="line_0: variances must be finite and positive"):
        IncrementalMixture.from_json(Line, data)
