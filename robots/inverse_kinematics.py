"""Inverse kinematics of an arm: poses, positions and parts of poses, inside joint limits, with restarts."""

from dataclasses import replace

import numpy as np

from .errors import RobotError
from .ik_kernel import pose_numbers
from .ik_mask import TaskMask
from .ik_posture import pull_towards
from .ik_problem import Found, IkProblem
from .ik_result import IkResult
from .ik_starts import PoseTable
from .kinematics import Kinematics
from .pose import FloatArray, Pose

__all__ = ["MAX_RESTARTS", "IkResult", "IkSolver", "TaskMask"]

MAX_RESTARTS = 20
REACH_RESTARTS = 4
"""Restarts with which a failure is looked into: does the position alone work?"""
_NO_TURN = np.array([0.0, 0.0, 0.0, 1.0])


class IkSolver:
    """Inverse kinematics of one chain, in its base frame.

    Starts come from a table of postures, made at the first question; each is followed by damped least squares with
    active joint limits (see `ik_kernel`) and given up as soon as it stalls. Equal questions get equal answers. The
    first question on a machine waits some seconds until Numba has compiled the kernel, which is then kept on disk.

    Args:
        kinematics: The chain.
        lower: Lower joint limits, (n,) [rad or m]; -inf (and inf above) where a joint turns for ever.
        upper: Upper joint limits, (n,).
        home: Home posture, (n,).

    Raises:
        RobotError: A joint of the chain has more than one degree of freedom.
    """

    def __init__(self, kinematics: Kinematics, lower: FloatArray, upper: FloatArray, home: FloatArray) -> None:
        self._chain = kinematics.chain()
        self._bounds = np.array([lower, upper], dtype=float)
        self._home = np.array(home, dtype=float)
        self._endless = ~np.isfinite(self._bounds).any(axis=0)
        self._turns_for_ever = bool(self._endless.any())
        self._table: PoseTable | None = None

    def with_kinematics(self, kinematics: Kinematics) -> "IkSolver":
        """The same solver, its table included, for another copy of the same chain."""
        other = IkSolver(kinematics, self._bounds[0], self._bounds[1], self._home)
        other._table = self._table
        return other

    def solve(
        self,
        target: Pose | FloatArray,
        start: FloatArray | None = None,
        posture: FloatArray | None = None,
        mask: TaskMask | None = None,
        position_tolerance: float = 1e-5,
        orientation_tolerance: float = 1e-4,
        max_restarts: int = MAX_RESTARTS,
    ) -> IkResult:
        """Find a posture that brings the tool to a target.

        Args:
            target: Wanted tool pose in the base frame, or its position alone, (3,) [m].
            start: Posture to start from and to stay near to, (n,) [rad or m]; None starts at a known posture near the
                target.
            posture: Posture that the freedom left by the task is used to come near to, (n,); also the start where none
                is given.
            mask: Which axes count; None takes all six of a pose, or the position.
            position_tolerance: Accepted distance [m].
            orientation_tolerance: Accepted angle [rad].
            max_restarts: How many starts may follow the first one.

        Returns:
            A posture inside the limits that meets the task, else the nearest that was found and the reason.

        Raises:
            RobotError: An argument is not finite, has the wrong shape, or is out of range.
        """
        _check_numbers(position_tolerance, orientation_tolerance, max_restarts)
        pose, mask = _check_target(target, mask)
        posture = None if posture is None else self._check_posture(posture, "posture")
        near = posture if start is None else self._check_posture(start, "start")
        problem = self._problem(pose, mask, position_tolerance, orientation_tolerance)
        found = self._search(problem, near, max_restarts)
        reason = ""
        if not found.met:
            found = _better(found, problem.descend(found.q))
            reason = "" if found.met else self._reason(problem, found)
        if found.met and posture is not None:
            found = pull_towards(problem, found, posture, self._endless)
        q = found.q
        if self._turns_for_ever:  # joints that turn for ever end within half a turn of where they started
            turns = self._endless * (q - (self._home if near is None else near)) / (2.0 * np.pi)
            q = q - 2.0 * np.pi * np.rint(turns)
        return IkResult(
            found.met, q, found.position_error, found.steps, found.orientation_error, found.tried - 1, reason
        )

    def _problem(self, pose: FloatArray, mask: TaskMask, position: float, orientation: float) -> IkProblem:
        """What counts of a pose (12,), with tolerances [m], [rad]."""
        tolerances = np.array([position, orientation, self._filled_table().length ** 2])
        return IkProblem(self._chain, mask, pose, self._bounds, tolerances)

    def _filled_table(self) -> PoseTable:
        if self._table is None:
            self._table = PoseTable(self._chain, self._bounds, self._home)
        return self._table

    def _search(self, problem: IkProblem, near: FloatArray | None, max_restarts: int) -> Found:
        """Descend from start after start until one leads to a solution: first from a posture, or the nearest known."""
        table = self._filled_table()
        found = problem.search(table.nearest(problem.target, problem.mask) if near is None else near[None])
        if found.met or max_restarts == 0:
            return found
        starts = table.starts(problem.target, problem.mask, max_restarts + 1, near)
        # Without a posture to be near to, the nearest known one leads them; it was tried.
        return _better(found, problem.search(starts[1:] if near is None else starts[:-1]))

    def _reason(self, problem: IkProblem, found: Found) -> str:
        """Why there is no solution, in words."""
        off, angle = _millimetres(found.position_error), f"{found.orientation_error:.3g} rad"
        mask = problem.mask
        if not mask.angular:
            return f"position out of reach by {off} (the nearest of {found.tried} starts)"
        if not mask.linear:
            return f"orientation out of reach by {angle} (the nearest of {found.tried} starts)"
        alone = TaskMask(tuple(axis for axis in mask.axes if not axis.startswith("r")), mask.frame)
        position, orientation, _ = problem.tolerances.tolist()
        reach = self._search(self._problem(problem.target, alone, position, orientation), found.q, REACH_RESTARTS)
        if not reach.met:
            return f"position out of reach by {_millimetres(reach.position_error)}, whatever the orientation"
        return (
            f"no posture has this orientation at this position: off by {off} and {angle} at best "
            f"(of {found.tried} starts)"
        )

    def _check_posture(self, values: FloatArray, name: str) -> FloatArray:
        vector = np.array(values, dtype=float)
        if vector.shape != self._home.shape or not np.isfinite(vector).all():
            raise RobotError(f"{name} must be {self._home.size} finite joint positions, got {values!r}")
        return vector


