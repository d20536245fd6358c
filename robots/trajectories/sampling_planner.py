"""Ways around obstacles by random sampling: the door to OMPL."""

import threading

import numpy as np
import ompl.base as ob
import ompl.geometric as og
import ompl.util as ou

from robots.pose import FloatArray

from .free_space import FreeSpace

_SEEDING = threading.Lock()
"""OMPL's random numbers begin with one seed for the whole process, so plans take turns."""


class _Motions(ob.MotionValidator):  # type: ignore[misc]
    """Edges checked by our geometry."""

    def __init__(self, information: ob.SpaceInformation, space: FreeSpace, count: int) -> None:
        super().__init__(information)
        self._space, self._count = space, count

    def checkMotion(self, begin: ob.State, end: ob.State) -> bool:  # noqa: N802 (OMPL's name)
        """Whether the straight way between two states is free."""
        return self._space.edge(np.array(begin[0 : self._count]), np.array(end[0 : self._count]))


def sample_way(
    start: FloatArray,
    goal: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    space: FreeSpace,
    seed: int,
    reach: float,
    max_checks: int,
) -> FloatArray | None:
    """Search a way with RRT-Connect (Kuffner and LaValle 2000).

    It stops after a number of checks, not after a time, so that equal seeds give equal ways.

    Args:
        start: Free posture, (n,).
        goal: Free posture, (n,).
        lower: Least values that are sampled, (n,).
        upper: Greatest values that are sampled, (n,).
        space: The geometry.
        seed: Of the samples, 1 to 2^31 - 1.
        reach: Longest edge, Euclidean.
        max_checks: Give up when the geometry has been asked this often.

    Returns:
        Waypoints with free straight ways between them, (k, n), or None if none was found.
    """
    count = start.size
    bounds = ob.RealVectorBounds(count)
    for index in range(count):
        bounds.setLow(index, float(lower[index]))
        bounds.setHigh(index, float(upper[index]))
    real = ob.RealVectorStateSpace(count)
    real.setBounds(bounds)
    information = ob.SpaceInformation(real)
    information.setStateValidityChecker(lambda state: space.posture(np.array(state[0:count])))
    information.setMotionValidator(_Motions(information, space, count))
    information.setup()
    begin, end = real.allocState(), real.allocState()
    begin[0:count], end[0:count] = start.tolist(), goal.tolist()
    problem = ob.ProblemDefinition(information)
    problem.setStartAndGoalStates(begin, end)
    planner = og.RRTConnect(information)
    planner.setRange(reach)
    planner.setProblemDefinition(problem)
    allowed = space.checks + max_checks
    with _SEEDING:
        level = ou.getLogLevel()
        # It reports an error when seeded twice; what it warns of are generators made before, and all are made below.
        ou.setLogLevel(ou.LogLevel.LOG_NONE)
        try:
            ou.RNG.setSeed(seed)
            planner.setup()
            planner.solve(ob.PlannerTerminationCondition(lambda: space.checks >= allowed))
        finally:
            ou.setLogLevel(level)
    if not problem.hasExactSolution():
        return None
    way = np.array([state[0:count] for state in problem.getSolutionPath().getStates()])
    way[0], way[-1] = start, goal
    return way
