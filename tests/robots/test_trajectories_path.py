"""Paths through waypoints do not stop at them and keep every limit, whatever the waypoints are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.trajectories import (
    JointLimits,
    MotionError,
    PathTrajectory,
    check_limits,
    follow_waypoints,
    path_trajectory,
)
from robots.trajectories.path_trajectory import parametrize
from robots.trajectories.paths import blended_polyline
from robots.trajectories.piecewise import PiecewisePolynomial
from robots.trajectories.speed_grid import SpeedGrid, lay_grid
from robots.trajectories.speed_profile import SpeedProfile, fastest_profile

VELOCITY = np.array([1.5, 1.5, 1.5, 1.5, 4.0, 4.0, 4.0])
LIMITS = JointLimits(np.full(7, -2.0), np.full(7, 2.0), VELOCITY, 5 * VELOCITY, 75 * VELOCITY)


def random_waypoints(seed: int, count: int = 10, span: float = 2.0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-span, span, (count, 7))


def distance_to_polyline(point: np.ndarray, waypoints: np.ndarray) -> float:
    """The least, over the segments' points, of the largest joint's distance."""
    best = np.inf
    for begin, end in zip(waypoints[:-1], waypoints[1:], strict=True):
        parts = np.linspace(0, 1, 400)[:, None]
        best = min(best, float(np.min(np.max(np.abs(begin + parts * (end - begin) - point), axis=1))))
    return best


@st.composite
def waypoint_lists(draw: st.DrawFn) -> np.ndarray:
    """Also equal, collinear and reversing ones, and steps from tiny to the whole range."""
    joints = draw(st.integers(1, 4))
    count = draw(st.integers(2, 9))
    generator = np.random.default_rng(draw(st.integers(0, 10**6)))
    points = [generator.uniform(-2, 2, joints)]
    for _ in range(count - 1):
        kind = draw(st.sampled_from(["far", "near", "same", "back", "on", "one joint"]))
        step = generator.uniform(-2, 2, joints)
        if kind == "near":
            step *= 10.0 ** draw(st.integers(-7, -1))
        elif kind == "same":
            step *= 0
        elif kind == "one joint":
            step[1:] = 0
        elif kind != "far" and len(points) > 1:
            step = (points[-1] - points[-2]) * (1 if kind == "on" else -1) * generator.uniform(0.1, 1.0)
        points.append(np.clip(points[-1] + step, -2, 2))
    return np.array(points)


@settings(max_examples=60, deadline=None)
@given(
    waypoints=waypoint_lists(),
    corner=st.sampled_from([0.001, 0.02, 0.1, 0.5]),
    acceleration=st.sampled_from([0.5, 4.0, 30.0]),
    jerk=st.sampled_from([3.0, 15.0, 100.0]),
)
def test_any_waypoints_are_followed_within_all_limits(
    waypoints: np.ndarray, corner: float, acceleration: float, jerk: float
) -> None:
    joints = waypoints.shape[1]
    velocity = np.linspace(1.0, 3.0, joints)
    limits = JointLimits(
        np.full(joints, -2.0), np.full(joints, 2.0), velocity, acceleration * velocity, jerk * acceleration * velocity
    )
    trajectory = follow_waypoints(waypoints, limits, corner)
    report = check_limits(trajectory, limits, max(0.001, trajectory.duration / 20_000))
    # Rounding only: the time scaling leaves a margin of 5e-4 for what happens between its points of checking.
    assert report.worst <= 1 + 1e-9, report
    samples = trajectory.sample(max(trajectory.duration / 100, 1e-3))
    np.testing.assert_allclose(samples.position[0], waypoints[0], atol=1e-12)
    np.testing.assert_allclose(samples.position[-1], waypoints[-1], atol=1e-9)
    for rate in (samples.velocity, samples.acceleration):
        # At rest at both ends, up to what rounding leaves of a cubic law over its whole piece.
        np.testing.assert_allclose(rate[[0, -1]], 0.0, atol=1e-6)


def test_ten_waypoints_take_hardly_longer_than_without_a_jerk_limit() -> None:
    toppra = pytest.importorskip("toppra")
    toppra.utils.setup_logging("ERROR")
    for seed in range(3):
        waypoints = random_waypoints(seed)
        path = blended_polyline(waypoints, LIMITS, 0.1)
        # Measured 1.02 to 1.04; the issue asks for at most 1.3.
        assert follow_waypoints(waypoints, LIMITS, 0.1).duration <= 1.1 * toppra_duration(path)


def toppra_duration(path: PiecewisePolynomial) -> float:
    """Time-optimal duration with velocity and acceleration limits only."""
    import toppra.algorithm as algorithm
    import toppra.constraint as constraint
    from toppra.interpolator import AbstractGeometricPath

    class Curve(AbstractGeometricPath):  # type: ignore[misc]
        dof, path_interval, waypoints = 7, np.array([0.0, path.length]), None

        def __call__(self, at: np.ndarray, order: int = 0) -> np.ndarray:
            values = path.derivatives(np.atleast_1d(at))[order]
            return values if np.ndim(at) else values[0]

    grid = np.concatenate(
        [
            *(np.linspace(a, b, 40, endpoint=False) for a, b in zip(path.breaks[:-1], path.breaks[1:], strict=True)),
            path.breaks[-1:],
        ]
    )
    bounds = [np.stack([-limit, limit], axis=1) for limit in (LIMITS.velocity, LIMITS.acceleration)]
    solver = algorithm.TOPPRA(
        [constraint.JointVelocityConstraint(bounds[0]), constraint.JointAccelerationConstraint(bounds[1])],
        Curve(),
        gridpoints=grid,
        solver_wrapper="seidel",
    )
    speed = solver.compute_parameterization(0, 0)[1]
    return float(2 * np.sum(np.diff(grid) / (speed[:-1] + speed[1:])))


@pytest.mark.parametrize("count", [10, 40])
def test_the_way_is_planned_at_once(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Counted in work, not in time: one optimization, few Newton steps, each over a grid that grows with the waypoints.

    A step's work is in proportion to the grid's points, so that ten waypoints take about 9 ms.
    """
    done: list[tuple[int, int]] = []

    def counted(path: PiecewisePolynomial, limits: JointLimits, grid: SpeedGrid) -> SpeedProfile:
        profile = fastest_profile(path, limits, grid)
        done.append((profile.iterations, len(grid.points)))
        return profile

    monkeypatch.setattr(path_trajectory, "fastest_profile", counted)
    for seed in range(4):
        follow_waypoints(random_waypoints(seed, count), LIMITS, 0.1)
    assert len(done) == 4
    for iterations, points in done:
        assert iterations <= 20  # measured 9 to 15, whatever the number of waypoints
        assert points <= 40 * count  # measured 33 to 37


