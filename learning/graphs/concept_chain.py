"""Which concept holds in each frame of a camera's track, without flicker: a hidden Markov model over the concepts."""

import numpy as np
from numpy.typing import NDArray

from learning.concepts.gaussian import squared_mahalanobis, stacked
from learning.concepts.mixture import Mixture
from learning.graphs.state_chain import most_likely_states, switching_cost
from learning.percept import NO_CONCEPT
from learning.perception.handling import OUTLIERS
from robots.pose import FloatArray


def lasting_concepts(
    embedded: FloatArray, mixture: Mixture, expected_frames: float, related: FloatArray | None = None
) -> NDArray[np.int64]:
    """Concept number of each frame of one track, (F,).

    A frame speaks for each concept by its Mahalanobis distance (eq. 3.1), and a change of concept costs what
    `switching_cost` says; a value that all concepts explain badly is an outlier and bounds what a frame can say. Frames
    whose values are NaN say nothing.

    Args:
        embedded: Values of the feature space, (F, d).
        mixture: Concepts of the space.
        expected_frames: Mean duration of a predicate in frames.
        related: For spaces of relations: log likelihood ratio of the two things being near enough to relate, (F,);
            `NO_CONCEPT` then stands for their being too far apart.
    """
    frames = len(embedded)
    if not mixture.components:
        return np.full(frames, NO_CONCEPT, dtype=np.int64)
    numbers = np.array(list(mixture.components))
    means, covariances = stacked(list(mixture.components.values()), embedded.shape[1])
    known = np.all(np.isfinite(embedded), axis=1)
    precisions = np.asarray(np.linalg.inv(covariances), dtype=np.float64)
    squared = squared_mahalanobis(np.where(known[:, None], embedded, 0.0), means, precisions)
    most = np.log((1.0 - OUTLIERS) / OUTLIERS)
    said = np.maximum(-0.5 * (squared - squared.min(axis=1, keepdims=True)), -most)
    said[~known] = 0.0
    # What is best nowhere cannot be on the best path.
    chosen = np.unique(np.argmax(said, axis=1))
    numbers, said = numbers[chosen], said[:, chosen]
    if related is not None:
        numbers = np.append(numbers, NO_CONCEPT)
        said = np.column_stack([said + related[:, None], np.zeros(frames)])
    costs = np.full((len(numbers), len(numbers)), switching_cost(expected_frames, len(numbers)))
    np.fill_diagonal(costs, 0.0)
    return np.asarray(numbers[most_likely_states(said, costs)])
