import numpy as np
import pytest

from learning.concepts import FEATURE_SPACES, FeatureSpace
from learning.concepts.demo_mixture import fit_mixture
from learning.concepts.feature_space import Colour, Location, Shape
from robots.pose import FloatArray


def planted(
    centres: FloatArray, spread: float, tracks_each: int, frames: int, rng: np.random.Generator
) -> tuple[FloatArray, np.ndarray[tuple[int], np.dtype[np.int64]]]:
    """Values of some tracks around each centre, and their track numbers."""
    centre_of_track = np.repeat(centres, tracks_each, axis=0)
    values = centre_of_track[:, None] + rng.normal(0, spread, (len(centre_of_track), frames, centres.shape[1]))
    return values.reshape(-1, centres.shape[1]), np.repeat(np.arange(len(centre_of_track)), frames)


@pytest.mark.parametrize("number", [1, 2, 5, 16])
@pytest.mark.parametrize("tracks_each", [1, 3])
def test_bic_finds_the_planted_number_of_places(number: int, tracks_each: int) -> None:
    rng = np.random.default_rng(number)
    cells = np.array([(x, y) for x in range(8) for y in range(8)])[rng.choice(64, number, replace=False)] * 0.05
    points, tracks = planted(cells, 0.003, tracks_each, 8, rng)
    found = fit_mixture(points, tracks, Location)
    assert len(found) == number
    assert sum(component.count for component in found) == len(points)
    for cell in cells:
        # The mean of eight values of 3 mm is within 1.1 mm in each coordinate; four deviations of it.
        assert min(np.linalg.norm(component.mean - cell) for component in found) < 0.006


@pytest.mark.parametrize("space", FEATURE_SPACES.values())
def test_one_thing_is_one_component(space: type[FeatureSpace]) -> None:
    rng = np.random.default_rng(1)
    for tracks_each in (1, 4, 20):
        points, tracks = planted(np.full((1, space.dimension), 0.3), 0.5 * space.floor, tracks_each, 8, rng)
        assert len(fit_mixture(points, tracks, space)) == 1


def test_red_that_wraps_is_one_colour_beside_blue() -> None:
    rng = np.random.default_rng(2)
    hsl = np.repeat([[0.0, 0.8, 0.5], [0.65, 0.8, 0.5]], 8 * 3, axis=0)
    hsl = hsl + rng.normal(0, 0.03, hsl.shape)
    hsl[:, 0] %= 1.0
    assert np.ptp(hsl[:24, 0]) > 0.9  # the hues of red lie at both ends
    found = fit_mixture(Colour.embed(hsl), np.repeat(np.arange(6), 8), Colour)
    assert [component.count for component in found] == [24.0, 24.0]


def test_a_rare_colour_is_found_beside_a_hundred_greys() -> None:
    rng = np.random.default_rng(3)
    hsl = np.concatenate([np.tile([0.0, 0.0, 0.5], (800, 1)), np.tile([0.15, 0.9, 0.5], (8, 1))])
    hsl[:, 1:] += rng.normal(0, 0.03, (808, 2))
    found = fit_mixture(Colour.embed(hsl), np.repeat(np.arange(101), 8), Colour)
    assert [component.count for component in found] == [800.0, 8.0]


def test_all_values_of_a_track_go_to_one_component() -> None:
    rng = np.random.default_rng(4)
    points, tracks = planted(np.array([[0.0, 0.0], [0.02, 0.0]]), 0.006, 3, 8, rng)  # places that overlap
    found = fit_mixture(points, tracks, Location)
    assert all(component.count % 8 == 0 for component in found)


def test_the_fit_depends_on_its_arguments_alone() -> None:
    rng = np.random.default_rng(5)
    points, tracks = planted(rng.uniform(0, 0.3, (2, 33)), 0.01, 4, 8, rng)
    first, second = (fit_mixture(points, tracks, Shape) for _ in range(2))
    assert len(first) == 2
    for one, other in zip(first, second, strict=True):
        assert np.array_equal(one.mean, other.mean)
        assert np.array_equal(one.covariance, np.diag(np.diag(other.covariance)))


def test_no_values_have_no_components_and_one_value_has_one() -> None:
    assert fit_mixture(np.zeros((0, 2)), np.zeros(0, dtype=np.int64), Location) == ()
    (only,) = fit_mixture(np.array([[0.1, 0.2]]), np.zeros(1, dtype=np.int64), Location)
    assert np.array_equal(only.mean, [0.1, 0.2])
    assert np.allclose(only.covariance, Location.floor**2 * np.eye(2))
