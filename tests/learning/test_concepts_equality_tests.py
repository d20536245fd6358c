import numpy as np
import pytest

from learning.concepts import Gaussian
from learning.concepts.equality_tests import Statistics, covariance_p_values, effective_size, mean_p_values
from robots.pose import FloatArray


def estimate(values: FloatArray) -> Statistics:
    covariance = np.cov(values.T, bias=True).reshape(values.shape[1], values.shape[1])
    return Statistics.of([Gaussian(values.mean(axis=0), covariance, float(len(values)))])


def known(dimension: int) -> Statistics:
    """The true distribution, as sure as can be."""
    return Statistics.of([Gaussian(np.zeros(dimension), np.eye(dimension), 1e6, 1000)])


def test_effective_size_is_the_design_effect() -> None:
    count, demos = np.array([1.0, 9.0, 1e9, 20.0]), np.array([1.0, 1.0, 2.0, 20.0])
    # No correlation among single values; 9 / (1 + 8 / 4); the limit m / r; one value a demo.
    assert effective_size(count, demos, 0.25, 100.0) == pytest.approx([1.0, 3.0, 8.0, 20.0])
    assert effective_size(count, demos, 0.25, 10.0).max() == 10.0


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_p_values_are_near_uniform_when_covariances_are_equal(dimension: int) -> None:
    rng = np.random.default_rng(5)
    # The other estimate counts as 20 values too, so that the test is more careful than the level says.
    p = [
        float(covariance_p_values(estimate(rng.normal(size=(15, dimension))), known(dimension), False)[0, 0])
        for _ in range(400)
    ]
    assert np.mean(np.array(p) < 0.05) < 0.09
    assert np.mean(p) > 0.4


@pytest.mark.parametrize("dimension", [1, 3])
@pytest.mark.parametrize("scale", [0.25, 4.0])
def test_both_far_smaller_and_far_larger_covariances_are_told_apart(dimension: int, scale: float) -> None:
    rng = np.random.default_rng(6)
    values = scale * rng.normal(size=(100, dimension))
    assert covariance_p_values(estimate(values), known(dimension), False)[0, 0] < 1e-3


def test_a_rotated_covariance_is_another() -> None:
    long = Statistics.of([Gaussian(np.zeros(2), np.diag([9.0, 1.0]), 100.0)])
    turned = Statistics.of([Gaussian(np.zeros(2), np.diag([1.0, 9.0]), 100.0)])
    assert covariance_p_values(long, turned, False)[0, 0] < 1e-3
    assert covariance_p_values(long, long, False)[0, 0] > 0.5


def test_diagonal_covariances_agree_with_full_ones_in_one_dimension() -> None:
    narrow = Statistics.of([Gaussian(np.zeros(1), np.eye(1), 20.0), Gaussian(np.zeros(1), 2 * np.eye(1), 10.0)])
    full = mean_p_values(narrow, known(1), 0.3, False)
    assert np.allclose(full, mean_p_values(narrow, known(1), 0.3, True), atol=1e-12)


@pytest.mark.parametrize("dimension", [1, 2, 3])
def test_means_are_judged_by_t_squared(dimension: int) -> None:
    rng = np.random.default_rng(7)
    same = [
        float(mean_p_values(estimate(rng.normal(size=(12, dimension))), known(dimension), 0.0, False)[0, 0])
        for _ in range(400)
    ]
    # The other mean is exact here but counts as LARGEST_SIZE values: fewer false alarms than the level.
    assert np.mean(np.array(same) < 0.05) <= 0.05
    shifted = estimate(rng.normal(size=(12, dimension)) + np.eye(dimension)[0] * 4.0)
    assert mean_p_values(shifted, known(dimension), 0.0, False)[0, 0] < 1e-3


def test_correlated_values_are_worth_less() -> None:
    shifted = Statistics.of([Gaussian(np.array([1.2]), np.eye(1), 400.0)])
    assert mean_p_values(shifted, known(1), 0.0, False)[0, 0] < 0.01
    assert mean_p_values(shifted, known(1), 0.3, False)[0, 0] > 0.05
