"""What perception got from one demo: tracks of the gripper and the objects, with noise."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray


@dataclass(frozen=True, slots=True)
class Observation:
    """Tracks over F frames of the gripper and N objects. Nothing in it says what an object is called.

    Attributes:
        times: Frame times, (F,) [s].
        gripper_location: Tool frame position in the world, (F, 3) [m].
        gripper_closed: Gripper state per frame, (F,) bool.
        object_ids: Track numbers, (N,); they carry no meaning.
        location: Object centres in the world, (F, N, 3) [m].
        colour: Hue, saturation, lightness in 0..1, (F, N, 3).
        shape: FPFH descriptors, (F, N, 33).
    """

    times: FloatArray
    gripper_location: FloatArray
    gripper_closed: NDArray[np.bool_]
    object_ids: NDArray[np.int64]
    location: FloatArray
    colour: FloatArray
    shape: FloatArray
