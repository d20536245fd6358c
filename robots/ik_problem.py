"""A question to inverse kinematics, in the numbers that the compiled kernel takes."""

from dataclasses import dataclass

import numpy as np

from .ik_kernel import descend, linearize, search
from .ik_mask import TaskMask
from .kinematics import Chain
from .pose import FloatArray

MAX_STEPS = 40
"""Steps from one start; convergence is quadratic near the solution, so more would not help."""
PATIENCE = 4
"""Steps without progress after which a start is given up: another one is cheaper."""
_POLISH_STEPS = 200


@dataclass(frozen=True, slots=True)
class Found:
    """Where starts led.

    Attributes:
        q: The best posture, (n,) [rad or m].
        met: Whether it meets the task.
        position_error: Over the axes that count [m].
        orientation_error: Over the axes that count [rad].
        cost: Weighted squared error [m²].
        steps: Steps taken over all starts.
        tried: How many starts there were.
    """

    q: FloatArray
    met: bool
    position_error: float
    orientation_error: float
    cost: float
    steps: int
    tried: int


@dataclass(frozen=True, slots=True)
class IkProblem:
    """What is to be solved.

    Attributes:
        chain: The arm.
        mask: What of the target counts.
        target: Wanted tool pose in the base, (12,): rotation matrix, row by row, then position [m].
        bounds: Lower and upper joint limits, (2, n) [rad or m].
        tolerances: Accepted errors of position [m] and orientation [rad], and the squared length [m²] that weighs as
            much as a radian where not all can be had, (3,).
    """

    chain: Chain
    mask: TaskMask
    target: FloatArray
    bounds: FloatArray
    tolerances: FloatArray

    def search(self, starts: FloatArray) -> Found:
        """Try starts (k, n) in order until one leads to a solution; k is at least 1."""
        q = np.empty(starts.shape[1])
        met, position, orientation, cost, steps, tried = search(
            self.chain.joints,
            self.chain.tool,
            self.mask.codes,
            self.target,
            self.bounds,
            self.tolerances,
            MAX_STEPS,
            PATIENCE,
            starts,
            q,
        )
        return Found(q, met, position, orientation, cost, steps, tried)

    def descend(self, start: FloatArray, max_steps: int = _POLISH_STEPS) -> Found:
        """Go on from a posture (n,) inside the limits, with or without progress; this is no start of its own."""
        q = start.copy()
        found = descend(
            self.chain.joints,
            self.chain.tool,
            self.mask.codes,
            self.target,
            self.bounds,
            self.tolerances,
            max_steps,
            max_steps + 1,
            q,
        )
        return Found(q, *found, 0)

    def linearize(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Residual (m,) and Jacobian (m, n) at a posture (n,): to first order, J dq = residual leads to a solution."""
        residual, jacobian = np.empty(6), np.empty((6, q.size))
        work, pose = np.empty((len(self.chain.joints), 6)), np.empty(12)
        linearize(self.chain.joints, self.chain.tool, self.mask.codes, self.target, q, work, pose, residual, jacobian)
        rows = len(self.mask.axes)
        return residual[:rows], jacobian[:rows]
