"""Ways around what stands in the way: free, reproducible, within the limits, and refused with a reason."""

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.trajectories import (
    JointLimits,
    MotionError,
    check_limits,
    plan_motion,
    plan_path,
    plan_together,
)
from robots.trajectories.free_space import FreeSpace

ARM = JointLimits(np.full(3, -2.9), np.full(3, 2.9), np.full(3, 2.0), np.full(3, 10.0), np.full(3, 150.0))
START, GOAL = np.array([-1.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])
LINKS = np.array([0.4, 0.3, 0.2])


def past_the_wall(q: np.ndarray, clearance: float = 0.01) -> bool:
    """A thick wall between joint 0's sides, open where joint 1 is far out."""
    return not (abs(q[0]) < 0.3 + clearance and abs(q[1]) < 2.0 + clearance)


def segments(q: np.ndarray, base: tuple[float, float]) -> np.ndarray:
    """Links of a planar arm as points, 9 on each, (27, 2) [m]."""
    angles = np.cumsum(q)
    joints = np.vstack([np.zeros(2), np.cumsum(LINKS[:, None] * np.stack([np.cos(angles), np.sin(angles)], 1), axis=0)])
    parts = np.linspace(0, 1, 9)[:, None]
    return np.vstack([a + parts * (b - a) for a, b in zip(joints[:-1], joints[1:], strict=True)]) + np.array(base)


def past_each_other(arms: list[np.ndarray]) -> bool:
    """Two planar arms 0.8 m apart, each link 8 cm thick, folding onto itself allowed."""
    left, right = segments(arms[0], (-0.4, 0.0)), segments(arms[1], (0.4, 0.0))
    return bool(np.min(np.linalg.norm(left[:, None] - right[None], axis=2)) > 0.08)


def test_a_free_straight_way_is_taken() -> None:
    plan = plan_path(START, GOAL, ARM, lambda q: True, np.random.default_rng(0))
    assert plan.success and plan.straight
    np.testing.assert_array_equal(plan.waypoints, [START, GOAL])
    # Both ends and steps of at most 0.03 rad between them.
    assert 2 + 66 <= plan.checks <= 4 + 67


@pytest.mark.parametrize("seed", range(5))
def test_a_wall_is_gone_around_without_touching_it(seed: int) -> None:
    # Between checks 0.01 rad apart the edge of the wall can be cut by half of that: the clearance is for this.
    plan = plan_motion(START, GOAL, ARM, past_the_wall, np.random.default_rng(seed))
    assert plan.success, plan.reason
    assert plan.trajectory is not None
    assert not plan.way.straight
    samples = plan.trajectory.sample(0.002)
    assert all(past_the_wall(q, 0.0) for q in samples.position)
    np.testing.assert_allclose(samples.position[[0, -1]], [START, GOAL], atol=1e-12)
    assert check_limits(plan.trajectory, ARM).worst <= 1 + 1e-9
    # No stop on the way.
    assert np.min(np.max(np.abs(samples.velocity[50:-50]), axis=1)) > 0.01
    # The shortest way is about 4.9 rad, the ways of 30 seeds up to 6.6, and up to 9.2 before random shortcuts.
    assert np.sum(np.linalg.norm(np.diff(plan.way.waypoints, axis=0), axis=1)) < 7.0


def test_the_same_seed_gives_the_same_way() -> None:
    def waypoints(seed: int) -> np.ndarray:
        return plan_path(START, GOAL, ARM, past_the_wall, np.random.default_rng(seed)).waypoints

    first, other = waypoints(3), waypoints(4)
    np.testing.assert_array_equal(first, waypoints(3))
    assert first.shape != other.shape or np.any(first != other)


def test_the_same_seed_gives_the_same_way_in_threads_at_once() -> None:
    expected = [plan_path(START, GOAL, ARM, past_the_wall, np.random.default_rng(seed)).waypoints for seed in range(4)]
    found: dict[int, np.ndarray] = {}

    def work(seed: int) -> None:
        found[seed] = plan_path(START, GOAL, ARM, past_the_wall, np.random.default_rng(seed)).waypoints

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for seed in range(4):
        np.testing.assert_array_equal(found[seed], expected[seed])