@pytest.mark.parametrize("corner", [0.02, 0.2])
def test_the_arm_does_not_stop_at_waypoints_and_stays_near_them(corner: float) -> None:
    waypoints = random_waypoints(5)
    trajectory = follow_waypoints(waypoints, LIMITS, corner)
    samples = trajectory.sample(0.002)
    inner = samples.velocity[(samples.time > 0.1) & (samples.time < trajectory.duration - 0.1)]
    assert np.min(np.max(np.abs(inner), axis=1)) > 0.05
    for waypoint in waypoints:
        assert np.min(np.max(np.abs(samples.position - waypoint), axis=1)) <= corner + 0.01  # samples 2 ms apart
    farthest = max(distance_to_polyline(point, waypoints) for point in samples.position[::25])
    assert farthest <= corner + 0.006  # the polyline is sampled every 0.01 rad


def test_the_phase_only_goes_forward() -> None:
    trajectory = follow_waypoints(random_waypoints(2), LIMITS, 0.05)
    phase = trajectory.phase.derivatives(np.linspace(0, trajectory.duration, 20_000)[1:-1])
    assert np.min(phase[1]) > 0
    assert np.all(np.diff(phase[0, :, 0]) > 0)


def test_derivatives_are_those_of_the_position() -> None:
    trajectory = follow_waypoints(random_waypoints(3), LIMITS, 0.05)
    samples = trajectory.sample(1e-4)
    between = np.diff(samples.position, axis=0)[:-1] / 1e-4
    # The mean velocity of 0.1 ms is that of its middle to jerk times h^2 / 24, 1e-7; rounding adds 1e-11.
    np.testing.assert_allclose(between, (samples.velocity[:-2] + samples.velocity[1:-1]) / 2, atol=1e-6)
    change = np.diff(samples.velocity, axis=0)[:-1] / 1e-4
    # Jerk may jump inside the step: jerk times h / 4 at most.
    np.testing.assert_allclose(change, (samples.acceleration[:-2] + samples.acceleration[1:-1]) / 2, atol=0.01)


