"""What perception got from one demo: tracks of the gripper and the objects, with noise."""

from collections.abc import Mapping
from dataclasses import dataclass, field

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
        visible: Whether each object was seen in each frame, (F, N); what is not seen is where it was last believed to
            be. None: all were seen.
        extent: Length, width and height of each object as far as it was seen, along its own upright axes,
            (F, N, 3) [m]; None where only points are known.
        gripper_opening: Measured gap between the fingers, (F,) [m]; None where it is not felt.
        wrist_force: Force felt at the wrist, axes of the world, (F, 3) [N]; None where it is not felt.
        yaw: Direction of each object's length in the world, 0 .. π, (F, N) [rad]; None where it was not kept.
        features: Measured values of further feature spaces by their name, (F, N, m); NaN where they are not known.
    """

    times: FloatArray
    gripper_location: FloatArray
    gripper_closed: NDArray[np.bool_]
    object_ids: NDArray[np.int64]
    location: FloatArray
    colour: FloatArray
    shape: FloatArray
    visible: NDArray[np.bool_] | None = None
    extent: FloatArray | None = None
    gripper_opening: FloatArray | None = None
    wrist_force: FloatArray | None = None
    yaw: FloatArray | None = None
    features: Mapping[str, FloatArray] = field(default_factory=dict)
