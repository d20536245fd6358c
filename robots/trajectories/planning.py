"""Collision-checked ways in joint space: straight if that is free, else around by sampling."""

from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray, read_only

from .free_space import FreeSpace, IsFree
from .limits import JointLimits
from .shortcuts import shorten

RESOLUTION = 0.03
"""Largest change of any joint between neighbouring checks [rad]."""
MAX_CHECKS = 20_000
SHORTCUTS = 50
REACH = 1.0
"""Longest edge of the sampled trees, in rad over all joints: longer ones are seldom free."""


@dataclass(frozen=True, slots=True)
class PlanResult:
    """Outcome of planning a way.

    Attributes:
        success: Whether a way was found.
        waypoints: With free straight ways between them, start and goal included, (k, n) [rad]; empty without success.
        reason: Why there is none, else empty.
        checks: Postures that were checked.
    """

    success: bool
    waypoints: FloatArray
    reason: str
    checks: int

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "waypoints", read_only(self.waypoints))

    @property
    def straight(self) -> bool:
        """Whether the way goes straight to the goal."""
        return self.success and len(self.waypoints) <= 2


def plan_path(
    start: FloatArray,
    goal: FloatArray,
    limits: JointLimits,
    is_free: IsFree,
    generator: np.random.Generator,
    *,
    resolution: float = RESOLUTION,
    max_checks: int = MAX_CHECKS,
) -> PlanResult:
    """Find a way from posture to posture that touches nothing.

    A joint without position limits is continuous: its goal is taken at the turn nearest to its start, and ways are
    searched within half a turn to both sides of the start.

    Args:
        start: Posture, (n,) [rad].
        goal: Posture, (n,) [rad].
        limits: Of the joints; all of several arms, if they move at once.
        is_free: Whether a posture touches nothing.
        generator: Of the samples; an equal one gives an equal way.
        resolution: Largest change of any joint between neighbouring checks [rad].
        max_checks: Give up when this many postures were checked.

    Returns:
        The way, or why there is none: `start ...` and `goal ...` say which of both is wrong.

    Raises:
        MotionError: The resolution is not positive.
    """
    space = FreeSpace(is_free, resolution)
    start, goal = np.asarray(start, dtype=np.float64), np.asarray(goal, dtype=np.float64)

    def failed(reason: str) -> PlanResult:
        return PlanResult(False, np.empty((0, limits.count)), reason, space.checks)

    for name, q in (("start", start), ("goal", goal)):
        if problem := limits.problem(q):
            return failed(f"{name} {problem}")
    goal = limits.nearest_turn(goal, start)
    for name, q in (("start", start), ("goal", goal)):
        if not space.posture(q):
            return failed(f"{name} is in collision")
    if space.edge(start, goal):
        return PlanResult(True, np.array([start, goal]), "", space.checks)
    from .sampling_planner import sample_way  # OMPL is only loaded when the straight way is blocked

    way = sample_way(
        start,
        goal,
        # Rounding is let pass in start and goal; OMPL would refuse them.
        np.minimum(np.where(np.isinf(limits.lower), start - np.pi, limits.lower), np.minimum(start, goal)),
        np.maximum(np.where(np.isinf(limits.upper), start + np.pi, limits.upper), np.maximum(start, goal)),
        space,
        int(generator.integers(1, 2**31)),
        REACH,
        max_checks - space.checks,
    )
    if way is None:
        return failed(f"no way found with {max_checks} checks; there may be none")
    return PlanResult(True, shorten(way, space, generator, SHORTCUTS), "", space.checks)
