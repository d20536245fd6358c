"""Point-to-point motions keep the limits from rest and from motion, and say when that is impossible."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from robots.trajectories import JointLimits, MotionError, check_limits, move_joints

LIMITS = JointLimits(
    np.array([-1.0, -2.0, -np.inf]),
    np.array([1.0, 0.5, np.inf]),
    np.array([1.5, 2.0, 4.0]),
    np.array([6.0, 8.0, 20.0]),
    np.array([90.0, 100.0, 300.0]),
)
LOWER, UPPER = np.array([-1.0, -2.0, -9.0]), np.array([1.0, 0.5, 9.0])

parts = st.lists(st.floats(0, 1), min_size=3, max_size=3).map(np.array)
signed = st.lists(st.floats(-1, 1), min_size=3, max_size=3).map(np.array)


@settings(max_examples=150, deadline=None)
@given(parts, parts)
def test_from_rest_every_limit_is_kept(begin: np.ndarray, end: np.ndarray) -> None:
    start, goal = LOWER + begin * (UPPER - LOWER), LOWER + end * (UPPER - LOWER)
    trajectory = move_joints(start, goal, LIMITS)
    report = check_limits(trajectory, LIMITS)
    assert report.worst <= 1 + 1e-6  # Ruckig is exact; jerk is measured from differences of rounded values
    np.testing.assert_allclose(trajectory.at(0.0)[0], start, atol=1e-12)
    np.testing.assert_allclose(trajectory.at(trajectory.duration)[0], goal, atol=1e-9)


@settings(max_examples=150, deadline=None)
@given(parts, parts, signed, signed)
def test_from_motion_every_limit_is_kept_or_the_start_is_refused(
    begin: np.ndarray, end: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray
) -> None:
    start, goal = LOWER + begin * (UPPER - LOWER), LOWER + end * (UPPER - LOWER)
    velocity, acceleration = velocity * LIMITS.velocity, acceleration * LIMITS.acceleration
    try:
        trajectory = move_joints(start, goal, LIMITS, velocity, acceleration)
    except MotionError:
        assume(False)
    assert check_limits(trajectory, LIMITS).worst <= 1 + 1e-6
    for value, expected in zip(trajectory.at(0.0), (start, velocity, acceleration), strict=True):
        np.testing.assert_allclose(value, expected, atol=1e-9)
    position, speed, rate = trajectory.at(trajectory.duration)
    np.testing.assert_allclose(position, goal, atol=1e-8)
    np.testing.assert_allclose(speed, 0.0, atol=1e-7)
    np.testing.assert_allclose(rate, 0.0, atol=1e-6)


def test_the_duration_is_that_of_the_slowest_joint() -> None:
    trajectory = move_joints(np.zeros(3), np.array([0.9, 0.1, 0.0]), LIMITS)
    assert trajectory.duration == pytest.approx(0.9 / 1.5 + 1.5 / 6 + 6 / 90)


def test_a_start_too_fast_to_brake_before_the_limit_is_refused() -> None:
    with pytest.raises(MotionError, match=r"joint 0 starts at 0.95 rad with 1.2 rad/s and would swing to"):
        move_joints(np.array([0.95, 0, 0]), np.zeros(3), LIMITS, np.array([1.2, 0, 0]))


def test_a_start_that_can_brake_is_not_carried_over_the_limit_by_a_slow_neighbour() -> None:
    # Joint 2 takes seconds; joint 0 must not go on towards its limit meanwhile.
    trajectory = move_joints(np.array([0.8, 0, 0]), np.array([0.9, 0, 30.0]), LIMITS, np.array([0.8, 0, 0]))
    assert check_limits(trajectory, LIMITS).worst <= 1 + 1e-6


def test_an_acceleration_that_cannot_end_before_the_speed_limit_is_refused() -> None:
    with pytest.raises(MotionError, match="joint 0 starts so that it reaches 1.65 rad/s, allowed 1.5"):
        move_joints(np.zeros(3), np.zeros(3), LIMITS, np.array([1.45, 0, 0]), np.array([6.0, 0, 0]))


def test_no_way_takes_no_time() -> None:
    trajectory = move_joints(np.zeros(3), np.zeros(3), LIMITS)
    assert trajectory.duration == 0.0
    np.testing.assert_array_equal(trajectory.sample(0.01).position, np.zeros((1, 3)))


def test_nonsense_is_refused() -> None:
    with pytest.raises(MotionError, match="start .*nan.* is not finite"):
        move_joints(np.array([0, np.nan, 0]), np.zeros(3), LIMITS)
    with pytest.raises(MotionError, match="end is out of limits: joint 1 at 0.6, allowed -2 to 0.5"):
        move_joints(np.zeros(3), np.array([0, 0.6, 0]), LIMITS)
    with pytest.raises(MotionError, match="end has shape .2,.; these limits are for 3 joints"):
        move_joints(np.zeros(3), np.zeros(2), LIMITS)
    with pytest.raises(MotionError, match="start velocity .*nan.* must be 3 values within"):
        move_joints(np.zeros(3), np.zeros(3), LIMITS, np.array([np.nan, 0, 0]))


def test_limits_that_make_no_sense_are_refused() -> None:
    one = np.ones(2)
    with pytest.raises(MotionError, match="must be arrays of one length; got lower .2,., upper .3,."):
        JointLimits(-one, np.ones(3), one, one, one)
    with pytest.raises(MotionError, match="must be below"):
        JointLimits(one, one, one, one, one)
    with pytest.raises(MotionError, match="jerk limits must be positive and finite; got .1. 0."):
        JointLimits(-one, one, one, one, np.array([1.0, 0.0]))