@pytest.mark.parametrize(
    ("start", "goal", "reason"),
    [
        ([0.0, 0.0, 0.0], GOAL, "start is in collision"),
        (START, [0.1, 0.0, 0.0], "goal is in collision"),
        ([-1.0, np.nan, 0.0], GOAL, "start .*nan.* is not finite"),
        (START, [1.0, 3.0, 0.0], "goal is out of limits: joint 1 at 3, allowed -2.9 to 2.9"),
        (START, [1.0, 0.0], "goal has shape .2,.; these limits are for 3 joints"),
    ],
)
def test_impossible_ends_have_a_reason(start: object, goal: object, reason: str) -> None:
    plan = plan_motion(np.array(start), np.array(goal), ARM, past_the_wall, np.random.default_rng(0))
    assert not plan.success
    assert plan.trajectory is None
    assert plan.way.waypoints.shape == (0, 3)
    with pytest.raises(AssertionError, match=reason):
        raise AssertionError(plan.reason)


def test_a_closed_wall_ends_with_a_reason_after_the_checks_allowed() -> None:
    plan = plan_path(START, GOAL, ARM, lambda q: abs(q[0]) > 0.3, np.random.default_rng(0), max_checks=2000)
    assert not plan.success
    assert plan.reason == "no way found with 2000 checks; there may be none"
    assert plan.checks < 2200  # the last edge is finished


def test_what_the_geometry_raises_comes_through() -> None:
    def broken(q: np.ndarray) -> bool:
        if not past_the_wall(q):
            raise ZeroDivisionError("the geometry broke")
        return True

    with pytest.raises(ZeroDivisionError, match="the geometry broke"):
        plan_path(START, GOAL, ARM, broken, np.random.default_rng(0))


def test_a_continuous_joint_goes_the_short_way_round() -> None:
    free = np.array([np.inf])
    limits = JointLimits(-free, free, np.array([1.0]), np.array([5.0]), np.array([50.0]))
    plan = plan_motion(np.array([3.0]), np.array([-3.0]), limits, lambda q: True, np.random.default_rng(0))
    assert plan.trajectory is not None
    end = plan.trajectory.at(plan.trajectory.duration)[0]
    np.testing.assert_allclose(end, [2 * np.pi - 3.0], atol=1e-12)


def test_a_continuous_joint_is_not_sent_to_other_turns_of_its_goal() -> None:
    bound = np.array([np.inf, 0.5])
    limits = JointLimits(-bound, bound, np.ones(2), np.full(2, 5.0), np.full(2, 50.0))

    def beside_the_bar(q: np.ndarray) -> bool:
        return abs((q[0] + np.pi) % (2 * np.pi) - np.pi - 0.5) > 0.2  # blocked at 0.5 on every turn

    plan = plan_path(np.zeros(2), np.array([1.0, 0.0]), limits, beside_the_bar, np.random.default_rng(0))
    # From 0 the nearest turn of the goal is behind the bar; other turns are not searched.
    assert not plan.success


