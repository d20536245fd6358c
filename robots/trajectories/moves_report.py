"""Many random moves, and how near they come to the limits: the slow suite's measure."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .errors import MotionError
from .free_space import IsFree
from .limits import JointLimits
from .motion import plan_motion
from .trajectory import LimitReport, check_limits

PERIOD = 0.001
"""Period of the samples that are compared with the limits [s]."""
CLEAR_PERIOD = 0.01
"""Period of the samples that are checked for collision [s]."""
MAX_DRAWS = 1000


@dataclass(frozen=True, slots=True)
class MovesReport:
    """What many moves did.

    Attributes:
        moves: How many were planned successfully.
        around: How many of them had to go around something.
        worst: Largest part used of each limit over all moves.
        touching: Sampled postures that touched something, over all moves.
        failures: Why the other moves were not planned.
    """

    moves: int
    around: int
    worst: LimitReport
    touching: int
    failures: tuple[str, ...]


def random_moves(
    limits: JointLimits,
    is_free: IsFree,
    count: int,
    generator: np.random.Generator,
    home: FloatArray,
    is_clear: IsFree | None = None,
) -> MovesReport:
    """Plan moves between random free postures, each from where the one before ended, and measure them.

    Args:
        limits: Of the joints.
        is_free: Whether a posture touches nothing.
        count: How many moves.
        generator: Of postures and plans.
        home: Where the first begins, (n,); continuous joints take goals within half a turn of it.
        is_clear: As in `plan_motion`; the sampled postures are measured with it. `is_free` if not given.

    Raises:
        MotionError: No free posture is found.
    """
    lower = np.where(np.isinf(limits.lower), home - np.pi, limits.lower)
    upper = np.where(np.isinf(limits.upper), home + np.pi, limits.upper)
    at, worst, around, touching, failures = np.asarray(home, dtype=np.float64), np.zeros(4), 0, 0, []
    for _ in range(count):
        goal = _free_posture(lower, upper, is_free, generator)
        plan = plan_motion(at, goal, limits, is_free, generator, is_clear=is_clear)
        if plan.trajectory is None:
            failures.append(plan.reason)
            continue
        report = check_limits(plan.trajectory, limits, PERIOD)
        worst = np.maximum(worst, [report.position, report.velocity, report.acceleration, report.jerk])
        around += not plan.way.straight
        touching += sum(not (is_clear or is_free)(q) for q in plan.trajectory.sample(CLEAR_PERIOD).position)
        at = plan.way.waypoints[-1]
    return MovesReport(count - len(failures), around, LimitReport(*worst.tolist()), touching, tuple(failures))


def _free_posture(lower: FloatArray, upper: FloatArray, is_free: IsFree, generator: np.random.Generator) -> FloatArray:
    for _ in range(MAX_DRAWS):
        if is_free(q := generator.uniform(lower, upper)):
            return q
    raise MotionError(f"none of {MAX_DRAWS} random postures is free")
