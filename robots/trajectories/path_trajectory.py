"""A path followed in time: q(s(t)), as fast as the joints' limits allow."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .joints import move_joints
from .limits import JointLimits
from .paths import blended_polyline
from .piecewise import IntArray, PiecewisePolynomial
from .speed_grid import AT, SpeedGrid, lay_grid
from .speed_profile import fastest_profile
from .trajectory import Samples, sample_times

FINE = 3
"""Pieces of the phase on each interval of the speed grid."""
BLEND_PARTS = 4
"""Intervals of the speed grid on a curved piece of a path."""
COARSE, DENSE = 5, 33
"""Points on each piece of the phase that are compared with the limits, and on those that come near them."""
MARGIN = 1e-4
"""Time is stretched by this much more than the points of checking ask for, since limits can be met between them."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)


@dataclass(frozen=True, slots=True)
class PathTrajectory:
    """A path and the phase in which it is followed.

    Attributes:
        path: q(s).
        phase: s(t), one coordinate, breaks in [s] from 0.
    """

    path: PiecewisePolynomial
    phase: PiecewisePolynomial

    @property
    def duration(self) -> float:
        """Time it takes [s]."""
        return self.phase.length

    def at(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, velocity, acceleration at `time` [s], each (n,)."""
        position, velocity, acceleration, _ = self.derivatives(np.array([time]))[:, 0]
        return position, velocity, acceleration

    def sample(self, period: float) -> Samples:
        """States at every `period` [s] and at the end."""
        times = sample_times(self.duration, period)
        return Samples(times, *self.derivatives(times)[:3])

    def derivatives(self, times: FloatArray) -> FloatArray:
        """Position and its first three derivatives in time, (4, k, n)."""
        return in_time(self.path, self.phase.derivatives(times)[:, :, 0])

    def slowed(self, slower: float) -> "PathTrajectory":
        """The same motion, played `slower` times as slowly."""
        powers = slower ** -np.arange(self.phase.coefficients.shape[1], dtype=np.float64)
        phase = PiecewisePolynomial(self.phase.breaks * slower, self.phase.coefficients * powers[:, None])
        return PathTrajectory(self.path, phase)


def in_time(path: PiecewisePolynomial, phase: FloatArray) -> FloatArray:
    """Derivatives of q(s(t)) from those of s, (4, k), by the chain rule, (4, k, n)."""
    s, ds, dds, ddds = phase[:, :, None]
    q, first, second, third = path.derivatives(phase[0])
    return np.stack(
        [
            q,
            first * ds,
            second * ds**2 + first * dds,
            third * ds**3 + 3 * second * ds * dds + first * ddds,
        ]
    )


def follow_waypoints(
    waypoints: FloatArray, limits: JointLimits, corner: float = 0.05, shrink: FloatArray | None = None
) -> PathTrajectory:
    """Move through waypoints from rest to rest without stopping at them, cutting each corner by `corner` at most.

    Args:
        waypoints: Postures, (k, n) [rad].
        limits: Of the joints.
        corner: How far any joint may leave the polyline of the waypoints [rad].
        shrink: Factors on `corner` for each waypoint, (k,).

    Raises:
        MotionError: A waypoint is not finite or out of limits, or `corner` is not positive.
    """
    return parametrize(blended_polyline(waypoints, limits, corner, shrink), limits)


def parametrize(path: PiecewisePolynomial, limits: JointLimits, parts: int = BLEND_PARTS) -> PathTrajectory:
    """Follow a path from rest to rest as fast as velocity, acceleration and jerk limits allow.

    Args:
        path: q(s) with continuous second derivative.
        limits: Of the joints; their position limits are the path's business.
        parts: Into how many intervals the speed on each curved piece is divided; more is slower to plan.
    """
    if path.length == 0 or not np.any(path.coefficients[:, 1:] != 0):
        return PathTrajectory(path, PiecewisePolynomial(np.zeros(2), path.breaks[:1].reshape(1, 1, 1)))
    if len(path.coefficients) == 1 and not np.any(path.coefficients[:, 2:] != 0):
        return PathTrajectory(path, _straight_phase(path, limits))
    grid = lay_grid(path, limits, parts)
    profile = fastest_profile(path, limits, grid)
    trajectory = PathTrajectory(path, _phase(grid, profile.square))
    return trajectory.slowed(needed_slowdown(trajectory, limits) * (1 + MARGIN))


def _straight_phase(path: PiecewisePolynomial, limits: JointLimits) -> PiecewisePolynomial:
    """On a straight line the optimum is known: Ruckig's, with the joints' limits along the line."""
    tangent = np.abs(path.coefficients[0, 1])
    moving = tangent > 0
    along = [
        np.array([np.min(bound[moving] / tangent[moving])])
        for bound in (limits.velocity, limits.acceleration, limits.jerk)
    ]
    whole = JointLimits(np.array([-np.inf]), np.array([np.inf]), *along)
    return move_joints(path.breaks[:1], path.breaks[1:], whole).curve


def _phase(grid: SpeedGrid, square: FloatArray) -> PiecewisePolynomial:
    """s(t) from the squared speed: quintic pieces that agree with it in s, s', s'' at their ends."""
    knots = grid.knots
    sizes = np.diff(knots)
    # b on the inner intervals as a quadratic in the distance from the knot, from its state at the interval's begin.
    begin = square[2:-2].reshape(-1, AT.size, 3)[:, 0]
    x = np.arange(FINE + 1) / FINE * sizes[1:-1, None]
    b = begin[:, :1] + x * (begin[:, 1:2] + x / 2 * begin[:, 2:])
    slope = begin[:, 1:2] + x * begin[:, 2:]
    middle = (x[:, 1:] + x[:, :-1])[:, :, None] / 2 + np.diff(x)[:, :, None] / 2 * _NODES
    inside = begin[:, :1, None] + middle * (begin[:, 1:2, None] + middle / 2 * begin[:, 2:, None])
    times = np.diff(x) / 2 * np.sum(_WEIGHTS / np.sqrt(inside), axis=2)
    # From rest with constant jerk: t = 3 h / s' at the inner end, of which s'' = 2 s' / t and s''' = s'' / t.
    first, last = (3 * size / np.sqrt(end) for size, end in ((sizes[0], square[1, 0]), (sizes[-1], square[-1, 0])))
    zero = np.zeros(1)
    s = np.concatenate([knots[:1], (knots[1:-2, None] + x[:, :-1]).ravel(), knots[-2:]])
    ds = np.concatenate([zero, np.sqrt(b[:, :-1]).ravel(), np.sqrt(square[-1:, 0]), zero])
    dds = np.concatenate([zero, slope[:, :-1].ravel() / 2, square[-1:, 1] / 2, zero])
    breaks = np.concatenate([zero, np.cumsum(np.concatenate([[first], times.ravel(), [last]]))])
    return _quintic(breaks, s, ds, dds)


def _quintic(breaks: FloatArray, s: FloatArray, ds: FloatArray, dds: FloatArray) -> PiecewisePolynomial:
    """Hermite interpolation of value and two derivatives."""
    h = np.diff(breaks)
    s0, v0, a0 = s[:-1], ds[:-1] * h, dds[:-1] * h**2 / 2
    value = s[1:] - s0 - v0 - a0
    slope = ds[1:] * h - v0 - 2 * a0
    bend = dds[1:] * h**2 - 2 * a0
    third = 10 * value - 4 * slope + bend / 2
    fourth = -15 * value + 7 * slope - bend
    fifth = 6 * value - 3 * slope + bend / 2
    coefficients = np.stack([s0, v0, a0, third, fourth, fifth], axis=1) / h[:, None] ** np.arange(6)
    return PiecewisePolynomial(breaks, coefficients[:, :, None])


def needed_slowdown(trajectory: PathTrajectory, limits: JointLimits) -> float:
    """By how much time must be stretched to keep the limits, from the ends and the inside of all pieces of the phase.

    Time stretched by k divides velocity by k, acceleration by k^2 and jerk by k^3.
    """
    pieces = np.arange(len(trajectory.phase.coefficients))
    coarse = _slowdowns(trajectory, limits, pieces, COARSE)
    near = coarse > 0.98 * np.max(coarse)
    return float(np.max(_slowdowns(trajectory, limits, pieces[near], DENSE)))


def _slowdowns(trajectory: PathTrajectory, limits: JointLimits, pieces: IntArray, count: int) -> FloatArray:
    """What each of some pieces of the phase asks for, from `count` points on it, (k,)."""
    begin, end = trajectory.phase.breaks[pieces], trajectory.phase.breaks[pieces + 1]
    times = begin[:, None] + np.linspace(1e-6, 1 - 1e-6, count) * (end - begin)[:, None]
    _, velocity, acceleration, jerk = np.abs(trajectory.derivatives(times.ravel()))
    needed = np.maximum(
        np.max(velocity / limits.velocity, axis=1),
        np.maximum(
            np.sqrt(np.max(acceleration / limits.acceleration, axis=1)), np.cbrt(np.max(jerk / limits.jerk, axis=1))
        ),
    )
    return np.asarray(np.max(needed.reshape(times.shape), axis=1))
