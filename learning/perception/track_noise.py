"""How noisy the tracks of a demo are, told by the tracks themselves."""

import numpy as np

from learning.perception.observation import Observation
from robots.pose import FloatArray

LEAST_NOISE = 0.004
"""Cameras at a metre or two do not see better than this [m]; smooth tracks may still be off by as much."""
MOST_NOISE = 0.03
"""Tracks that are worse than this are lost, not noisy [m]."""
_MAD = 1.4826
"""Standard deviation of normally distributed values over their median absolute deviation."""


def track_noise(observation: Observation) -> FloatArray:
    """Standard deviation of each object's place from frame to frame, per axis, (N,) [m].

    From second differences, in which steady motion cancels out; their variance is six times that of the places.
    """
    location = observation.location
    if len(location) < 4:
        return np.full(location.shape[1], LEAST_NOISE)
    bend = location[2:] - 2.0 * location[1:-1] + location[:-2]
    noise = np.zeros(location.shape[1])
    for index in range(len(noise)):
        values = bend[:, index]
        if observation.visible is not None:
            seen = observation.visible[:, index]
            whole = seen[2:] & seen[1:-1] & seen[:-2]
            values = values[whole] if np.count_nonzero(whole) >= 3 else values
        noise[index] = _MAD * np.median(np.abs(values)) / np.sqrt(6.0)
    return np.clip(noise, LEAST_NOISE, MOST_NOISE)
