"""Straight motion of the tool, turned into motion of the joints within all of their limits."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray, Pose

from .joints import move_joints
from .limits import JointLimits
from .line import PoseLine, pose_error
from .path_trajectory import PathTrajectory, needed_slowdown, parametrize
from .paths import spline_through
from .piecewise import PiecewisePolynomial
from .tool_limits import ToolLimits

Forward = Callable[[FloatArray], Pose]
"""Pose of the tool at a posture, (n,)."""
Inverse = Callable[[Pose, FloatArray], FloatArray | None]
"""Posture for a pose of the tool, searched from a near posture; None if there is none."""

Jacobian = Callable[[FloatArray], FloatArray]
"""Jacobian (6, n) of the tool at a posture, (n,): linear then angular rows, in the axes of the poses' frame."""

STEP = 0.02
"""Distance of the points at which postures are solved for at first [m]; one turn step is three times this [rad]."""
LARGEST_STEP = 0.5
"""A joint that moves further than this [rad] between such points has jumped to another branch of solutions."""
REFINEMENTS = 3
NEWTON_STEPS = 12
RESIDUAL = 1e-7
"""Error of the tool [m, rad] left at the points: noise of the points becomes jerk, magnified by their density cubed."""
NUDGE = 1e-6
"""Step of the numerical Jacobian [rad]: central differences err by about 1e-10."""


@dataclass(frozen=True, slots=True)
class StraightMotion:
    """Outcome of planning a straight motion.

    Attributes:
        success: Whether there is one.
        reason: Why not, else empty.
        trajectory: Of the joints, if successful.
        deviation: Largest distance of the tool from where it should be on the line [m], at 4 points a piece.
        turn_deviation: The same of its orientation [rad]; 0 where orientation is not asked for.
        retimed: Whether the joints' limits made it slower than the tool's limits alone.
    """

    success: bool
    reason: str
    trajectory: PathTrajectory | None = None
    deviation: float = float("nan")
    turn_deviation: float = float("nan")
    retimed: bool = False


def move_straight(
    start: FloatArray,
    goal: Pose,
    forward: Forward,
    inverse: Inverse,
    limits: JointLimits,
    tool: ToolLimits,
    tolerance: float = 5e-4,
    turn_tolerance: float | None = 5e-3,
    jacobian: Jacobian | None = None,
) -> StraightMotion:
    """Move the tool on a straight line, its orientation turning evenly about one axis, from rest to rest.

    Args:
        start: Posture, (n,) [rad].
        goal: Pose of the tool at the end.
        forward: Forward kinematics, in the frame of `goal`.
        inverse: Inverse kinematics; its answers are polished, so that 1 mm of error is good enough.
        limits: Of the joints.
        tool: Of the tool along the line.
        tolerance: How far the tool may be from the line [m].
        turn_tolerance: How far its orientation may be from that on the line [rad]; None for an arm that cannot choose
            its orientation: then only the position is followed.
        jacobian: Of the tool; by differences of `forward` if not given, which takes about three times as long.

    Raises:
        MotionError: The start is not finite or out of limits, or the goal is not finite.
    """
    start = limits.check_inside("start", start)
    line = PoseLine(forward(start), goal)
    turns = turn_tolerance is not None
    angle = line.angle if turns else 0.0
    if line.length < 1e-9 and angle < 1e-9:
        still = parametrize(PiecewisePolynomial(np.zeros(2), start[None, None, :]), limits)
        return StraightMotion(True, "", still, 0.0, 0.0)
    count = max(10, int(np.ceil(line.length / STEP)), int(np.ceil(angle / (3 * STEP))))
    follower = _Follower(line, forward, inverse, jacobian, limits, turns)
    result = StraightMotion(False, "")
    for _ in range(REFINEMENTS + 1):
        fractions = np.linspace(0.0, 1.0, count + 1)
        postures, problem = follower.postures(start, fractions)
        if problem:
            return StraightMotion(False, problem)
        path = spline_through(fractions, postures)
        deviation, turn = follower.deviation(path)
        if deviation <= tolerance and (turn_tolerance is None or turn <= turn_tolerance):
            if problem := _leaves_limits(path, limits):
                return StraightMotion(False, problem)
            trajectory, retimed = _in_time(path, limits, tool, line.length, angle)
            return StraightMotion(True, "", trajectory, deviation, turn, retimed)
        result = StraightMotion(
            False,
            f"the tool leaves the line by {1e3 * deviation:.3g} mm and {turn:.3g} rad, allowed {1e3 * tolerance:.3g} mm"
            f" and {turn_tolerance} rad; the line passes too near to a singular posture",
        )
        count *= 2
    return result


