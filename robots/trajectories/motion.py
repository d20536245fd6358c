"""Way and trajectory in one: a collision-checked motion from posture to posture."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .free_space import FreeSpace, IsFree
from .limits import JointLimits
from .path_trajectory import PathTrajectory, parametrize
from .paths import blended_polyline, without_repetitions
from .piecewise import PiecewisePolynomial
from .planning import MAX_CHECKS, RESOLUTION, PlanResult, plan_path

CORNER = 0.1
"""How far any joint may leave the waypoints' polyline at a corner [rad]."""
FINER = 3
"""The whole path is checked at last in steps of the resolution over this."""
ATTEMPTS = (1, 1, 3, 3, 9)
"""Ways that graze something are sought anew, in steps of the resolution over these."""
HALVINGS = 6
"""A rounded corner that touches something is made smaller this often."""


@dataclass(frozen=True, slots=True)
class MotionPlan:
    """Outcome of planning a motion.

    Attributes:
        success: Whether there is one.
        reason: Why not, else empty.
        way: The waypoints that were found.
        checks: Postures that were checked in all.
        trajectory: Of the joints, if successful.
    """

    success: bool
    reason: str
    way: PlanResult
    checks: int
    trajectory: PathTrajectory | None = None


def plan_motion(
    start: FloatArray,
    goal: FloatArray,
    limits: JointLimits,
    is_free: IsFree,
    generator: np.random.Generator,
    *,
    corner: float = CORNER,
    resolution: float = RESOLUTION,
    max_checks: int = MAX_CHECKS,
    is_clear: IsFree | None = None,
) -> MotionPlan:
    """Find a free way as `plan_path` does, round its corners where that is free too, and follow it in time.

    Short ways pass the edges of obstacles closely, and between two checks may cut them. So the whole path is checked
    again at last, in finer steps, and another is sought if it grazes something. Best is an `is_free` that keeps a
    clearance of some millimetres and an `is_clear` that does not.

    Args:
        start: Posture, (n,) [rad].
        goal: Posture, (n,) [rad].
        limits: Of the joints; all of several arms, if they move at once.
        is_free: Whether a posture touches nothing.
        generator: Of the samples; an equal one gives an equal motion.
        corner: How far any joint may leave the waypoints' polyline at a corner [rad].
        resolution: Largest change of any joint between neighbouring checks while searching [rad].
        max_checks: Give up when this many postures were checked in one search.
        is_clear: Asked in the last check, in place of `is_free`.

    Raises:
        MotionError: `corner` or the resolution is not positive.
    """
    reason, checks = "", 0
    for divisor in ATTEMPTS:
        step = resolution / divisor
        way = plan_path(start, goal, limits, is_free, generator, resolution=step, max_checks=max_checks)
        checks += way.checks
        if not way.success:
            return MotionPlan(False, way.reason, way, checks)
        space, last = FreeSpace(is_free, step / FINER), FreeSpace(is_clear or is_free, step / FINER)
        path, blocked = round_corners(without_repetitions(way.waypoints), limits, space, corner)
        pieces = range(len(path.coefficients))
        clear = not blocked and all(last.path(_piece_points(path, piece, last.resolution)) for piece in pieces)
        checks += space.checks + last.checks
        if clear:
            return MotionPlan(True, "", way, checks, parametrize(path, limits))
        reason = f"the ways found graze an obstacle, the last at {f'waypoint {blocked}' if blocked else 'an edge'}"
    return MotionPlan(False, reason, way, checks)


def round_corners(
    waypoints: FloatArray, limits: JointLimits, space: FreeSpace, corner: float
) -> tuple[PiecewisePolynomial, int]:
    """Round each corner by `corner` [rad] or by as much less as is free.

    Returns:
        The path, and the waypoint where even the smallest rounding touches something, or 0.
    """
    shrink = np.ones(len(waypoints))
    path = blended_polyline(waypoints, limits, corner)
    for index in range(1, len(waypoints) - 1):
        # A blend depends on its own corner only, so that those checked before stay free.
        for _ in range(HALVINGS + 1):
            if space.path(_piece_points(path, 2 * index - 1, space.resolution)):
                break
            shrink[index] /= 2
            path = blended_polyline(waypoints, limits, corner, shrink)
        else:
            return path, index
    return path, 0


def _piece_points(path: PiecewisePolynomial, piece: int, resolution: float) -> FloatArray:
    """Postures on one piece, no joint of which moves further than the resolution between them, (k, n)."""
    begin, end = path.breaks[piece], path.breaks[piece + 1]
    # On a blend the tangent is a mean of those at its ends.
    fastest = np.max(np.abs(path.derivatives(np.array([begin, end]), np.array([piece, piece]))[1]))
    count = int(np.ceil((end - begin) * fastest / resolution)) + 1
    return np.asarray(path.derivatives(np.linspace(begin, end, count + 1))[0])
