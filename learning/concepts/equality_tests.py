"""The two significance tests of appendix A: are two Gaussian components the same?

Song and Wang (2005) test a new component's data against an old component as if all values were independent. The
values of one demo are not: they share its light and the chance of its placements, so every new demo would differ
*significantly* from what was learned, however slightly. Both tests therefore use the effective sample size of
clustered samples (Kish's design effect): n values in m demos with intraclass correlation r count as

    n_eff = n / (1 + (n / m - 1) r),

at most m / r. It grows with the number of demos, so that different concepts stay apart ever more surely as learning
goes on, while the light of one demo is never taken for a new colour. The covariance floor of each space, which is
part of every covariance, is known rather than estimated: it counts as a prior worth `PRIOR_VALUES` values. Without it
a place seen for a frame or two, whose spread nobody can estimate, would equal any other.
"""

import numpy as np
from scipy.special import chdtrc, fdtrc

from robots.pose import FloatArray

SHAPE_CORRELATION = 0.05
"""Intraclass correlation used for covariances: n values of a demo tell at most 20 values' worth about its spread."""

PRIOR_VALUES = 40
"""What the covariance floor is worth in the degrees of freedom of the pooled covariance."""


def effective_size(count: FloatArray, demos: FloatArray, correlation: float) -> FloatArray:
    """Effective number of independent values of `count` values from `demos` demos."""
    count, demos = np.asarray(count, dtype=np.float64), np.asarray(demos, dtype=np.float64)
    return np.asarray(count / (1.0 + np.maximum(count / demos - 1.0, 0.0) * correlation))


def covariance_p_value(covariance: FloatArray, others: FloatArray, size: FloatArray, diagonal: bool) -> FloatArray:
    """P-value of the W statistic (Ledoit and Wolf 2002) that `covariance` equals each of `others`.

    W = tr((S - I)^2) / d - (d / n) (tr(S) / d)^2 + d / n with S the covariance whitened by the other; n d W / 2 is
    chi-squared with d (d + 1) / 2 degrees of freedom. Of diagonal covariances only the d variances are compared.

    W hardly notices a covariance that is far smaller than the other (S near 0 gives W = 1), and would let a component
    that spans two concepts swallow both. Equality holds both ways, so each is whitened by the other in turn, and the
    smaller p-value counts.

    Args:
        covariance: Of the new component, (d, d).
        others: Of the old components, (K, d, d).
        size: Effective sample size of each comparison, (K,).
        diagonal: Whether the covariances are diagonal.

    Returns:
        (K,) in 0..1.
    """
    if diagonal:
        ratios = np.diag(covariance) / np.diagonal(others, axis1=1, axis2=2)
    else:
        # Eigenvalues of A^-1 C are those of the whitened covariance L^-1 C L^-T, where A = L L^T.
        ratios = np.real(np.linalg.eigvals(np.linalg.solve(others, np.broadcast_to(covariance, others.shape))))
    return np.minimum(_w_p_value(ratios, size, diagonal), _w_p_value(1.0 / ratios, size, diagonal))


def _w_p_value(eigenvalues: FloatArray, size: FloatArray, diagonal: bool) -> FloatArray:
    """P-value of W from the eigenvalues (K, d) of the whitened covariances."""
    dimension = eigenvalues.shape[1]
    squares = np.sum((eigenvalues - 1.0) ** 2, axis=1)
    if diagonal:
        return np.asarray(chdtrc(float(dimension), 0.5 * size * squares))
    w = squares / dimension - dimension / size * (eigenvalues.mean(axis=1) ** 2 - 1.0)
    return np.asarray(chdtrc(dimension * (dimension + 1) / 2.0, np.maximum(0.5 * size * dimension * w, 0.0)))


def mean_p_value(
    mean: FloatArray,
    covariance: FloatArray,
    count: float,
    size: float,
    other_means: FloatArray,
    other_covariances: FloatArray,
    other_counts: FloatArray,
    other_sizes: FloatArray,
) -> FloatArray:
    """P-value of Hotelling's two-sample T-squared that `mean` equals each of `other_means`.

    The pooled covariance has the degrees of freedom of the values seen; the means are as sure as the effective
    sizes say.

    Args:
        mean: Of the new component, (d,).
        covariance: Of the new component, (d, d).
        count: Number of its values.
        size: Its effective size.
        other_means: (K, d).
        other_covariances: (K, d, d).
        other_counts: (K,).
        other_sizes: (K,).

    Returns:
        (K,) in 0..1.
    """
    dimension = mean.shape[0]
    difference = mean - other_means
    total = count + other_counts
    pooled = (count * covariance + other_counts[:, None, None] * other_covariances) / total[:, None, None]
    scaled = np.linalg.solve(pooled, difference[:, :, None])[:, :, 0]
    harmonic = size * other_sizes / (size + other_sizes)
    t_squared = harmonic * np.einsum("kd,kd->k", difference, scaled)
    freedom = total - 2.0 + PRIOR_VALUES
    f_statistic = t_squared * (freedom - dimension + 1.0) / (freedom * dimension)
    return np.asarray(fdtrc(float(dimension), freedom - dimension + 1.0, f_statistic))
