import json
from typing import ClassVar

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from learning.concepts import Gaussian, ModeMixture
from learning.concepts.feature_space import FeatureSpace, Kinds
from learning.concepts.linkage import average_linkage
from learning.concepts.modes import bandwidth, mode_holders
from learning.concepts.part_mixture import PATIENCE
from learning.errors import PerceptionError


class Street(FeatureSpace):
    """Places along a street [m]; two places are a metre apart."""

    name = "street"
    dimension = 1
    grain = floor = 0.01
    resolution = 0.1
    correlation = 0.3
    kinds: ClassVar[Kinds] = "wide"
    kind_width = 1.0


def sighting(x: float, spread: float = 0.05) -> Gaussian:
    return Gaussian(np.array([x]), spread**2 * np.eye(1), 8.0)


def seen(places: list[float]) -> ModeMixture:
    mixture = ModeMixture(Street)
    for place in places:
        mixture.update([sighting(place)])
    return mixture


def test_the_few_between_two_places_are_no_place() -> None:
    mixture = seen([0.0, 2.2] * 30)
    assert mixture.update([sighting(1.1)]) in ([0], [1])
    assert list(mixture.components) == [0, 1]


def test_they_are_a_place_when_they_are_many() -> None:
    mixture = seen([0.0, 2.2] * 30 + [1.1] * 30)
    assert len(mixture.components) == 3
    assert [int(number) for number in mixture.classify(np.array([[0.1], [2.1], [1.2]]))] == [0, 1, 2]


def test_a_rare_place_far_from_others_is_a_place() -> None:
    mixture = seen([0.0] * 40 + [6.0])
    assert len(mixture.components) == 2


def test_what_was_seen_once_and_never_again_is_forgotten() -> None:
    mixture = seen([0.0, 6.0, *[0.0] * (PATIENCE - 1)])
    assert len(mixture.components) == 2
    mixture.update([sighting(0.0)])
    assert list(mixture.components) == [0]
    assert mixture.resolve(1) == 0


def test_a_wide_sighting_is_no_concept_beside_narrow_ones() -> None:
    mixture = seen([0.0, 2.2] * 30)
    mixture.update([sighting(1.0, spread=1.5)])
    assert list(mixture.components) == [0, 1]


def test_names_join_and_part() -> None:
    mixture = ModeMixture(Street)
    mixture.update([sighting(0.0), sighting(3.0)], None, ["here", "here"])
    assert mixture.names == {0: "here"}
    assert mixture.update([sighting(0.05), sighting(-0.05)], None, ["there", None]) == [1, 0]
    assert mixture.names == {0: "here", 1: "there"}


@pytest.mark.parametrize(("apart", "modes"), [(0.9, 1), (1.1, 2)])
def test_two_equal_narrow_kinds_have_two_modes_when_they_are_a_width_apart(apart: float, modes: int) -> None:
    means, counts = np.array([[0.0], [apart]]), np.array([5.0, 5.0])
    width = bandwidth(1.0, np.zeros((2, 1, 1)), counts, 0.01)
    assert width == 0.5
    assert len(np.unique(mode_holders(means, counts, width))) == modes


def test_spread_makes_a_part_of_a_width() -> None:
    # D^2 = 1 - 2 * 0.32 = 0.36, and h is half of D
    assert bandwidth(1.0, np.full((3, 1, 1), 0.32), np.ones(3), 0.01) == pytest.approx(0.3)
    assert bandwidth(1.0, np.full((3, 1, 1), 5.0), np.ones(3), 0.01) == 0.01


def test_linkage_joins_by_the_mean_square_distance_of_what_is_held() -> None:
    means = np.array([[0.0], [1.0], [5.0], [5.5]])
    spreads, counts = np.array([0.0, 0.0, 0.0, 0.0]), np.array([3.0, 1.0, 1.0, 1.0])
    assert average_linkage(means, spreads, counts, 1.01).tolist() == [0, 0, 1, 1]
    assert average_linkage(means, spreads, counts, 0.99).tolist() == [0, 1, 2, 2]
    assert average_linkage(means, spreads + 0.4, counts, 1.01).tolist() == [0, 1, 2, 3]  # 0.25 + 0.8 is too much
    never = np.zeros((4, 4), dtype=bool)
    never[2, 3] = never[3, 2] = True
    assert average_linkage(means, spreads, counts, 1.01, never).tolist() == [0, 0, 1, 2]


@settings(max_examples=30, deadline=None)
@given(st.lists(st.lists(st.floats(-3, 3), max_size=4), max_size=12))
def test_a_saved_mixture_goes_on_where_it_stopped(demos: list[list[float]]) -> None:
    mixture = ModeMixture(Street)
    for demo in demos:
        numbers = mixture.update([sighting(x) for x in demo])
        assert all(number in mixture.components for number in numbers)
    text = json.dumps(mixture.to_json())
    again = ModeMixture.from_json(Street, json.loads(text))
    assert json.dumps(again.to_json()) == text
    for one in (mixture, again):
        one.update([sighting(0.5)])
    assert again.to_json() == mixture.to_json()
    assert {mixture.resolve(number) for number in range(mixture.numbers_given)} == set(mixture.components)
    assert sum(mixture.weights.values()) == pytest.approx(1.0)


def test_without_concepts_nothing_is_classified() -> None:
    with pytest.raises(PerceptionError, match="nothing is known of feature space 'street'"):
        ModeMixture(Street).classify(np.zeros(1))
    with pytest.raises(ValueError, match="'street' has kinds that are learned, not wide"):

        class Learned(Street):
            kinds = "learned"

        ModeMixture(Learned)
