"""Which components hold a mode of the density of sightings: mean shift (Fukunaga and Hostetler 1975) from their means.

Linkage tells what is near, not what is common: the few things that stand between two places, or a direction half way
between two, are nearer than a kind's width to neither and would become kinds. People name the humps of a distribution,
not its tails. A component holds a mode when the density of all sightings, smoothed by a normal kernel, has a maximum of
its own there.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from robots.pose import FloatArray

ROUNDS = 200
"""Steps of mean shift at most; most starts arrive in ten."""
ARRIVED = 1e-3
"""A step shorter than this many bandwidths has arrived."""
SAME_MODE = 0.25
"""What arrives within this many bandwidths has climbed to one mode: the last steps are short and many."""


def bandwidth(kind_width: float, covariances: FloatArray, counts: FloatArray, least: float) -> float:
    """Bandwidth at which the density of two kinds that are just far enough apart has two humps.

    Things of two kinds are `kind_width` apart (root mean square). What the kinds spread, S, makes a part of it: their
    means are D apart, D^2 = kind_width^2 - 2 tr S. Two equal kernels D apart have two humps where D > 2 h.

    Args:
        kind_width: Root mean square distance between what two kinds hold.
        covariances: Of K components, (K, d, d).
        counts: Their sightings, (K,).
        least: Bandwidth below which differences mean nothing.
    """
    pooled = float(counts @ np.trace(covariances, axis1=1, axis2=2) / counts.sum())
    return max(0.5 * float(np.sqrt(max(kind_width**2 - 2.0 * pooled, 0.0))), least)


def mode_holders(means: FloatArray, counts: FloatArray, width: float) -> NDArray[np.int64]:
    """Index of the component that holds the mode to which each component belongs, (K,); its own where it holds one.

    Args:
        means: Of K components, at least one, (K, d).
        counts: Their sightings, (K,).
        width: Standard deviation of the kernel.
    """
    places = means.copy()
    moving = np.arange(len(means))
    for _ in range(ROUNDS):
        shares = _shares(places[moving], means, counts, width)
        moved = shares @ means / shares.sum(axis=1, keepdims=True)
        far = np.linalg.norm(moved - places[moving], axis=1) > ARRIVED * width
        places[moving] = moved
        moving = moving[far]
        if not len(moving):
            break
    holders = np.argmax(_shares(places, means, counts, width), axis=1)
    away = np.linalg.norm(places[:, None] - places[None], axis=2)
    linked = (away < SAME_MODE * width) | (holders[:, None] == np.arange(len(means)))
    _, group = connected_components(linked, directed=False)
    largest = np.array([np.argmax(np.where(group == each, counts, -1.0)) for each in range(int(group.max()) + 1)])
    return np.asarray(largest[group], dtype=np.int64)


def _shares(places: FloatArray, means: FloatArray, counts: FloatArray, width: float) -> FloatArray:
    """How much each component adds to the density at places (n, d), up to a factor of each place, (n, K)."""
    exponent = -0.5 * np.sum((places[:, None] - means[None]) ** 2, axis=2) / width**2 + np.log(counts)
    return np.asarray(np.exp(exponent - exponent.max(axis=1, keepdims=True)))
