"""The noise of a feature space, learned from tracks: how much the values of one and the same thing differ."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray, read_only


@dataclass(frozen=True, slots=True)
class TrackNoise:
    """Scatter of embedded values about the means of their tracks: sufficient for their covariance.

    A track is the one label that comes for free: all its values are of one thing, seen again, after it was turned and
    set down elsewhere too. So the scatter within tracks says which differences mean nothing.

    Attributes:
        scatter: Sum of outer products of the deviations, (d, d).
        freedom: Degrees of freedom: values less tracks.
    """

    scatter: FloatArray
    freedom: float

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "scatter", read_only(self.scatter))

    @classmethod
    def none(cls, dimension: int) -> "TrackNoise":
        """Nothing seen yet."""
        return cls(np.zeros((dimension, dimension)), 0.0)

    @classmethod
    def within(cls, points: FloatArray, tracks: NDArray[np.int64]) -> "TrackNoise":
        """The scatter within tracks of points (n, d), given the track of each, (n,)."""
        if len(points) == 0:
            return cls.none(points.shape[1])
        _, tracks = np.unique(tracks, return_inverse=True)
        sizes = np.bincount(tracks)
        sums = np.zeros((len(sizes), points.shape[1]))
        np.add.at(sums, tracks, points)
        deviation = points - (sums / sizes[:, None])[tracks]
        return cls(deviation.T @ deviation, float(len(points) - len(sizes)))

    def plus(self, other: "TrackNoise") -> "TrackNoise":
        """The scatter of both."""
        return TrackNoise(self.scatter + other.scatter, self.freedom + other.freedom)

    def covariance(self, floor: float) -> FloatArray:
        """Covariance within tracks, (d, d), with `floor` squared added to its variances."""
        return self.scatter / max(self.freedom, 1.0) + floor**2 * np.eye(len(self.scatter))
