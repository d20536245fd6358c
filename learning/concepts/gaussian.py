"""One Gaussian component of a feature space: the sufficient statistics of a concept (thesis 3.4.1)."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray, read_only


@dataclass(frozen=True, slots=True)
class Gaussian:
    """Mean, covariance and frequencies of one component.

    Attributes:
        mean: Mean of the embedded feature values, (d,).
        covariance: Covariance, (d, d); diagonal in spaces that ask for it.
        count: How many feature values it was estimated from, M_k or N pi_j of appendix A.
        demos: How many demos it was seen in: the thesis's *frequency*.
    """

    mean: FloatArray
    covariance: FloatArray
    count: float
    demos: int = 1

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "mean", read_only(self.mean))
        object.__setattr__(self, "covariance", read_only(self.covariance))


def merged(first: Gaussian, second: Gaussian, demos: int) -> Gaussian:
    """Merge two statistically equivalent components by equations A.1 and A.2.

    The weight of equation A.3 is `count` divided by the total of its mixture.
    """
    count = first.count + second.count
    share_1, share_2 = first.count / count, second.count / count
    mean = share_1 * first.mean + share_2 * second.mean  # (A.1)
    # (A.2), with the terms in the means gathered as the spread between them: exact, and no cancellation.
    between = first.mean - second.mean
    covariance = share_1 * first.covariance + share_2 * second.covariance
    covariance = covariance + share_1 * share_2 * np.outer(between, between)
    return Gaussian(mean, covariance, count, demos)


def squared_mahalanobis(points: FloatArray, means: FloatArray, precisions: FloatArray) -> FloatArray:
    """Square of the Mahalanobis distance (eq. 3.1) of points (n, d) to K components, (n, K).

    Args:
        points: Embedded feature values, (n, d).
        means: Component means, (K, d).
        precisions: Inverse covariances, (K, d, d).
    """
    difference = points[:, None, :] - means[None, :, :]
    return np.asarray(np.einsum("nki,kij,nkj->nk", difference, precisions, difference, optimize=True))


def stacked(components: Sequence[Gaussian], dimension: int) -> tuple[FloatArray, FloatArray]:
    """Means (K, d) and covariances (K, d, d) of components."""
    means = np.array([component.mean for component in components]).reshape(-1, dimension)
    covariances = np.array([component.covariance for component in components]).reshape(-1, dimension, dimension)
    return means, covariances
