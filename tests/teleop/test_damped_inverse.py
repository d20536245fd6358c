import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots import load_robot
from teleop.damped_inverse import damped_inverse


@given(st.integers(0, 2**32 - 1))
def test_agrees_with_the_textbook_formula(seed: int) -> None:
    rng = np.random.default_rng(seed)
    rows, twist = rng.normal(size=(3, rng.integers(3, 8))), rng.normal(size=3)
    velocities, damped = damped_inverse(rows, twist)
    if not damped:
        # Relative to the conditioning of the draw: both solve the same normal equations in double precision.
        tolerance = 1e-11 * np.linalg.cond(rows @ rows.T)
        np.testing.assert_allclose(velocities, np.linalg.pinv(rows) @ twist, rtol=tolerance, atol=tolerance)


def test_six_rows_take_the_general_solver() -> None:
    rows = np.random.default_rng(0).normal(size=(6, 7))
    twist = np.arange(6.0)
    velocities, damped = damped_inverse(rows, twist)
    assert not damped
    np.testing.assert_allclose(rows @ velocities, twist, atol=1e-9)  # exact up to rounding


def test_stays_bounded_at_a_singularity() -> None:
    robot = load_robot("three_dof")
    stretched = np.array([0.0, -0.5, robot.lower[2]])
    jacobian = robot.jacobian(stretched)[:3].copy()
    jacobian[:, 2] = jacobian[:, 1]  # upper arm and forearm in line: radial motion is lost
    velocities, damped = damped_inverse(jacobian, np.array([0.3, 0.0, 0.3]))
    assert damped
    # |v| <= |twist| / (2 * damping) for every damped least squares solution, at the damping of a true singularity
    assert np.linalg.norm(velocities) <= np.linalg.norm([0.3, 0.3]) / (2 * 0.05) + 1e-9


def test_damping_begins_without_a_jump() -> None:
    def rows(height: float) -> np.ndarray:
        return np.diag([1.0, 1.0, height])

    below, above = (damped_inverse(rows(4e-3 * (1 + side)), np.ones(3)) for side in (-1e-6, 1e-6))
    assert (below[1], above[1]) == (True, False)
    assert below[0][2] == pytest.approx(above[0][2], rel=1e-4)