def test_a_straight_way_is_the_optimum() -> None:
    limits = JointLimits(np.array([-9.0]), np.array([9.0]), np.array([1.0]), np.array([2.0]), np.array([20.0]))
    straight = follow_waypoints(np.array([[0.0], [3.0]]), limits)
    assert straight.duration == pytest.approx(3 / 1 + 1 / 2 + 2 / 20)  # d / v + v / a + a / j
    # The same way as a path of three collinear points goes through the numerical method.
    bent = follow_waypoints(np.array([[0.0], [1.0], [3.0]]), limits)
    assert bent.duration == pytest.approx(straight.duration, rel=0.03)
    assert bent.duration >= straight.duration


def test_the_optimization_ends_by_its_own_criterion() -> None:
    for seed in range(5):
        path = blended_polyline(random_waypoints(seed), LIMITS, 0.05)
        profile = fastest_profile(path, LIMITS, lay_grid(path, LIMITS, 4))
        assert profile.success
        assert profile.iterations < 25


def test_waypoints_at_the_position_limits_are_not_overshot() -> None:
    corners = np.array([[-2.0] * 7, [2.0] * 7, [-2.0, 2.0] * 3 + [2.0], [2.0] * 7, [-2.0] * 7])
    report = check_limits(follow_waypoints(corners, LIMITS, 0.3), LIMITS)
    assert report.position <= 1 + 1e-12
    assert report.worst <= 1 + 1e-9


def test_one_waypoint_is_a_motion_of_no_time() -> None:
    still: PathTrajectory = follow_waypoints(np.zeros((1, 7)), LIMITS)
    assert still.duration == 0.0
    for value in still.at(0.0):
        np.testing.assert_array_equal(value, np.zeros(7))
    assert check_limits(still, LIMITS).worst == 0.0
    assert parametrize(still.path, LIMITS).duration == 0.0


def test_nonsense_is_refused() -> None:
    waypoints = random_waypoints(0)
    waypoints[4, 2] = np.nan
    with pytest.raises(MotionError, match="waypoint 4 .* is not finite"):
        follow_waypoints(waypoints, LIMITS)
    waypoints[4, 2] = 2.5
    with pytest.raises(MotionError, match="waypoint 4 is out of limits: joint 2 at 2.5, allowed -2 to 2"):
        follow_waypoints(waypoints, LIMITS)
    with pytest.raises(MotionError, match="corner deviation must be positive; got 0"):
        follow_waypoints(random_waypoints(0), LIMITS, 0.0)
    with pytest.raises(MotionError, match="at least one waypoint"):
        follow_waypoints(np.empty((0, 7)), LIMITS)
    with pytest.raises(MotionError, match="sampling period must be positive; got 0"):
        follow_waypoints(random_waypoints(0), LIMITS).sample(0.0)
