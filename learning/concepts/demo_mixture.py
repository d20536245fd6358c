"""The Gaussian mixture of one demo in one feature space, its number of components chosen by BIC (thesis 3.3)."""

import warnings

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.hierarchy import fcluster, linkage
from sklearn import config_context
from sklearn.exceptions import ConvergenceWarning
from sklearn.mixture import GaussianMixture

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, squared_mahalanobis
from robots.pose import FloatArray

MAX_ITERATIONS = 20
TOLERANCE = 1e-2
"""EM stops when the mean log likelihood rises by less: BIC moves by n times that, its penalty by some dozens."""
LEAST_LOG_SHARE = -700.0
"""No single value rules a component out for its track by more than this."""


def fit_mixture(points: FloatArray, tracks: NDArray[np.int64], space: type[FeatureSpace]) -> tuple[Gaussian, ...]:
    """Fit a mixture to the embedded values of one demo.

    Values of one track (an object, or a pair of objects, at rest) are the same thing seen again and again. The search
    starts from the well separated modes of the tracks' means, and then merges the two closest components, or splits
    the widest, as long as BIC falls. The result depends on the arguments alone.

    Args:
        points: Embedded values, (n, d).
        tracks: Which track each value belongs to, (n,).
        space: The feature space, with its scales.

    Returns:
        The components, by descending number of values; empty for no points.
    """
    if len(points) == 0:
        return ()
    _, tracks = np.unique(tracks, return_inverse=True)
    best = _fit(points, _modes(points, tracks, space), tracks, space)
    for change in (_merge_closest, _split_widest):
        while (labels := change(points, best[1], space)) is not None:
            candidate = _fit(points, labels, tracks, space)
            if candidate[0] >= best[0]:
                break
            best = candidate
    components = [_component(points[best[1] == label], space, space.floor) for label in np.unique(best[1])]
    return tuple(sorted(components, key=lambda component: -component.count))


def _modes(points: FloatArray, tracks: NDArray[np.int64], space: type[FeatureSpace]) -> NDArray[np.int64]:
    """Label points by average-linkage clustering of the tracks' means, cut at the space's resolution, (n,)."""
    sizes = np.bincount(tracks)
    sums = np.zeros((len(sizes), points.shape[1]))
    np.add.at(sums, tracks, points)
    means = sums / sizes[:, None]
    if len(means) == 1:
        return np.zeros(len(points), dtype=np.int64)
    labels = fcluster(linkage(means, "average"), space.resolution, "distance")
    return np.asarray(labels[tracks], dtype=np.int64)


def _component(points: FloatArray, space: type[FeatureSpace], least: float) -> Gaussian:
    """Mean and covariance, with `least` squared added, of the values that a component holds: D_k of appendix A."""
    mean = points.mean(axis=0)
    centred = points - mean
    covariance = centred.T @ centred / len(points)
    if space.diagonal:
        covariance = np.diag(np.diag(covariance))
    return Gaussian(mean, covariance + least**2 * np.eye(space.dimension), float(len(points)))


