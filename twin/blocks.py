"""The cubes and prisms of the public release in physics: made as they were when its demos were recorded.

They go their own way, beside `object_body`, so that recorded demos replay bit for bit.
"""

import numpy as np

from robots.pose import FloatArray

from .board import BLOCK, CUBE_MASS, PRISM_CORNERS, PRISM_FACES, PRISM_MASS, PRISM_MASS_CENTRE
from .physics import HULL_MARGIN, Physics, Rgb

FRICTION = 1.0
_HALF = BLOCK / 2
_CENTRES: dict[str, FloatArray] = {"cube": np.zeros(3), "prism": PRISM_MASS_CENTRE}


def add_block(physics: Physics, shape: str, centre: FloatArray, rgb: Rgb) -> tuple[int, FloatArray]:
    """Place a cube or a prism with its centre (3,) [m] in the world.

    Returns:
        The body, and its centre of mass in the object frame (3,) [m].
    """
    offset = _CENTRES[shape]
    if shape == "cube":
        body = physics.add_box([_HALF] * 3, centre.tolist(), CUBE_MASS, rgb)
    else:
        body = physics.add_hull(
            _shrunk_prism() - offset,
            PRISM_FACES,
            PRISM_CORNERS - offset,
            (centre + offset).tolist(),
            PRISM_MASS,
            rgb,
        )
    physics.set_friction(body, -1, FRICTION)
    return body, offset


def _shrunk_prism() -> FloatArray:
    """Corners (6, 3) of the prism with every face moved inwards by the hull margin, around the block's centre."""
    margin = HULL_MARGIN
    slope = np.array([BLOCK, _HALF]) / np.hypot(BLOCK, _HALF)  # normal (x, z) of a roof face
    reach = slope @ [0.0, _HALF] - margin  # its distance from the centre
    bottom = -_HALF + margin
    width = (reach - slope[1] * bottom) / slope[0]
    top = reach / slope[1]
    ends = (-_HALF + margin, _HALF - margin)
    return np.array([[x, y, bottom] for y in ends for x in (-width, width)] + [[0, y, top] for y in ends])
