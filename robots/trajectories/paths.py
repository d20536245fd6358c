"""Smooth paths q(s) from waypoints: a polyline with rounded corners, or a spline through dense points."""

import math

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from robots.pose import FloatArray

from .errors import MotionError
from .limits import JointLimits
from .piecewise import PiecewisePolynomial

SAME = 1e-9
"""Waypoints nearer to each other than this [rad] are one."""
ROOM = 0.475
"""Greatest half of a blend over the shorter straight beside it: less than a half, so that no sliver is left between."""


def blended_polyline(
    waypoints: FloatArray, limits: JointLimits, corner: float, shrink: FloatArray | None = None
) -> PiecewisePolynomial:
    """Round the corners of a polyline so that it can be followed without stopping.

    The parameter s is the time [s] that the polyline takes at the speed limit, so that |q'| stays within the velocity
    limits for s' = 1 on the blends too. A blend runs from l before the corner to l behind it with
    q' = d1 + (d2 - d1)(3 u^2 - 2 u^3), u = (s + l) / 2 l, where d1 and d2 are the directions before and behind:
    q'' is continuous and zero at its ends, the curve stays inside the triangle of its ends and the corner (so inside
    any position limits that hold the waypoints), and it passes the corner at a distance of 3/16 l |d2 - d1|.

    Args:
        waypoints: Postures, (k, n) [rad]; repeated ones are taken as one.
        limits: Of the joints.
        corner: How far any joint may leave the polyline at a corner [rad].
        shrink: Factors on `corner` for each waypoint, (k,), e.g. where a blend touches something.

    Raises:
        MotionError: There is no waypoint, one is not finite or out of limits, or `corner` is not positive.
    """
    if not corner > 0:
        raise MotionError(f"the corner deviation must be positive; got {corner} rad")
    waypoints = np.atleast_2d(np.asarray(waypoints, dtype=np.float64))
    if not waypoints.size:
        raise MotionError("a path needs at least one waypoint; got none")
    for index, waypoint in enumerate(waypoints):
        limits.check_inside(f"waypoint {index}", waypoint)
    corners = np.full(len(waypoints), corner) if shrink is None else corner * np.asarray(shrink, dtype=np.float64)
    kept = _distinct(waypoints)
    points, corners = waypoints[kept], corners[kept]
    if len(points) == 1:
        return PiecewisePolynomial(np.zeros(2), points[:, None, :])
    steps = np.diff(points, axis=0)
    lengths = np.max(np.abs(steps) / limits.velocity, axis=1)
    directions = steps / lengths[:, None]
    turns = np.diff(directions, axis=0)
    bends = np.max(np.abs(turns), axis=1)
    room = ROOM * np.minimum(lengths[:-1], lengths[1:])
    halves = np.minimum(room, 16 / 3 * corners[1:-1] / np.maximum(bends, 1e-12))
    return _assemble(points, directions, lengths, turns, halves)


def _assemble(
    points: FloatArray, directions: FloatArray, lengths: FloatArray, turns: FloatArray, halves: FloatArray
) -> PiecewisePolynomial:
    """Straight and curved pieces in turn: piece 2 k - 1 rounds point k."""
    margins = np.concatenate([[0.0], halves, [0.0]])
    count = points.shape[1]
    pieces = np.zeros((2 * len(directions) - 1, 5, count))
    pieces[::2, 0] = points[:-1] + margins[:-1, None] * directions
    pieces[::2, 1] = directions
    # The integral of d1 + turn (3 u^2 - 2 u^3) with x = whole u.
    whole = 2 * halves[:, None]
    pieces[1::2, 0] = points[1:-1] - halves[:, None] * directions[:-1]
    pieces[1::2, 1] = directions[:-1]
    pieces[1::2, 3] = turns / whole**2
    pieces[1::2, 4] = -turns / (2 * whole**3)
    sizes = np.empty(len(pieces))
    sizes[::2] = lengths - margins[:-1] - margins[1:]
    sizes[1::2] = 2 * halves
    return PiecewisePolynomial(np.concatenate([[0.0], np.cumsum(sizes)]), pieces)


def without_repetitions(waypoints: FloatArray) -> FloatArray:
    """The waypoints, (k, n), without those that equal the one before."""
    return waypoints[_distinct(waypoints)]


def _distinct(waypoints: FloatArray) -> NDArray[np.bool_]:
    return np.append(True, np.max(np.abs(np.diff(waypoints, axis=0)), axis=1, initial=0.0) > SAME)


def spline_through(parameters: FloatArray, points: FloatArray) -> PiecewisePolynomial:
    """The quintic spline through dense points, four times continuously differentiable.

    Args:
        parameters: Increasing, (k,), at least six.
        points: (k, n).
    """
    spline = make_interp_spline(parameters, points, k=5)
    breaks = np.unique(spline.t)  # the spline's end knots are repeated
    # SciPy's own conversion to pieces takes one column only.
    taylor = [spline(breaks[:-1], nu=order) / math.factorial(order) for order in range(6)]
    return PiecewisePolynomial(breaks, np.stack(taylor, axis=1))