class _Follower:
    """Postures along a line of poses."""

    def __init__(
        self,
        line: PoseLine,
        forward: Forward,
        inverse: Inverse,
        jacobian: Jacobian | None,
        limits: JointLimits,
        turns: bool,
    ) -> None:
        self._line, self._forward, self._inverse, self._limits = line, forward, inverse, limits
        self._given_jacobian = jacobian
        self._rows = slice(0, 6 if turns else 3)

    def postures(self, start: FloatArray, fractions: FloatArray) -> tuple[FloatArray, str]:
        """A posture at each fraction of the line, (k, n), or what is wrong."""
        found = [start]
        for fraction in fractions[1:]:
            wanted = self._line.at(float(fraction))
            # The motion so far goes on: for redundant arms too, neighbours are then solved alike.
            guess = 2 * found[-1] - found[-2] if len(found) > 1 else found[-1]
            q = self._polish(wanted, guess)
            if q is None or self._limits.problem(q):
                solved = self._inverse(wanted, found[-1])
                q = None if solved is None else self._polish(wanted, np.asarray(solved, dtype=np.float64))
            where = f"{100 * fraction:.0f}% of the line"
            if q is None:
                return np.array(found), f"no posture reaches the tool's pose at {where}"
            if problem := self._limits.problem(q):
                return np.array(found), f"the posture at {where} {problem}"
            if np.max(np.abs(q - found[-1])) > LARGEST_STEP:
                return np.array(found), f"the arm would have to jump to another posture at {where}"
            found.append(q)
        return np.array(found), ""

    def deviation(self, path: PiecewisePolynomial) -> tuple[float, float]:
        """Largest distance [m] and angle [rad] from the line, between the points that were solved for."""
        inside = np.array([0.2, 0.4, 0.6, 0.8])
        fractions = (path.breaks[:-1, None] + inside * np.diff(path.breaks)[:, None]).ravel()
        errors = np.array(
            [
                pose_error(self._line.at(float(fraction)), self._forward(q))[self._rows]
                for fraction, q in zip(fractions, path.derivatives(fractions)[0], strict=True)
            ]
        )
        return (
            float(np.max(np.linalg.norm(errors[:, :3], axis=1))),
            float(np.max(np.linalg.norm(errors[:, 3:], axis=1))),
        )

    def _polish(self, wanted: Pose, q: FloatArray) -> FloatArray | None:
        """Newton's method with least change of the joints; one that is pushed against a limit stays there."""
        lower, upper = self._limits.lower, self._limits.upper
        q = np.clip(q, lower, upper)
        for _ in range(NEWTON_STEPS):
            error = pose_error(wanted, self._forward(q))[self._rows]
            if np.max(np.abs(error)) < RESIDUAL:
                return q
            jacobian, free = self._jacobian(q), np.ones(q.size, dtype=bool)
            while True:
                step = np.linalg.lstsq(jacobian * free, error, rcond=1e-4)[0]
                blocked = free & (((q <= lower) & (step < 0)) | ((q >= upper) & (step > 0)))
                if not blocked.any():
                    break
                free &= ~blocked
            if np.max(np.abs(step)) > LARGEST_STEP:
                return None
            q = np.clip(q + step, lower, upper)
        return None

    def _jacobian(self, q: FloatArray) -> FloatArray:
        """As given, or by central differences, (3 or 6, n)."""
        if self._given_jacobian is not None:
            return self._given_jacobian(q)[self._rows]
        columns = []
        for joint in range(q.size):
            nudge = np.zeros(q.size)
            nudge[joint] = NUDGE
            columns.append(pose_error(self._forward(q + nudge), self._forward(q - nudge))[self._rows] / (2 * NUDGE))
        return np.stack(columns, axis=1)


def _leaves_limits(path: PiecewisePolynomial, limits: JointLimits) -> str:
    """The spline can swing over a limit between two points within it."""
    for fraction in np.linspace(0.0, 1.0, 4 * len(path.coefficients)):
        if problem := limits.problem(path.derivatives(np.array([fraction]))[0, 0]):
            return f"the posture at {100 * fraction:.0f}% of the line {problem}"
    return ""


def _in_time(
    path: PiecewisePolynomial, limits: JointLimits, tool: ToolLimits, length: float, angle: float
) -> tuple[PathTrajectory, bool]:
    """As fast as the tool's limits allow; if that breaks a joint's limit, as fast as both allow."""
    along = JointLimits(
        np.array([-np.inf]),
        np.array([np.inf]),
        *(
            np.array([min(linear / max(length, 1e-12), angular / max(angle, 1e-12))])
            for linear, angular in (
                (tool.velocity, tool.angular_velocity),
                (tool.acceleration, tool.angular_acceleration),
                (tool.jerk, tool.angular_jerk),
            )
        ),
    )
    trajectory = PathTrajectory(path, move_joints(np.zeros(1), np.ones(1), along).curve)
    if needed_slowdown(trajectory, limits) <= 1:
        return trajectory, False
    # The way itself goes along as one more joint, so that the tool's limits are kept too.
    fraction = np.zeros((len(path.coefficients), path.coefficients.shape[1], 1))
    fraction[:, 0, 0], fraction[:, 1, 0] = path.breaks[:-1], 1.0
    whole = PiecewisePolynomial(path.breaks, np.concatenate([path.coefficients, fraction], axis=2))
    phase = parametrize(whole, JointLimits.stacked([limits, along]), parts=1).phase
    return PathTrajectory(path, phase), True