def test_a_corner_beside_an_obstacle_is_cut_less() -> None:
    # A way through a bent corridor 0.08 rad wide: corners cut by 0.5 rad would leave it.
    def in_the_corridor(q: np.ndarray) -> bool:
        return in_corridor(q, 0.04)

    def in_corridor(q: np.ndarray, half: float) -> bool:
        along = abs(q[1]) < half and -1 - half < q[0] < 1 + half
        return along or (abs(q[0] - 1.0) < half and -half < q[1] < 1 + half)

    limits = JointLimits(np.full(2, -1.5), np.full(2, 1.5), np.ones(2), np.full(2, 5.0), np.full(2, 50.0))
    plan = plan_motion(
        np.array([-1.0, 0.0]), np.array([1.0, 1.0]), limits, in_the_corridor, np.random.default_rng(1), corner=0.5
    )
    assert plan.success, plan.reason
    assert plan.trajectory is not None
    assert all(in_corridor(q, 0.045) for q in plan.trajectory.sample(0.001).position)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_any_plan_is_free_and_within_the_limits(seed: int) -> None:
    generator = np.random.default_rng(seed)
    balls = generator.uniform(-2.5, 2.5, (6, 3))

    def is_free(q: np.ndarray) -> bool:
        return bool(np.min(np.linalg.norm(balls - q, axis=1)) > 0.7)

    start, goal = generator.uniform(-2.9, 2.9, (2, 3))
    plan = plan_motion(start, goal, ARM, is_free, generator)
    if not plan.success:
        assert "collision" in plan.reason or "no way" in plan.reason
        return
    assert plan.trajectory is not None
    assert check_limits(plan.trajectory, ARM).worst <= 1 + 1e-9
    # Between checks sqrt(3) * 0.01 rad apart a ball can be grazed by d^2 / 8 r.
    for q in plan.trajectory.sample(0.01).position:
        assert np.min(np.linalg.norm(balls - q, axis=1)) > 0.7 - 1e-4


def test_edges_are_checked_no_further_apart_than_the_resolution() -> None:
    seen: list[float] = []
    space = FreeSpace(lambda q: not seen.append(float(q[0])), 0.1)
    assert space.edge(np.zeros(1), np.array([1.05]))
    assert seen[0] == pytest.approx(1.05)  # the end, then the middle
    assert 0.4 < seen[1] < 0.6
    assert np.max(np.diff(np.sort([0.0, *seen]))) <= 0.1 + 1e-12
    assert space.checks == len(seen)
    with pytest.raises(MotionError, match="resolution must be positive; got 0"):
        FreeSpace(lambda q: True, 0.0)


def test_two_arms_change_places_without_touching_each_other() -> None:
    # One arm reaches inwards above the other and they swap: their straight ways would cross.
    high, low = np.array([0.7, 0.0, 0.0]), np.array([-0.6, 1.0, -0.4])
    mirror = np.array([np.pi, 0.0, 0.0])
    left, right = (high, low), (mirror - low, mirror - high)
    limits = JointLimits(np.full(3, -4.5), np.full(3, 4.5), np.full(3, 2.0), np.full(3, 10.0), np.full(3, 150.0))
    starts, goals = [left[0], right[0]], [left[1], right[1]]
    assert past_each_other(starts) and past_each_other(goals)
    halfway = [(a + b) / 2 for a, b in zip(starts, goals, strict=True)]
    assert not past_each_other(halfway)
    motion = plan_together(starts, goals, [limits, limits], past_each_other, np.random.default_rng(0))
    assert motion.success, motion.reason
    assert not motion.plan.way.straight
    one, two = motion.trajectories
    assert one.duration == two.duration
    positions = [trajectory.sample(0.005).position for trajectory in (one, two)]
    assert all(past_each_other([a, b]) for a, b in zip(*positions, strict=True))
    for trajectory, start, goal in zip((one, two), starts, goals, strict=True):
        assert check_limits(trajectory, limits).worst <= 1 + 1e-9
        np.testing.assert_allclose(trajectory.at(0.0)[0], start, atol=1e-12)
        np.testing.assert_allclose(trajectory.at(trajectory.duration)[0], goal, atol=1e-9)


def test_arms_that_do_not_fit_their_limits_are_refused() -> None:
    generator = np.random.default_rng(0)
    with pytest.raises(MotionError, match="as many arms; got 1, 1, 2"):
        plan_together([START], [GOAL], [ARM, ARM], lambda arms: True, generator)
    with pytest.raises(MotionError, match=r"the goal of arm 1 has shape \(2,\), allowed \(3,\)"):
        plan_together([START, START], [GOAL, GOAL[:2]], [ARM, ARM], lambda arms: True, generator)
    motion = plan_together([START, START], [GOAL, GOAL], [ARM, ARM], lambda arms: False, generator)
    assert not motion.success
    assert motion.reason == "start is in collision"
    assert motion.trajectories == ()
