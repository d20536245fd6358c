"""Random ordering scenes for the Mico: one thing on the counter."""

import numpy as np

from .objects import CATALOGUES, look_of
from .scene_spec import SceneSpec
from .tabletop_scene import standing

REGION_X = (0.45, 0.60)
REGION_Y = (-0.15, 0.15)
"""Where the object's centre is [m]. The robot stands at x < 0 and looks along +x."""


def random_ordering(rng: np.random.Generator, *, seed: int = 0, including: str | None = None) -> SceneSpec:
    """Make a scene of one object of the ordering catalogue, turned at random.

    Args:
        rng: Where chance comes from.
        seed: Number written into the specification.
        including: Name of the object; None takes any.

    Raises:
        SceneError: There is no object `including`.
    """
    name = str(rng.choice(CATALOGUES["ordering"]))
    if including is not None:
        look_of(including)
        name = including
    thing = standing(rng, 0, name, REGION_X, REGION_Y)
    return SceneSpec(name="ordering", kind="table", robot="mico_segway", objects=(thing,), seed=seed)
