"""Where along a path its speed is decided: knots, the quadratic B-splines on them, and the points of checking."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .limits import JointLimits
from .piecewise import IntArray, PiecewisePolynomial

GROWTH = 1.7
"""Ratio of neighbouring intervals on a straight piece: its ends, where speed changes, are divided finer."""
LONG_PARTS = 7
"""The coarsest intervals are this part of a long straight piece."""
OUTER_PARTS = 5
"""The first and last piece have at least this many: the laws at rest need neighbours."""
AT = np.array([0.0, 0.5, 1.0])
"""Where each interval is checked; what jumps at a knot is taken from its inside."""
REST_AT = np.array([0.5, 1.0])
"""Where the intervals at rest are checked, from the outer end: jerk is constant, acceleration and speed grow."""
SIMPSON = np.array([1.0, 4.0, 1.0]) / 6


@dataclass(frozen=True, slots=True)
class SpeedGrid:
    """The squared speed b(s) = s'^2 as a linear function of its coefficients, at the points of checking.

    At rest at both ends: with constant jerk from rest s = j t^3 / 6, so b grows with s^(4/3) on the first interval
    and falls likewise on the last; between them b is a quadratic B-spline, so that acceleration s'' = b' / 2 is
    continuous and jerk s''' = b'' s' / 2 bounded.

    Attributes:
        knots: (m + 1,), beginning and end of the path included.
        points: Where limits are checked, (k,).
        piece: Piece of the path of each point, (k,).
        columns: The three coefficients that each point depends on, (k, 3).
        rows: What b, b', b'' at each point take from these, (k, 3, 3): [point, derivative, coefficient].
        weights: The motion takes the sum of weights / sqrt(b) over the points, (k,).
        count: Number of coefficients.
    """

    knots: FloatArray
    points: FloatArray
    piece: IntArray
    columns: IntArray
    rows: FloatArray
    weights: FloatArray
    count: int


def lay_grid(path: PiecewisePolynomial, limits: JointLimits, parts: int) -> SpeedGrid:
    """Lay the grid over a path that begins and ends at rest; a curved piece is divided into `parts` intervals."""
    knots, piece = _divide(path, limits, parts)
    sizes = np.diff(knots)
    intervals = np.arange(1, sizes.size - 1)
    points = knots[intervals, None] + AT * sizes[intervals, None]
    rows = _quadratic_splines(knots, points)
    # The outermost splines c0 follow from their neighbours c1: at the inner end of the law at rest b' = 4/3 b / h0,
    # where b = c0 and b' = 2 (c1 - c0) / h1. Every row is expressed in the others.
    begin, end = 1 + 2 / 3 * sizes[1] / sizes[0], 1 + 2 / 3 * sizes[-2] / sizes[-1]
    rows[0, :, :, 1] += rows[0, :, :, 0] / begin
    rows[-1, :, :, 1] += rows[-1, :, :, 2] / end
    # What is left at the ends has two coefficients only; shifted, so that the three columns stay inside.
    rows[0, :, :, :2], rows[0, :, :, 2] = rows[0, :, :, 1:].copy(), 0.0
    rows[-1, :, :, 1:], rows[-1, :, :, 0] = rows[-1, :, :, :2].copy(), 0.0
    columns = np.clip(intervals - 2, 0, sizes.size - 4 - 1)[:, None] + np.arange(3)
    first, last = _law_at_rest(sizes[0]) / begin, _law_at_rest(sizes[-1]) / end
    last[:, 1] *= -1
    rows_first, rows_last = np.zeros((2, 3, 3)), np.zeros((2, 3, 3))
    rows_first[:, :, 0], rows_last[:, :, 2] = first, last
    return SpeedGrid(
        knots=knots,
        points=np.concatenate([knots[0] + REST_AT * sizes[0], points.ravel(), knots[-1] - REST_AT * sizes[-1]]),
        piece=np.concatenate([[piece[0]] * 2, np.repeat(piece[1:-1], AT.size), [piece[-1]] * 2]),
        columns=np.concatenate([columns[:1]] * 2 + [np.repeat(columns, AT.size, axis=0)] + [columns[-1:]] * 2),
        rows=np.concatenate([rows_first, rows.reshape(-1, 3, 3), rows_last]),
        # The law at rest takes 3 h / sqrt(b at its inner end).
        weights=np.concatenate(
            [[0.0, 3 * sizes[0]], np.outer(sizes[intervals], SIMPSON).ravel(), [0.0, 3 * sizes[-1]]]
        ),
        count=sizes.size - 2,
    )


def _law_at_rest(size: float) -> FloatArray:
    """b, b', b'' of (s / size)^(4/3) at `REST_AT`, (2, 3)."""
    u = REST_AT
    return np.stack([u ** (4 / 3), 4 / 3 * u ** (1 / 3) / size, 4 / 9 * u ** (-2 / 3) / size**2], axis=1)


def _quadratic_splines(knots: FloatArray, points: FloatArray) -> FloatArray:
    """The three B-splines of each inner interval at its points, (m - 2, 3, 3, 3): [interval, point, derivative, .]."""
    extended = np.concatenate([knots[1:2], knots[1:-1], knots[-2:-1]])
    t0, t1, t2, t3 = (extended[shift : extended.size - 3 + shift, None] for shift in range(4))
    a, c = 1 / ((t2 - t0) * (t2 - t1)), 1 / ((t3 - t1) * (t2 - t1))
    left, right = t2 - points, points - t1
    result = np.empty((*points.shape, 3, 3))
    result[..., 0, 0], result[..., 1, 0], result[..., 2, 0] = a * left**2, -2 * a * left, 2 * a
    result[..., 0, 2], result[..., 1, 2], result[..., 2, 2] = c * right**2, 2 * c * right, 2 * c
    result[..., 0, 1] = 1 - result[..., 0, 0] - result[..., 0, 2]
    result[..., 1:, 1] = -result[..., 1:, 0] - result[..., 1:, 2]
    return result


def _divide(path: PiecewisePolynomial, limits: JointLimits, parts: int) -> tuple[FloatArray, IntArray]:
    """Knots, (m + 1,), and the piece of the path in which each interval lies, (m,)."""
    sizes = np.diff(path.breaks)
    straight = ~np.any(path.coefficients[:, 2:] != 0, axis=(1, 2))
    first, last = (_reach_of_jerk(tangent, limits) for tangent in path.derivatives(path.breaks[[0, -1]])[1])
    # A straight piece begins as fine as the curve beside it ends.
    begins = np.concatenate([[first], sizes[:-1] / parts])
    ends = np.concatenate([sizes[1:] / parts, [last]])
    knots, piece = [path.breaks[:1]], []
    for index, size in enumerate(sizes):
        outer = index in (0, sizes.size - 1)
        if straight[index] or sizes.size == 1:
            inner = _graded(size, begins[index], ends[index], OUTER_PARTS if outer else 1)
        elif outer:
            inner = _graded(size, min(begins[index], size / parts), min(ends[index], size / parts), OUTER_PARTS)
        else:
            inner = np.linspace(0, size, parts + 1)
        knots.append(path.breaks[index] + inner[1:])
        piece.append(np.full(inner.size - 1, index))
    return np.concatenate(knots), np.concatenate(piece)


def _reach_of_jerk(tangent: FloatArray, limits: JointLimits) -> float:
    """How far jerk at its limit goes from rest until acceleration is at its limit: a^3 / 6 j^2."""
    speed = np.abs(tangent)
    if not np.any(speed > 0):
        return np.inf
    acceleration = np.min(limits.acceleration[speed > 0] / speed[speed > 0])
    jerk = np.min(limits.jerk[speed > 0] / speed[speed > 0])
    return float(acceleration**3 / (6 * jerk**2))


def _graded(size: float, first: float, last: float, least: int) -> FloatArray:
    """Division of [0, size] into `least` or more, growing from about `first` and about `last` inwards."""
    coarse = max(size / LONG_PARTS, min(first, last))
    if size < 3 * coarse:
        return np.linspace(0, size, max(least, round(size / coarse)) + 1)
    sides = []
    for step in (first, last):
        steps = [min(max(step, 1e-4 * size), coarse)]
        while steps[-1] * GROWTH < coarse:
            steps.append(steps[-1] * GROWTH)
        sides.append(steps)
    middle = size - sum(sides[0]) - sum(sides[1])
    whole = sides[0] + [coarse] * max(0, round(middle / coarse)) + sides[1][::-1]
    ends = np.concatenate([[0.0], np.cumsum(whole)])
    return np.asarray(ends * (size / ends[-1]))
