"""How well an arm can move its tool in a posture, from its Jacobian."""

import math

import numpy as np

from .errors import RobotError
from .pose import FloatArray


def manipulability(jacobian: FloatArray) -> float:
    """Yoshikawa's measure w = sqrt(det(J Jᵀ)): the volume of tool velocities for unit joint velocities, up to a factor.

    Zero at a singularity, and always for an arm with fewer joints than rows: give it the rows that a task controls.

    Args:
        jacobian: Rows of the Jacobian, (m, n).

    Returns:
        The product of the singular values (m/rad for each linear row), which is exact also near zero.

    Raises:
        RobotError: The Jacobian is not a finite matrix.
    """
    matrix = _check(jacobian)
    if matrix.shape[0] > matrix.shape[1]:
        return 0.0
    return float(np.prod(np.linalg.svd(matrix, compute_uv=False)))


def condition_number(jacobian: FloatArray, length: float = 1.0) -> float:
    """Largest over smallest singular value: 1 where all directions are equally easy, infinite at a singularity.

    Args:
        jacobian: Jacobian, (6, n): linear then angular rows; or (3, n) with one kind of row.
        length: Characteristic length by which the linear rows are divided [m], so that they compare with the angular
            ones (the arm's reach, say); 1 leaves the numbers as they are. It cancels out for (3, n).

    Raises:
        RobotError: The Jacobian is not a finite matrix of 3 or 6 rows, or the length is not positive.
    """
    matrix = _check(jacobian)
    if matrix.shape[0] not in (3, 6):
        raise RobotError(f"jacobian must have 3 or 6 rows, got {matrix.shape[0]}")
    if not (length > 0.0 and math.isfinite(length)):
        raise RobotError(f"length must be positive and finite [m], got {length}")
    if matrix.shape[0] > matrix.shape[1]:
        return math.inf
    scaled = matrix.copy()
    scaled[:3] /= length
    values = np.linalg.svd(scaled, compute_uv=False)
    # A singular value that is rounding error alone is none.
    if values[-1] <= values[0] * np.finfo(float).eps * max(matrix.shape):
        return math.inf
    return float(values[0] / values[-1])


def _check(jacobian: FloatArray) -> FloatArray:
    """A finite matrix (m, n)."""
    matrix = np.asarray(jacobian, dtype=float)
    if matrix.ndim != 2 or matrix.size == 0 or not np.isfinite(matrix).all():
        raise RobotError(f"jacobian must be a finite matrix of 3 or 6 rows, got shape {matrix.shape}")
    return matrix
