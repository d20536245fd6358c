"""The fastest speed along a path within velocity, acceleration and jerk limits: an interior-point method.

With b(s) = s'^2, the derivatives along the path are s'' = b' / 2 and s''' = b'' sqrt(b) / 2, so the limits are

    |q'| sqrt(b) <= v,   |q'' b + q' b' / 2| <= a,   |q''' b + 3/2 q'' b' + q' b'' / 2| <= j / sqrt(b)

(Debrouwere et al. 2013, Time-optimal path following for robots with convex-concave constraints using sequential convex
programming, IEEE Trans. Robotics 29(6)). All but the last are convex in b; the right-hand side of the last is convex,
and its tangent at the present b lies below it, so that Newton steps with the tangent in its place stay inside the
true limits. The time, the integral of 1 / sqrt(b), is convex. The method is the primal-dual one of Boyd and
Vandenberghe (2004), Convex Optimization, section 11.7, begun inside the limits and never leaving them.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from robots.pose import FloatArray, read_only

from .limits import JointLimits
from .piecewise import PiecewisePolynomial
from .speed_grid import SpeedGrid

MAX_STEPS = 40
GAP = 0.02
"""Stop when no more than this part of the time can be won (the duality gap)."""
BACK = 0.95
"""Part of the way to the nearest limit that one step may go."""
_UPPER = (np.array([0, 0, 0, 1, 1, 2]), np.array([0, 1, 2, 1, 2, 2]))


@dataclass(frozen=True, slots=True)
class SpeedProfile:
    """Squared speed at the points of a grid.

    Attributes:
        square: b, b', b'', (k, 3).
        success: Whether the gap was closed; otherwise the profile is within the limits, but slower than need be.
        iterations: Newton steps taken.
    """

    square: FloatArray
    success: bool
    iterations: int

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "square", read_only(self.square))


def fastest_profile(path: PiecewisePolynomial, limits: JointLimits, grid: SpeedGrid) -> SpeedProfile:
    """Minimize the time that the path takes from rest to rest."""
    problem = _Problem(path, limits, grid)
    c = problem.first_guess()
    z = problem.state(c)
    slack = problem.slacks(z)
    weight = problem.time(z) / slack.size
    dual, floor = weight / slack, weight / c
    for iteration in range(1, MAX_STEPS + 1):
        try:
            step = problem.newton_step(z, slack, dual, weight, c, floor)
        except LinAlgError:
            step = np.full(c.size, np.nan)
        if not np.all(np.isfinite(step)):
            # The Hessian is no longer positive for rounding: nothing more can be won.
            return SpeedProfile(z, False, iteration)
        change = problem.state(step)
        slack_change = problem.slack_changes(z, change)
        dual_change = (weight - dual * slack_change) / slack - dual
        floor_change = (weight - floor * step) / c - floor
        length = min(_room(slack, slack_change), _room(c, step))
        dual_length = min(_room(dual, dual_change), _room(floor, floor_change))
        # The tangent keeps the true slack above the linear one, so that this holds at once but for rounding.
        while np.min(new := problem.slacks(problem.state(c + length * step))) <= 0:
            length *= 0.7
            if length < 1e-9:
                return SpeedProfile(z, False, iteration)
        c = c + length * step
        z, slack = problem.state(c), new
        dual, floor = dual + dual_length * dual_change, floor + dual_length * floor_change
        gap = float(np.sum(dual * slack))
        if gap < GAP * problem.time(z) and length > 0.1:
            return SpeedProfile(z, True, iteration)
        shortest = min(length, dual_length)
        weight = gap / slack.size * (0.2 if shortest > 0.5 else 0.5 if shortest > 0.2 else 1.0)
    return SpeedProfile(z, False, MAX_STEPS)


def _room(values: FloatArray, change: FloatArray) -> float:
    """How much of the change keeps the positive values positive, at most 1."""
    shrinking = change < 0
    return min(1.0, BACK * float(np.min(-values[shrinking] / change[shrinking], initial=np.inf)))


class _Problem:
    """Limits and time of one path on its grid, as functions of z = (b, b', b'') at the points."""

    def __init__(self, path: PiecewisePolynomial, limits: JointLimits, grid: SpeedGrid) -> None:
        _, first, second, third = path.derivatives(grid.points, grid.piece)
        self._grid, self._joints = grid, limits.count
        with np.errstate(divide="ignore"):
            self._fastest = np.minimum(np.min((limits.velocity / np.abs(first)) ** 2, axis=1), 1e12)
            self._bend = np.min(
                np.minimum(limits.acceleration / np.abs(second), (limits.jerk / np.abs(third)) ** (2 / 3)), axis=1
            )
            self._slope = np.minimum(np.min(limits.acceleration / np.abs(first), axis=1), 1e12)
        # What one unit of b, b', b'' uses of the acceleration and jerk limits, (k, 3, n).
        self._acceleration = np.stack([second, first / 2, np.zeros_like(first)], axis=1) / limits.acceleration
        self._jerk = np.stack([third, 1.5 * second, first / 2], axis=1) / limits.jerk
        low, high = grid.columns[:, _UPPER[0]], grid.columns[:, _UPPER[1]]
        self._band = ((2 + low - high) * grid.count + high).ravel()

    def state(self, c: FloatArray) -> FloatArray:
        """State z at the points for coefficients (count,), (k, 3)."""
        return np.asarray(np.matmul(self._grid.rows, c[self._grid.columns][:, :, None])[:, :, 0])

    def time(self, z: FloatArray) -> float:
        """Duration [s]."""
        return float(np.sum(self._grid.weights / np.sqrt(z[:, 0])))

    def slacks(self, z: FloatArray) -> FloatArray:
        """What is left of the limits, (k, 1 + 4 n): speed, acceleration up and down, jerk up and down."""
        if np.min(z[:, 0]) <= 0:
            return np.full((1, 1), -1.0)
        used, jerk = _rows(z, self._acceleration), _rows(z, self._jerk)
        allowed = 1 / np.sqrt(z[:, :1])
        speed = 1 - z[:, :1] / self._fastest[:, None]
        return np.concatenate([speed, 1 - used, 1 + used, allowed - jerk, allowed + jerk], axis=1)

    def slack_changes(self, z: FloatArray, change: FloatArray) -> FloatArray:
        """Their derivative along a change of z."""
        used, jerk = _rows(change, self._acceleration), _rows(change, self._jerk)
        allowed = -0.5 * z[:, :1] ** -1.5 * change[:, :1]
        speed = -change[:, :1] / self._fastest[:, None]
        return np.concatenate([speed, -used, used, allowed - jerk, allowed + jerk], axis=1)

    def first_guess(self) -> FloatArray:
        """Coefficients of a profile inside the limits: bounded growth up to what the bends allow, then slowed down."""
        grid = self._grid
        start, end = grid.knots[0], grid.knots[-1]
        b = np.minimum(self._fastest, self._bend)
        b = np.minimum(b, self._slope * np.minimum(grid.points - start, end - grid.points))
        order = np.argsort(grid.points, kind="stable")
        b, slope, steps = b[order].tolist(), self._slope[order].tolist(), np.diff(grid.points[order]).tolist()
        for index, step in enumerate(steps):
            b[index + 1] = min(b[index + 1], b[index] + slope[index + 1] * step)
        for index in range(len(steps) - 1, -1, -1):
            b[index] = min(b[index], b[index + 1] + slope[index] * steps[index])
        inner = grid.knots[1:-1]
        c = np.interp((inner[:-1] + inner[1:]) / 2, grid.points[order], b)[: grid.count]
        for _ in range(2):
            c[1:-1] = 4 / (1 / c[:-2] + 2 / c[1:-1] + 1 / c[2:])
        z = self.state(c)
        used = np.max(np.abs(_rows(z, self._acceleration))), np.max(z[:, 0] / self._fastest)
        jerk = np.max(np.abs(_rows(z, self._jerk)) * np.sqrt(z[:, :1]))
        # Speed and acceleration grow with b, jerk with b^(3/2); half of it keeps away from the limits.
        return np.asarray(c * 0.5 / max(*used, jerk ** (2 / 3)))

    def newton_step(
        self, z: FloatArray, slack: FloatArray, dual: FloatArray, weight: float, c: FloatArray, floor: FloatArray
    ) -> FloatArray:
        """Change of the coefficients that solves the linearized optimality conditions, (count,).

        The coefficients themselves are kept positive, with duals `floor`: then b is positive between the points too.
        """
        n, grid = self._joints, self._grid
        b = z[:, 0]
        allowed = -0.5 * b**-1.5  # derivative of 1 / sqrt(b)
        pull, curve = weight / slack, dual / slack
        up, down = slice(1 + 2 * n, 1 + 3 * n), slice(1 + 3 * n, None)
        gradient = _columns(self._acceleration, pull[:, 1 : 1 + n] - pull[:, 1 + n : 1 + 2 * n])
        gradient += _columns(self._jerk, pull[:, up] - pull[:, down])
        gradient[:, 0] += grid.weights * allowed + pull[:, 0] / self._fastest - allowed * pull[:, 1 + 2 * n :].sum(1)
        curve_acceleration = curve[:, 1 : 1 + n] + curve[:, 1 + n : 1 + 2 * n]
        curve_jerk = curve[:, up] + curve[:, down]
        hessian = np.matmul(self._acceleration * curve_acceleration[:, None, :], self._acceleration.transpose(0, 2, 1))
        hessian += np.matmul(self._jerk * curve_jerk[:, None, :], self._jerk.transpose(0, 2, 1))
        hessian[:, 0, 0] += (
            grid.weights * 0.75 * b**-2.5 + curve[:, 0] / self._fastest**2 + allowed**2 * curve_jerk.sum(1)
        )
        cross = allowed[:, None] * _columns(self._jerk, curve[:, down] - curve[:, up])
        hessian[:, 0, :] += cross
        hessian[:, :, 0] += cross
        return self._solve(gradient, hessian, -weight / c, floor / c)

    def _solve(
        self, gradient: FloatArray, hessian: FloatArray, own_gradient: FloatArray, own_hessian: FloatArray
    ) -> FloatArray:
        """From the points to the coefficients, and solve; the matrix has two diagonals beside the middle one."""
        grid = self._grid
        from_points = np.bincount(grid.columns.ravel(), np.matmul(gradient[:, None, :], grid.rows).ravel(), grid.count)
        right = own_gradient + from_points
        local = np.matmul(grid.rows.transpose(0, 2, 1), np.matmul(hessian, grid.rows))
        band = np.bincount(self._band, local[:, _UPPER[0], _UPPER[1]].ravel(), 3 * grid.count)
        band = band.reshape(3, grid.count)
        band[2] += own_hessian
        # Near rest b is tiny and the Hessian huge: scaled to a unit diagonal.
        scale = 1 / np.sqrt(band[2])
        band *= scale
        band[1, 1:] *= scale[:-1]
        band[0, 2:] *= scale[:-2]
        band[2] = 1 + 1e-12
        return np.asarray(-scale * solveh_banded(band, right * scale, check_finite=False))


def _rows(z: FloatArray, matrices: FloatArray) -> FloatArray:
    """Vectors z (k, 3) times matrices (k, 3, n), (k, n)."""
    return np.asarray(np.matmul(z[:, None, :], matrices)[:, 0])


def _columns(matrices: FloatArray, weights: FloatArray) -> FloatArray:
    """Matrices (k, 3, n) times weights (k, n), (k, 3)."""
    return np.asarray(np.matmul(matrices, weights[:, :, None])[:, :, 0])
