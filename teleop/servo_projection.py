"""The nearest motion to a wanted one that approaches nothing too fast: a small quadratic program, compiled."""

import numpy as np

from robots.ik_kernel import compiled
from robots.pose import FloatArray

ROUNDS = 60
"""Rounds over the rows; what they leave undone is far below what the check of each step catches."""
SETTLED = 1e-6
"""A round that changes no speed by more than this ends the search [m/s]."""


def project(
    wanted: FloatArray, inverse_weight: FloatArray, rows: FloatArray, least: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Minimize (x - wanted)ᵀ H (x - wanted) with rows x >= least, by Hildreth's method (1957).

    Args:
        wanted: (n,).
        inverse_weight: H⁻¹, symmetric and positive, (n, n).
        rows: Gradients of distances, (m, n).
        least: How fast each may shrink, (m,), none above zero: standing still is always allowed.

    Returns:
        x (n,), and the multiplier of each row, above zero where it holds the motion back, (m,).
    """
    if not len(rows) or bool(np.all(rows @ wanted >= least)):
        return wanted, np.zeros(len(rows))
    pushes = np.ascontiguousarray(rows @ inverse_weight)
    found, multipliers = _hildreth(
        np.ascontiguousarray(wanted), pushes, np.ascontiguousarray(rows), np.ascontiguousarray(least)
    )
    return found, multipliers


@compiled
def _hildreth(
    wanted: FloatArray, pushes: FloatArray, rows: FloatArray, least: FloatArray
) -> tuple[FloatArray, FloatArray]:
    m, n = rows.shape
    x = wanted.copy()
    multipliers = np.zeros(m)
    for _ in range(ROUNDS):
        largest = 0.0
        for i in range(m):
            size, value = 0.0, 0.0
            for j in range(n):
                size += rows[i, j] * pushes[i, j]
                value += rows[i, j] * x[j]
            if size < 1e-12:  # nothing that may move moves this pair
                continue
            change = (least[i] - value) / size
            if change < -multipliers[i]:
                change = -multipliers[i]
            if change != 0.0:
                multipliers[i] += change
                for j in range(n):
                    x[j] += change * pushes[i, j]
                if abs(change) * size > largest:
                    largest = abs(change) * size
        if largest < SETTLED:
            break
    return x, multipliers
