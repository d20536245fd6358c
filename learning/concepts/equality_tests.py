"""The two significance tests of appendix A: are two Gaussian components the same?

Song and Wang (2005) test a new component's data against an old component as if all values were independent. The
values of one demo are not: they share its light and the chance of its placements, so every new demo would differ
*significantly* from what was learned, however slightly. Both tests therefore use the effective sample size of
clustered samples (Kish's design effect): n values in m demos with intraclass correlation r count as

    n_eff = n / (1 + (n / m - 1) r),

at most m / r, and at most `LARGEST_SIZE`: with enough demos any difference becomes significant, and two halves of the
reds that were seen in different light would stay two concepts for ever. The cap says how small a difference, in
standard deviations, is no difference in kind.

The covariance floor of each space, which is part of every covariance, is known rather than estimated: it counts as a
prior worth `PRIOR_VALUES` values. Without it a place seen for a frame or two, whose spread nobody can estimate, would
equal any other.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, fdtrc

from learning.concepts.gaussian import Gaussian
from robots.pose import FloatArray

SPREAD_CORRELATION = 0.05
"""Intraclass correlation used for covariances: n values of a demo tell at most 20 values' worth about its spread."""
LARGEST_SIZE = 10.0
"""Most that a mean's effective size can be."""
LARGEST_SPREAD_SIZE = 20.0
"""Most that a covariance's effective size can be."""
PRIOR_VALUES = 40
"""What the covariance floor is worth in the degrees of freedom of the pooled covariance."""


@dataclass(frozen=True, slots=True)
class EqualityRules:
    """How values are counted in both tests.

    Attributes:
        spread_correlation: Intraclass correlation for covariances.
        mean_correlation: Intraclass correlation for means; None takes the feature space's.
        largest_size: Most that a mean's effective size can be.
        largest_spread_size: Most that a covariance's effective size can be.
        prior_values: What the covariance floor is worth in degrees of freedom.
        both_ways: Whether covariances are compared both ways, or only the new one with the old one.
    """

    spread_correlation: float = SPREAD_CORRELATION
    mean_correlation: float | None = None
    largest_size: float = LARGEST_SIZE
    largest_spread_size: float = LARGEST_SPREAD_SIZE
    prior_values: float = PRIOR_VALUES
    both_ways: bool = True


CLUSTERED = EqualityRules()
"""Ours: values of a demo are clustered samples."""
INDEPENDENT = EqualityRules(0.0, 0.0, float("inf"), float("inf"), 0.0, both_ways=False)
"""As Song and Wang (2005) have it: every value counts as drawn by itself. It splinters; a baseline for evaluation."""


@dataclass(frozen=True, slots=True)
class Statistics:
    """What is known of K components, stacked.

    Attributes:
        means: (K, d).
        covariances: (K, d, d).
        precisions: Inverse covariances, (K, d, d).
        counts: Numbers of values, (K,).
        demos: Numbers of demos, (K,).
    """

    means: FloatArray
    covariances: FloatArray
    precisions: FloatArray
    counts: FloatArray
    demos: FloatArray

    @classmethod
    def of(cls, components: Sequence[Gaussian]) -> "Statistics":
        """Stack at least one component."""
        covariances = np.array([component.covariance for component in components])
        return cls(
            np.array([component.mean for component in components]),
            covariances,
            np.linalg.inv(covariances),
            np.array([component.count for component in components], dtype=np.float64),
            np.array([component.demos for component in components], dtype=np.float64),
        )


def effective_size(count: FloatArray, demos: FloatArray, correlation: float, largest: float) -> FloatArray:
    """Effective number of independent values of `count` values from `demos` demos, at most `largest`."""
    return np.minimum(count / (1.0 + np.maximum(count / demos - 1.0, 0.0) * correlation), largest)


def covariance_p_values(
    new: Statistics, old: Statistics, diagonal: bool, rules: EqualityRules = CLUSTERED
) -> FloatArray:
    """P-values of the W statistic (Ledoit and Wolf 2002) that covariances are equal.

    W = tr((S - I)^2) / d - (d / n) (tr(S) / d)^2 + d / n with S the covariance whitened by the other; n d W / 2 is
    chi-squared with d (d + 1) / 2 degrees of freedom. Of diagonal covariances only the d variances are compared.

    W hardly notices a covariance that is far smaller than the other (S near 0 gives W = 1), and would let a component
    that spans two concepts swallow both. Equality holds both ways, so each is whitened by the other in turn, and the
    smaller p-value counts.

    Args:
        new: Statistics of A components.
        old: Statistics of K components.
        diagonal: Whether their covariances are diagonal.
        rules: How values are counted.

    Returns:
        (A, K) in 0..1.
    """
    largest = rules.largest_spread_size
    size = _harmonic(*(effective_size(one.counts, one.demos, rules.spread_correlation, largest) for one in (new, old)))
    one_way = _w_p_values(new.covariances, old.precisions, size, diagonal)
    if not rules.both_ways:
        return one_way
    return np.minimum(one_way, _w_p_values(old.covariances, new.precisions, size.T, diagonal).T)


