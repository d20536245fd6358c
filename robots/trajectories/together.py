"""Several arms at once: one motion in the space of all their joints, so that they never touch each other."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .errors import MotionError
from .limits import JointLimits
from .motion import CORNER, MotionPlan, plan_motion
from .path_trajectory import PathTrajectory
from .piecewise import PiecewisePolynomial
from .planning import MAX_CHECKS, RESOLUTION

AreFree = Callable[[list[FloatArray]], bool]
"""Whether the arms at these postures, one (n_i,) each, touch nothing and not each other."""


@dataclass(frozen=True, slots=True)
class JointMotion:
    """Motion of several arms that begin and arrive together.

    Attributes:
        plan: In the space of all joints.
        trajectories: One of each arm, all of the same duration; empty without success.
    """

    plan: MotionPlan
    trajectories: tuple[PathTrajectory, ...]

    @property
    def success(self) -> bool:
        """Whether there is a motion."""
        return self.plan.success

    @property
    def reason(self) -> str:
        """Why there is none, else empty."""
        return self.plan.reason


def plan_together(
    starts: Sequence[FloatArray],
    goals: Sequence[FloatArray],
    limits: Sequence[JointLimits],
    are_free: AreFree,
    generator: np.random.Generator,
    *,
    corner: float = CORNER,
    resolution: float = RESOLUTION,
    max_checks: int = MAX_CHECKS,
    are_clear: AreFree | None = None,
) -> JointMotion:
    """Plan a motion of several arms at once; the arguments are those of `plan_motion`, one of each arm.

    Raises:
        MotionError: The numbers of arms or joints differ, or a setting is not positive.
    """
    if not len(starts) == len(goals) == len(limits) or not limits:
        raise MotionError(
            f"starts, goals and limits must be of as many arms; got {len(starts)}, {len(goals)}, {len(limits)}"
        )
    for name, postures in (("start", starts), ("goal", goals)):
        for arm, (q, bound) in enumerate(zip(postures, limits, strict=True)):
            if np.shape(q) != (bound.count,):
                raise MotionError(f"the {name} of arm {arm} has shape {np.shape(q)}, allowed ({bound.count},)")
    ends = np.cumsum([bound.count for bound in limits])[:-1]
    plan = plan_motion(
        np.concatenate(starts),
        np.concatenate(goals),
        JointLimits.stacked(limits),
        lambda q: are_free(np.split(q, ends)),
        generator,
        corner=corner,
        resolution=resolution,
        max_checks=max_checks,
        is_clear=None if are_clear is None else lambda q: are_clear(np.split(q, ends)),
    )
    if plan.trajectory is None:
        return JointMotion(plan, ())
    path, phase = plan.trajectory.path, plan.trajectory.phase
    parts = np.split(path.coefficients, ends, axis=2)
    return JointMotion(plan, tuple(PathTrajectory(PiecewisePolynomial(path.breaks, part), phase) for part in parts))
