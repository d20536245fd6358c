"""Average linkage of what is known by its statistics alone: means, spreads and counts."""

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray


def average_linkage(
    means: FloatArray,
    spreads: FloatArray,
    counts: FloatArray,
    width: float,
    apart: NDArray[np.bool_] | None = None,
    alike: bool = False,
) -> NDArray[np.int64]:
    """Label things so that the mean square distance between what two labels hold is `width` or more, (n,).

    The closest two are joined first. With the means, and the mean square distance of what each holds from its mean, the
    mean square distance between what two hold is known exactly.

    Args:
        means: (n, k).
        spreads: Mean square distance of what each holds from its mean, (n,).
        counts: How much each holds, (n,).
        width: Mean square distance below which two are joined.
        apart: Pairs that are never joined, (n, n).
        alike: Whether what is joined is taken to spread by 1 along every axis, whatever it is seen to: kinds spread
            alike, and a single thing does not spread.

    Returns:
        Labels 0, 1, ... in the order of the first of each.
    """
    means, spreads, counts = means.copy(), spreads.copy(), counts.copy()
    number, dimension = means.shape
    labels = np.arange(number)
    squared = np.sum((means[:, None] - means[None]) ** 2, axis=2) + spreads[:, None] + spreads[None]
    never = np.eye(number, dtype=bool) if apart is None else apart | np.eye(number, dtype=bool)
    squared[never] = np.inf
    for _ in range(number - 1):
        kept, gone = sorted(int(each) for each in np.unravel_index(int(np.argmin(squared)), squared.shape))
        if not squared[kept, gone] < width:
            break
        count = counts[kept] + counts[gone]
        share = counts[gone] / count
        between = means[gone] - means[kept]
        if alike:
            spreads[kept] = dimension * (count - 1.0) / count
        else:
            spreads[kept] += share * (spreads[gone] - spreads[kept]) + share * (1.0 - share) * float(between @ between)
        means[kept] += share * between
        counts[kept] = count
        labels[labels == gone] = kept
        never[kept] |= never[gone]
        never[gone] = True
        never[:, kept], never[:, gone] = never[kept], True
        away = np.sum((means - means[kept]) ** 2, axis=1) + spreads + spreads[kept]
        squared[kept] = squared[:, kept] = np.where(never[kept], np.inf, away)
        squared[gone] = squared[:, gone] = np.inf
    return np.asarray(np.unique(labels, return_inverse=True)[1], dtype=np.int64)
