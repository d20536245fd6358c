"""Use the freedom that a task leaves: come as near to a wanted posture as it allows."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .ik_problem import Found, IkProblem
from .pose import FloatArray

MAX_PULLS = 40
SETTLED = 1e-3
"""A pull that moves no joint by more is not worth a step [rad or m]."""
RETURN_STEPS = 6
"""Steps in which the task must be met again after a pull along its tangent."""


def pull_towards(problem: IkProblem, found: Found, posture: FloatArray, endless: NDArray[np.bool_]) -> Found:
    """Move a solution along the task's null space towards another posture.

    Args:
        problem: What stays solved.
        found: A solution.
        posture: Posture to come near to, (n,) [rad or m].
        endless: Which joints turn for ever, (n,): for them the way there is at most half a turn.

    Returns:
        A solution no farther from the posture than `found`.
    """
    lower, upper = problem.bounds
    best, steps, share = found, found.steps, 1.0
    away = short_way(posture - best.q, endless)
    for _ in range(MAX_PULLS):
        pull = _null_space(problem.linearize(best.q)[1], away, best.q, lower, upper)
        if np.abs(pull).max() < SETTLED:
            break
        trial = problem.descend(np.clip(best.q + share * pull, lower, upper), RETURN_STEPS)
        steps += 1 + trial.steps
        left = short_way(posture - trial.q, endless)
        if trial.met and left.dot(left) < away.dot(away):
            best, away, share = trial, left, min(1.0, 2.0 * share)
        elif share < 0.05:
            break
        else:
            share *= 0.4
    return replace(best, steps=steps, tried=found.tried)


def short_way(way: FloatArray, endless: NDArray[np.bool_]) -> FloatArray:
    """The same way (..., n) with at most half a turn for joints that turn for ever."""
    return np.asarray(np.where(endless, np.remainder(way + np.pi, 2.0 * np.pi) - np.pi, way))


def _null_space(
    jacobian: FloatArray, wish: FloatArray, q: FloatArray, lower: FloatArray, upper: FloatArray
) -> FloatArray:
    """The part (n,) of a wished step that leaves the task alone and does not push against a limit.

    Directions that hardly move the tool (a singular value below a thousandth of the largest) leave it alone, too:
    what little they do is undone afterwards.
    """
    free = np.ones(q.size, dtype=bool)
    step = np.zeros(q.size)
    for _ in range(q.size):
        _, values, rows = np.linalg.svd(jacobian * free)
        task_rows = rows[: values.size][values > 1e-3 * values[0]] if values[0] > 0 else rows[:0]
        allowed = wish * free
        step = (allowed - task_rows.T @ (task_rows @ allowed)) * free
        blocked = free & (((q <= lower) & (step < 0)) | ((q >= upper) & (step > 0)))
        if not blocked.any():
            break
        free &= ~blocked
    return step
