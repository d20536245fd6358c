"""A rigid pose: position [m] and unit quaternion in xyzw order."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


def read_only(values: object) -> FloatArray:
    """Return a read-only float64 copy of `values`, so that frozen dataclasses are frozen to the bottom."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


@dataclass(frozen=True, slots=True)
class Pose:
    """Pose of one frame in another.

    Attributes:
        position: Origin, (3,) [m].
        orientation_xyzw: Unit quaternion, (4,), order x y z w.
    """

    position: FloatArray
    orientation_xyzw: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "position", read_only(self.position))
        object.__setattr__(self, "orientation_xyzw", read_only(self.orientation_xyzw))