def _better(first: Found, second: Found) -> Found:
    """The better of two, with the steps and starts of both."""
    better = second if second.met or second.cost < first.cost else first
    return replace(better, steps=first.steps + second.steps, tried=first.tried + second.tried)


def _check_numbers(position_tolerance: float, orientation_tolerance: float, max_restarts: int) -> None:
    if not position_tolerance > 0.0:
        raise RobotError(f"position_tolerance must be positive [m], got {position_tolerance}")
    if not orientation_tolerance > 0.0:
        raise RobotError(f"orientation_tolerance must be positive [rad], got {orientation_tolerance}")
    if max_restarts < 0:
        raise RobotError(f"max_restarts must be at least 0, got {max_restarts}")


def _millimetres(distance: float) -> str:
    """A distance [m] for people: three digits, but no more than whole millimetres."""
    value = 1000.0 * distance
    return f"{value:.0f} mm" if value >= 100.0 else f"{value:.3g} mm"


def _check_target(target: Pose | FloatArray, mask: TaskMask | None) -> tuple[FloatArray, TaskMask]:
    """A finite target pose (12,), rotation matrix and position, and what of it counts."""
    if isinstance(target, Pose):
        position, quaternion, mask = target.position, target.orientation_xyzw, mask or TaskMask.FULL
    else:
        position, quaternion, mask = np.asarray(target, dtype=float), _NO_TURN, mask or TaskMask.POSITION
        if mask.angular or (mask.frame == "tool" and len(mask.linear) < 3):
            raise RobotError(f"a position alone says nothing about {', '.join(mask.axes)} of the tool: give a Pose")
    numbers = np.empty(12)
    whole = position.shape == (3,) and quaternion.shape == (4,)
    if whole and pose_numbers(np.concatenate((position, quaternion)), numbers):
        return numbers, mask
    if position.shape != (3,) or not np.isfinite(position).all():
        raise RobotError(f"position must be three finite numbers [m], got {position.tolist()!r}")
    raise RobotError(f"orientation_xyzw must be a unit quaternion, got {quaternion.tolist()!r}")