def _fit(
    points: FloatArray, labels: NDArray[np.int64], tracks: NDArray[np.int64], space: type[FeatureSpace]
) -> tuple[float, NDArray[np.int64]]:
    """Run EM from a labelling; return BIC and the most likely component of each point, (n,).

    All values of a track are of one thing, so they go to one component: the likeliest for all of them together.
    Else a component split in vain would leave two halves of a noise cloud, which look like two new concepts.
    """
    start = [_component(points[labels == label], space, space.grain) for label in np.unique(labels)]
    if len(start) > len(points) or (len(start) == 1 and len(points) == 1):
        return np.inf, labels
    covariances = np.array([component.covariance for component in start])
    weights = np.array([component.count for component in start]) / len(points)
    if space.shared_noise:
        kind, precisions = "tied", np.linalg.inv(np.einsum("k,kij->ij", weights, covariances))
    elif space.diagonal:
        kind, precisions = "diag", 1.0 / np.diagonal(covariances, axis1=1, axis2=2)
    else:
        kind, precisions = "full", np.linalg.inv(covariances)
    model = GaussianMixture(
        len(start),
        covariance_type=kind,
        reg_covar=space.grain**2,
        max_iter=MAX_ITERATIONS,
        tol=TOLERANCE,
        weights_init=weights,
        means_init=np.array([component.mean for component in start]),
        precisions_init=precisions,
        random_state=0,
    )
    with warnings.catch_warnings(), config_context(assume_finite=True, skip_parameter_validation=True):
        warnings.simplefilter("ignore", ConvergenceWarning)
        model.fit(points)
    joint = _log_joint(points, model)
    top = joint.max(axis=1, keepdims=True)
    log_density = top[:, 0] + np.log(np.sum(np.exp(joint - top), axis=1))
    bic = _parameters(kind, len(start), space.dimension) * np.log(len(points)) - 2.0 * float(log_density.sum())
    likelihood = np.zeros((int(tracks.max()) + 1, len(start)))
    np.add.at(likelihood, tracks, np.maximum(joint - log_density[:, None], LEAST_LOG_SHARE))
    return bic, np.argmax(likelihood, axis=1)[tracks]


def _log_joint(points: FloatArray, model: GaussianMixture) -> FloatArray:
    """Log of weight times density of every point in every component, (n, K)."""
    components, dimension = model.means_.shape
    precisions = np.asarray(model.precisions_)
    if model.covariance_type == "diag":
        precisions = precisions[:, :, None] * np.eye(dimension)
    precisions = np.broadcast_to(precisions, (components, dimension, dimension))
    _, log_determinant = np.linalg.slogdet(precisions)
    squared = squared_mahalanobis(points, model.means_, precisions)
    return np.asarray(
        np.log(model.weights_) + 0.5 * (log_determinant - dimension * np.log(2.0 * np.pi)) - 0.5 * squared
    )


def _parameters(kind: str, components: int, dimension: int) -> int:
    """Free parameters of a mixture: means, covariances and weights."""
    covariance = {
        "tied": dimension * (dimension + 1) // 2,
        "diag": components * dimension,
        "full": components * dimension * (dimension + 1) // 2,
    }[kind]
    return components * dimension + covariance + components - 1


def _merge_closest(
    points: FloatArray, labels: NDArray[np.int64], space: type[FeatureSpace]
) -> NDArray[np.int64] | None:
    """Labels with the two components of smallest mutual Mahalanobis distance made one; None when there is one."""
    names = np.unique(labels)
    if len(names) < 2:
        return None
    components = [_component(points[labels == name], space, space.grain) for name in names]
    means = np.array([component.mean for component in components])
    covariances = np.array([component.covariance for component in components])
    difference = means[:, None] - means[None]
    pooled = 0.5 * (covariances[:, None] + covariances[None])
    squared = np.einsum("abi,abi->ab", difference, np.linalg.solve(pooled, difference[..., None])[..., 0])
    np.fill_diagonal(squared, np.inf)
    first, second = np.unravel_index(int(np.argmin(squared)), squared.shape)
    result = labels.copy()
    result[labels == names[second]] = names[first]
    return result


def _split_widest(points: FloatArray, labels: NDArray[np.int64], space: type[FeatureSpace]) -> NDArray[np.int64] | None:
    """Labels with the component that stretches furthest cut across its main axis; None when none can be cut."""
    names, counts = np.unique(labels, return_counts=True)
    widest, axis = None, np.zeros(space.dimension)
    largest = 2.0 * space.grain**2  # within the grain there is nothing to split
    for name, count in zip(names, counts, strict=True):
        if count < 4:
            continue
        values, vectors = np.linalg.eigh(_component(points[labels == name], space, space.grain).covariance)
        if values[-1] > largest:
            largest, widest, axis = values[-1], name, vectors[:, -1]
    if widest is None:
        return None
    inside = labels == widest
    side = (points[inside] - points[inside].mean(axis=0)) @ axis > 0.0
    result = labels.copy()
    result[np.flatnonzero(inside)[side]] = labels.max() + 1
    return result