def mean_p_values(
    new: Statistics, old: Statistics, correlation: float, diagonal: bool, rules: EqualityRules = CLUSTERED
) -> FloatArray:
    """P-values of Hotelling's two-sample T-squared that means are equal.

    The pooled covariance has the degrees of freedom of the values seen; the means are as sure as the effective sizes
    say.

    Args:
        new: Statistics of A components.
        old: Statistics of K components.
        correlation: Intraclass correlation of their feature space.
        diagonal: Whether their covariances are diagonal.
        rules: How values are counted.

    Returns:
        (A, K) in 0..1.
    """
    dimension = new.means.shape[1]
    difference = new.means[:, None] - old.means[None]
    total = new.counts[:, None] + old.counts[None]
    share = (new.counts[:, None] / total)[..., None]
    if diagonal:
        variances_new, variances_old = (np.diagonal(one.covariances, axis1=1, axis2=2) for one in (new, old))
        pooled = share * variances_new[:, None] + (1.0 - share) * variances_old[None]
        distance = np.sum(difference**2 / pooled, axis=2)
    else:
        share = share[..., None]
        pooled = share * new.covariances[:, None] + (1.0 - share) * old.covariances[None]
        distance = np.sum(difference * np.linalg.solve(pooled, difference[..., None])[..., 0], axis=2)
    shared = correlation if rules.mean_correlation is None else rules.mean_correlation
    size = _harmonic(*(effective_size(one.counts, one.demos, shared, rules.largest_size) for one in (new, old)))
    freedom = total - 2.0 + rules.prior_values
    with np.errstate(invalid="ignore", divide="ignore"):  # too few independent values to test: NaN passes no test
        f_statistic = size * distance * (freedom - dimension + 1.0) / (freedom * dimension)
        return np.asarray(fdtrc(float(dimension), freedom - dimension + 1.0, f_statistic))


def mean_log_likelihoods(new: Statistics, old: Statistics) -> FloatArray:
    """Mean log likelihood of each new component's values under each old one, (A, K), from the statistics alone."""
    difference = new.means[:, None] - old.means[None]
    squared = np.einsum("aki,kij,akj->ak", difference, old.precisions, difference, optimize=True)
    spread = np.einsum("kij,aji->ak", old.precisions, new.covariances)
    _, log_determinant = np.linalg.slogdet(old.covariances)
    constant = new.means.shape[1] * np.log(2.0 * np.pi) + log_determinant
    return np.asarray(-0.5 * (constant + spread + squared))


def _harmonic(new: FloatArray, old: FloatArray) -> FloatArray:
    """n1 n2 / (n1 + n2) of all pairs, (A, K): the size of a difference between two estimates."""
    return np.asarray(new[:, None] * old[None] / (new[:, None] + old[None]))


def _w_p_values(covariances: FloatArray, precisions: FloatArray, size: FloatArray, diagonal: bool) -> FloatArray:
    """P-values of W of covariances (A, d, d) whitened by precisions (K, d, d), (A, K)."""
    dimension = covariances.shape[1]
    if diagonal:
        variances = np.diagonal(covariances, axis1=1, axis2=2)
        ratios = variances[:, None] * np.diagonal(precisions, axis1=1, axis2=2)[None]
        return np.asarray(chdtrc(float(dimension), 0.5 * size * np.sum((ratios - 1.0) ** 2, axis=2)))
    whitened = precisions[None] @ covariances[:, None]  # has the traces of L^-1 C L^-T, where precision^-1 = L L^T
    trace = np.trace(whitened, axis1=2, axis2=3)
    trace_of_square = np.sum(whitened * np.swapaxes(whitened, 2, 3), axis=(2, 3))
    w = (trace_of_square - 2.0 * trace + dimension) / dimension
    w -= dimension / size * ((trace / dimension) ** 2 - 1.0)
    return np.asarray(chdtrc(dimension * (dimension + 1) / 2.0, np.maximum(0.5 * size * dimension * w, 0.0)))
