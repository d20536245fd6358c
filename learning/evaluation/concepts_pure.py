"""Pure IGMM as in appendix A, without what ours adds: the baseline that shows how much it splinters.

Per demo a Gaussian mixture of all values, its number of components by BIC; then Song and Wang's tests with every value
counted as drawn by itself. Nothing is known of tracks, shared light, covariance floors or learned noise. The embedding
and the smallest scale of a space (`grain`) are ours, lest covariances be singular.
"""

import warnings

import numpy as np

from learning.concepts.demo_concepts import threadpools
from learning.concepts.equality_tests import INDEPENDENT
from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.incremental_mixture import IncrementalMixture
from robots.pose import FloatArray

MOST_COMPONENTS = 15
WORSE = 2
"""The search for the number of components stops when BIC has risen so many times in a row."""


class PureIgmm:
    """The mixtures of all feature spaces by pure IGMM.

    Attributes:
        mixtures: Feature space name to its mixture.
    """

    def __init__(self, spaces: tuple[type[FeatureSpace], ...]) -> None:
        """Start without concepts."""
        self.mixtures = {space.name: IncrementalMixture(space, INDEPENDENT) for space in spaces}

    def update(self, space: type[FeatureSpace], points: FloatArray) -> None:
        """Learn from the embedded values of one demo, (n, d)."""
        self.mixtures[space.name].update(best_mixture(points, space))


def best_mixture(points: FloatArray, space: type[FeatureSpace]) -> tuple[Gaussian, ...]:
    """The mixture of one demo with the smallest BIC; each value belongs to its likeliest component (lines 4 to 7).

    Args:
        points: Embedded values, (n, d).
        space: The feature space.
    """
    from sklearn.exceptions import ConvergenceWarning
    from sklearn.mixture import GaussianMixture

    if len(points) < 2:
        return ()
    best, best_bic, worse = None, np.inf, 0
    kind = "diag" if space.diagonal else "full"
    with warnings.catch_warnings(), threadpools().limit(limits=1):
        warnings.simplefilter("ignore", ConvergenceWarning)
        for number in range(1, min(MOST_COMPONENTS, len(points) - 1) + 1):
            model = GaussianMixture(number, covariance_type=kind, reg_covar=space.grain**2, random_state=0)
            bic = float(model.fit(points).bic(points))
            if bic < best_bic:
                best, best_bic, worse = model.predict(points), bic, 0
            else:
                worse += 1
            if worse == WORSE:
                break
    if best is None:
        return ()
    components = []
    for label in np.unique(best):
        held = points[best == label]
        centred = held - held.mean(axis=0)
        covariance = centred.T @ centred / len(held) + space.grain**2 * np.eye(space.dimension)
        covariance = np.diag(np.diag(covariance)) if space.diagonal else covariance
        components.append(Gaussian(held.mean(axis=0), covariance, float(len(held))))
    return tuple(components)
