"""The base arrives exactly, never slips sideways, and finds its way around."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.trajectories import BaseLimits, BaseTrajectory, MotionError, drive_base

LIMITS = BaseLimits()
coordinates = st.floats(-3, 3)
poses = st.tuples(coordinates, coordinates, st.floats(-7, 7)).map(np.array)


def assert_drivable(trajectory: BaseTrajectory, limits: BaseLimits, period: float = 0.002) -> None:
    samples = trajectory.sample(period)
    assert np.max(np.abs(samples.twist) / [limits.speed, limits.yaw_rate]) <= 1 + 1e-9
    assert np.max(np.abs(samples.acceleration) / [limits.acceleration, limits.yaw_acceleration]) <= 1 + 1e-9
    jerk = np.abs(np.diff(samples.acceleration, axis=0)) / np.diff(samples.time)[:, None].clip(0.1 * period)
    assert np.max(jerk / [limits.jerk, limits.yaw_jerk], initial=0.0) <= 1 + 1e-6
    steps = np.diff(samples.pose, axis=0)
    middle = samples.pose[:-1, 2] + steps[:, 2] / 2
    # It never turns and drives at once but in the step where one ends and the other begins.
    lateral = -np.sin(middle) * steps[:, 0] + np.cos(middle) * steps[:, 1]
    assert np.max(np.abs(lateral), initial=0.0) <= 1e-9
    assert np.max(np.abs(steps), initial=0.0) <= max(limits.speed, limits.yaw_rate) * period * (1 + 1e-6)


@settings(max_examples=60, deadline=None)
@given(poses, poses)
def test_any_pose_is_reached_exactly_without_slip(start: np.ndarray, goal: np.ndarray) -> None:
    motion = drive_base(start, goal, LIMITS)
    assert motion.success
    assert motion.trajectory is not None
    trajectory = motion.trajectory
    # What is nearer than a nanometre is there already: then the motion starts where it ends.
    np.testing.assert_allclose(trajectory.at(0.0)[0], start, atol=1e-9)
    end, twist, acceleration = trajectory.at(trajectory.duration)
    np.testing.assert_array_equal(end[:2], goal[:2])
    assert math.remainder(end[2] - goal[2], 2 * math.pi) == pytest.approx(0.0, abs=1e-12)
    assert not twist.any() and not acceleration.any()
    just_before = trajectory.at(trajectory.duration - 1e-6)[0]
    np.testing.assert_allclose(just_before, end, atol=1e-6)
    assert len(trajectory.phases) <= 3
    assert_drivable(trajectory, LIMITS, 0.01)


def test_it_turns_drives_and_turns() -> None:
    motion = drive_base(np.zeros(3), np.array([0.0, 2.0, 0.0]), LIMITS)
    assert motion.trajectory is not None
    assert [phase.drives for phase in motion.trajectory.phases] == [False, True, False]
    turn = math.pi / 2 / 1.0 + 1.0 / 1.5 + 1.5 / 15
    drive = 2.0 / 0.5 + 0.5 / 0.5 + 0.5 / 5.0
    assert motion.trajectory.duration == pytest.approx(2 * turn + drive)
    assert_drivable(motion.trajectory, LIMITS)


def test_what_lies_behind_is_reached_backwards() -> None:
    motion = drive_base(np.zeros(3), np.array([-1.0, 0.0, 0.0]), LIMITS)
    assert motion.trajectory is not None
    assert [phase.drives for phase in motion.trajectory.phases] == [True]
    assert motion.trajectory.sample(0.01).twist[:, 0].min() == pytest.approx(-0.5, abs=1e-9)


def test_a_pose_that_it_has_already_takes_no_time() -> None:
    motion = drive_base(np.array([1.0, 2.0, 0.5]), np.array([1.0, 2.0, 0.5 + 4 * math.pi]), LIMITS)
    assert motion.trajectory is not None
    assert motion.trajectory.duration == pytest.approx(0.0, abs=1e-6)


def beside_the_pillar(pose: np.ndarray) -> bool:
    """A base 0.6 m long and 0.5 m wide beside a round pillar of 0.3 m radius at (1.5, 0)."""
    x, y = 1.5 - pose[0], -pose[1]
    cosine, sine = math.cos(pose[2]), math.sin(pose[2])
    along, across = abs(cosine * x + sine * y) - 0.3, abs(-sine * x + cosine * y) - 0.25
    return math.hypot(max(along, 0.0), max(across, 0.0)) > 0.3


def test_a_pillar_is_gone_around() -> None:
    start, goal = np.zeros(3), np.array([3.0, 0.1, 1.0])
    motion = drive_base(start, goal, LIMITS, beside_the_pillar, np.random.default_rng(0))
    assert motion.success, motion.reason
    assert motion.trajectory is not None
    assert len(motion.trajectory.phases) > 3
    assert all(beside_the_pillar(pose) for pose in motion.trajectory.sample(0.02).pose)
    assert_drivable(motion.trajectory, LIMITS)
    np.testing.assert_array_equal(motion.trajectory.at(1e9)[0][:2], goal[:2])
    assert motion.trajectory.duration < 25  # turn and drive of 3.2 m: 7 s and about 1.6 s a right angle
    again = drive_base(start, goal, LIMITS, beside_the_pillar, np.random.default_rng(0))
    np.testing.assert_array_equal(motion.trajectory.sample(0.1).pose, again.trajectory.sample(0.1).pose)


def in_the_dock(pose: np.ndarray) -> bool:
    """The base between walls 0.5 m apart at x > 2, too narrow to turn, and free space before them."""
    half = np.array([[0.3, 0.2], [0.3, -0.2], [-0.3, 0.2], [-0.3, -0.2]])
    turn = np.array([[math.cos(pose[2]), -math.sin(pose[2])], [math.sin(pose[2]), math.cos(pose[2])]])
    corners = half @ turn.T + pose[:2]
    return not np.any((corners[:, 0] > 2.0) & (np.abs(corners[:, 1]) > 0.25))


def test_a_dock_is_driven_into_straight() -> None:
    start, goal = np.array([0.0, 1.5, 0.0]), np.array([2.5, 0.0, 0.0])
    motion = drive_base(start, goal, LIMITS, in_the_dock, np.random.default_rng(0))
    assert motion.success, motion.reason
    assert motion.trajectory is not None
    assert all(in_the_dock(pose) for pose in motion.trajectory.sample(0.02).pose)
    np.testing.assert_array_equal(motion.trajectory.goal[:2], goal[:2])
    out = drive_base(goal, np.array([0.0, 1.5, 3.0]), LIMITS, in_the_dock, np.random.default_rng(0))
    assert out.success, out.reason
    assert out.trajectory is not None
    assert all(in_the_dock(pose) for pose in out.trajectory.sample(0.02).pose)


def test_what_cannot_be_has_a_reason() -> None:
    inside, outside = np.array([1.5, 0.0, 0.0]), np.zeros(3)
    assert drive_base(inside, outside, LIMITS, beside_the_pillar).reason == "start is in collision"
    assert drive_base(outside, inside, LIMITS, beside_the_pillar).reason == "goal is in collision"
    assert "goal must be three finite numbers" in drive_base(outside, np.array([0, np.nan, 0]), LIMITS).reason

    def walled(pose: np.ndarray) -> bool:
        return abs(pose[0] - 1.5) > 0.1

    motion = drive_base(np.zeros(3), np.array([3.0, 0.0, 0.0]), LIMITS, walled)
    assert not motion.success
    assert motion.reason == "no way around found; there may be none"
    narrow = drive_base(np.zeros(3), np.array([3.0, 3.0, 0.0]), LIMITS, lambda pose: abs(math.sin(pose[2])) < 0.5)
    assert "start has no room to turn" in narrow.reason
    with pytest.raises(MotionError, match="base limit speed must be positive and finite; got 0"):
        BaseLimits(speed=0.0)
