"""Weights that make every height of a thing count alike, however much of it the hand or another thing hides."""

import numpy as np

from robots.pose import FloatArray

SLICES = 8
"""Slices from the lowest to the highest point seen."""
LEAST_HEIGHT = 0.005
"""What is lower is one height [m]: noise of depth."""
_TAIL = 0.02


def height_weights(heights: FloatArray) -> FloatArray:
    """Weight of each point, (n,): what is hidden is taken to look like what is seen at the same height.

    A hand hides the middle of what it holds, so that a lid or a rim would outweigh the body. Weights sum to n.

    Args:
        heights: At least one, (n,) [m].
    """
    ordered = np.sort(heights)
    low, high = ordered[int(_TAIL * (len(ordered) - 1))], ordered[int((1.0 - _TAIL) * (len(ordered) - 1))]
    place = (heights - low) / max(high - low, LEAST_HEIGHT) * SLICES
    number = np.clip(place.astype(np.int64), 0, SLICES - 1)
    counts = np.bincount(number, minlength=SLICES)
    return np.asarray(len(heights) / np.count_nonzero(counts) / counts[number])
