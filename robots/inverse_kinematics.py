"""Position inverse kinematics: damped least squares inside joint limits, with restarts."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .pose import FloatArray, read_only

MAX_STEPS = 60
"""Steps from one start; convergence is quadratic near the solution, so more would not help."""
MAX_RESTARTS = 20
STEP_LIMIT = 0.6
"""Largest change of one joint in one step [rad or m]: the linearization is poor beyond it."""
DAMPING = 0.1
"""Damping per metre of error: strong far away, gone at the solution (Levenberg-Marquardt after Sugihara)."""

PositionAndJacobian = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class IkResult:
    """Outcome of inverse kinematics.

    Attributes:
        success: Whether the error is within the tolerance asked for.
        q: The best posture found, (n,) [rad or m], always inside the joint limits.
        error: Distance of its tool position from the one asked for [m].
        iterations: Steps taken over all starts.
    """

    success: bool
    q: FloatArray
    error: float
    iterations: int

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "q", read_only(self.q))


def solve_position(
    evaluate: PositionAndJacobian,
    target: FloatArray,
    starts: list[FloatArray],
    lower: FloatArray,
    upper: FloatArray,
    tolerance: float,
) -> IkResult:
    """Find a posture whose tool position is `target`.

    Args:
        evaluate: Gives tool position (3,) [m] and linear Jacobian (3, n) of a posture.
        target: Wanted tool position, (3,) [m].
        starts: Postures to start from, tried in order.
        lower: Lower joint limits, (n,).
        upper: Upper joint limits, (n,).
        tolerance: Accepted distance [m].

    Returns:
        The first posture within the tolerance, else the nearest that was found.
    """
    best = IkResult(False, np.clip(starts[0], lower, upper), float("inf"), 0)
    iterations = 0
    for start in starts[: MAX_RESTARTS + 1]:
        q = np.clip(start, lower, upper)
        for step in range(MAX_STEPS + 1):
            position, jacobian = evaluate(q)
            difference = target - position
            error = float(np.linalg.norm(difference))
            if error < best.error:
                best = IkResult(error <= tolerance, q, error, iterations)
            if best.success or step == MAX_STEPS:
                break
            moved = np.clip(q + _damped_step(q, difference, jacobian, lower, upper), lower, upper)
            iterations += 1
            if np.array_equal(moved, q):
                break
            q = moved
        if best.success:
            break
    return IkResult(best.success, best.q, best.error, iterations)


def _damped_step(
    q: FloatArray, difference: FloatArray, jacobian: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """One damped least squares step dq = J^T (J J^T + lambda I)^-1 e; joints that push against a limit are left out."""
    damping = DAMPING * float(difference @ difference) + 1e-12
    free = np.ones(q.size, dtype=bool)
    step = np.zeros(q.size)
    for _ in range(q.size):
        part = jacobian * free
        step = part.T @ np.linalg.solve(part @ part.T + damping * np.eye(3), difference)
        blocked = free & (((q <= lower) & (step < 0)) | ((q >= upper) & (step > 0)))
        if not blocked.any():
            break
        free &= ~blocked
    largest = float(np.abs(step * free).max())
    return step * free * min(1.0, STEP_LIMIT / largest) if largest > 0 else np.zeros(q.size)
