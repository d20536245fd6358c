"""Inverse kinematics reaches the whole board, stays inside the limits and says when it cannot."""

import numpy as np
import pytest

from robots import RobotError, RobotModel

# From a block on the board to one carried over towers of eight, and then some.
HEIGHTS = np.linspace(0.019, 0.42, 12)


def board(height: float) -> list[np.ndarray]:
    return [np.array([(x + 0.5) * 0.05, (y + 0.5) * 0.05, height]) for x in range(8) for y in range(8)]


def test_every_cell_is_reached_at_every_height(arm: RobotModel) -> None:
    for height in HEIGHTS:
        for position in board(height):
            result = arm.inverse_kinematics(position)
            assert result.success, position
            assert result.error <= 1e-5
            assert np.all(result.q >= arm.lower) and np.all(result.q <= arm.upper)
            np.testing.assert_allclose(arm.forward_kinematics(result.q).position, position, atol=1e-5)


def test_the_wrist_is_above_a_tower_of_eight_wherever_the_tool_is() -> None:
    rod, tower, forearm_half = 0.34, 8 * 0.038, 0.022
    assert 0.019 + rod - forearm_half > tower


def test_the_tool_can_move_at_0_4_metres_per_second_in_any_direction(arm: RobotModel) -> None:
    slowest = np.inf
    for height in HEIGHTS:
        for position in board(height):
            inverse = np.linalg.inv(arm.jacobian(arm.inverse_kinematics(position).q)[:3])
            # The fastest speed that every direction allows: no row of J^-1 may ask more than its joint gives.
            slowest = min(slowest, float(np.min(arm.velocity / np.linalg.norm(inverse, axis=1))))
    assert slowest >= 0.4


def test_a_near_start_keeps_the_solution_near(arm: RobotModel) -> None:
    start = arm.inverse_kinematics(np.array([0.2, 0.1, 0.2])).q
    result = arm.inverse_kinematics(np.array([0.205, 0.1, 0.2]), start=start)
    assert result.success
    assert result.iterations <= 4
    assert np.abs(result.q - start).max() < 0.05


def test_equal_questions_get_equal_answers(arm: RobotModel) -> None:
    position = np.array([0.31, 0.07, 0.22])
    first, second = arm.inverse_kinematics(position), arm.placed_at(arm.pose_base_in_world).inverse_kinematics(position)
    np.testing.assert_array_equal(first.q, second.q)


@pytest.mark.parametrize("position", [(2.0, 0.0, 0.0), (-0.15, 0.2, 0.2), (0.2, 0.2, 1.5)])
def test_what_is_out_of_reach_fails_inside_the_limits(arm: RobotModel, position: tuple[float, float, float]) -> None:
    for start in (None, arm.home):
        result = arm.inverse_kinematics(np.array(position), start=start)
        assert not result.success
        assert result.error == pytest.approx(
            np.linalg.norm(arm.forward_kinematics(result.q).position - position), abs=1e-9
        )
        assert np.all(result.q >= arm.lower) and np.all(result.q <= arm.upper)


def test_the_answer_to_a_question_just_out_of_reach_is_the_nearest_posture(arm: RobotModel) -> None:
    # Straight ahead at shoulder height the arm is longest where its elbow is bent least.
    reach = np.sqrt(0.4**2 + 0.3**2 + 2 * 0.4 * 0.3 * np.cos(float(arm.lower[2])))
    result = arm.inverse_kinematics(np.array([-0.15 + reach + 0.02, 0.2, 0.21]))
    assert not result.success
    assert result.error == pytest.approx(0.02, abs=2e-4)  # it stops where steps along the limit become small


def test_nonsense_positions_are_refused(arm: RobotModel) -> None:
    with pytest.raises(RobotError, match="three finite numbers"):
        arm.inverse_kinematics(np.array([0.1, np.nan, 0.1]))
    with pytest.raises(RobotError, match="three finite numbers"):
        arm.inverse_kinematics(np.array([0.1, 0.2]))
