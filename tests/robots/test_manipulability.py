"""Manipulability is exact where it can be computed by hand, and zero at singularities."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots import RobotError
from robots.manipulability import condition_number, manipulability


def two_links(shoulder: float, elbow: float) -> np.ndarray:
    """Jacobian of a planar arm with links of 0.4 and 0.3 m: rows x, y."""
    both = shoulder + elbow
    return np.array(
        [
            [-0.4 * np.sin(shoulder) - 0.3 * np.sin(both), -0.3 * np.sin(both)],
            [0.4 * np.cos(shoulder) + 0.3 * np.cos(both), 0.3 * np.cos(both)],
        ]
    )


@given(shoulder=st.floats(-3.0, 3.0), elbow=st.floats(-3.0, 3.0))
def test_a_planar_arm_has_the_known_manipulability(shoulder: float, elbow: float) -> None:
    # Yoshikawa 1985: w = l1 l2 |sin elbow|.
    assert manipulability(two_links(shoulder, elbow)) == pytest.approx(0.4 * 0.3 * abs(np.sin(elbow)), abs=1e-14)


def test_it_is_the_root_of_the_determinant() -> None:
    jacobian = np.random.default_rng(0).normal(size=(6, 7))
    assert manipulability(jacobian) == pytest.approx(np.sqrt(np.linalg.det(jacobian @ jacobian.T)), rel=1e-9)


def test_an_arm_with_fewer_joints_than_rows_cannot_move_every_way() -> None:
    jacobian = np.random.default_rng(0).normal(size=(6, 3))
    assert manipulability(jacobian) == 0.0
    assert condition_number(jacobian) == np.inf
    assert condition_number(jacobian[:3]) < np.inf


def test_the_condition_number_weighs_metres_against_radians_by_the_length() -> None:
    jacobian = np.diag([0.5, 0.5, 0.5, 1.0, 1.0, 1.0])
    assert condition_number(jacobian) == pytest.approx(2.0)
    assert condition_number(jacobian, length=0.5) == pytest.approx(1.0)
    assert condition_number(np.diag([1.0, 2.0, 4.0]), length=0.1) == pytest.approx(4.0)


def test_a_singular_posture_has_an_infinite_condition_number() -> None:
    jacobian = np.random.default_rng(0).normal(size=(6, 6))
    jacobian[:, 5] = jacobian[:, 4]
    assert condition_number(jacobian) == np.inf
    assert manipulability(jacobian) == pytest.approx(0.0, abs=1e-12)  # rounding of five singular values near 1


def test_nonsense_is_refused() -> None:
    with pytest.raises(RobotError, match="finite matrix"):
        manipulability(np.full((3, 3), np.nan))
    with pytest.raises(RobotError, match="finite matrix .* got shape \\(3,\\)"):
        condition_number(np.ones(3))
    with pytest.raises(RobotError, match="3 or 6 rows, got 4"):
        condition_number(np.ones((4, 6)))
    with pytest.raises(RobotError, match="length must be positive and finite"):
        condition_number(np.eye(6), length=0.0)
