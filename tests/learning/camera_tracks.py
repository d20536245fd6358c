"""Small observations of a table for tests: things at rest whose features are drawn, without pictures."""

from collections.abc import Mapping, Sequence

import numpy as np

from learning.perception import Observation
from robots.pose import FloatArray

FRAMES = 12


def still_objects(
    rng: np.random.Generator,
    colours: Sequence[tuple[float, float, float]],
    places: Sequence[tuple[float, float]],
    features: Mapping[str, FloatArray] | None = None,
    noise: float = 0.004,
) -> Observation:
    """Objects that stand still for `FRAMES` frames, 5 cm cubes of given H, S, L, at x and y [m]."""
    number = len(colours)
    shape = (FRAMES, number)
    location = np.array([[x, y, 0.025] for x, y in places]).reshape(number, 3)
    return Observation(
        times=0.1 * np.arange(FRAMES),
        gripper_location=np.tile([0.3, 0.5, 0.4], (FRAMES, 1)),
        gripper_closed=np.zeros(FRAMES, dtype=bool),
        object_ids=np.arange(10, 10 + number),
        location=location + rng.normal(0.0, 0.002, (*shape, 3)),
        colour=np.clip(np.array(colours).reshape(number, 3) + rng.normal(0.0, noise, (*shape, 3)), 0.0, 1.0),
        shape=np.full((*shape, 33), 1.0 / 33),
        visible=np.ones(shape, dtype=bool),
        extent=np.full((*shape, 3), 0.05) * (1.0 + rng.normal(0.0, 0.02, (*shape, 3))),
        features=features or {},
    )
