"""The five metrics of tables 6.3 to 6.5: how well clusters agree with true classes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True)
class ClusterScores:
    """Agreement of clusters with classes.

    Attributes:
        mutual_information: [nats].
        normalised: Mutual information over the mean of both entropies, 0..1.
        homogeneity: 1 when each cluster holds members of one class only.
        completeness: 1 when all members of a class are in one cluster.
        v_measure: Harmonic mean of homogeneity and completeness (Rosenberg and Hirschberg 2007).
    """

    mutual_information: float
    normalised: float
    homogeneity: float
    completeness: float
    v_measure: float


def cluster_scores(classes: Sequence[str], clusters: Sequence[object]) -> ClusterScores | None:
    """Score clusters against classes, both (n,); None for no instances.

    Args:
        classes: True class of each instance.
        clusters: What each was put into; any values that can be told apart by their text.
    """
    from sklearn import metrics

    if not len(classes):
        return None
    true, found = np.asarray(classes, dtype=str), np.asarray([str(each) for each in clusters])
    homogeneity, completeness, v_measure = metrics.homogeneity_completeness_v_measure(true, found)
    return ClusterScores(
        float(metrics.mutual_info_score(true, found)),
        float(metrics.normalized_mutual_info_score(true, found)),
        float(homogeneity),
        float(completeness),
        float(v_measure),
    )
