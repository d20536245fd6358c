"""Random tabletop scenes for Baxter."""

from collections.abc import Sequence

import numpy as np

from .errors import SceneError
from .objects import CATALOGUES, look_of, object_model
from .objects.overlap import footprint_depth
from .scene_spec import ObjectSpec, SceneSpec

FEWEST, MOST = 4, 6
REGION_X = (0.50, 0.85)
REGION_Y = (-0.35, 0.35)
"""Where the objects' centres are [m]: on the table, within reach of both arms. The robot stands at the origin."""
CLEARANCE = 0.030
"""Least distance [m] between two objects seen from above, so that a finger fits between them."""
_ATTEMPTS = 50
"""Tries at placing one object before all are placed anew."""


def random_tabletop(
    rng: np.random.Generator,
    *,
    seed: int = 0,
    including: str | None = None,
    places: Sequence[tuple[float, float]] | None = None,
    about: float = 0.0,
) -> SceneSpec:
    """Make a scene of 4 to 6 different objects of the tabletop catalogue, each by itself and turned at random.

    Args:
        rng: Where chance comes from.
        seed: Number written into the specification.
        including: Name of an object that must be there; it comes first.
        places: At least six points (x, y) [m]; each object stands at another of them. None: anywhere on the table.
        about: How far from its place an object may stand, along x and along y [m].

    Raises:
        SceneError: There is no object `including`, or there are too few places.
    """
    if places is not None and len(places) < MOST:
        raise SceneError(f"a tabletop has up to {MOST} objects, got {len(places)} places for them")
    names = [str(name) for name in rng.permutation(CATALOGUES["tabletop"])[: rng.integers(FEWEST, MOST + 1)]]
    if including is not None:
        look_of(including)
        names = [including, *[name for name in names if name != including]][: max(len(names), FEWEST)]
    placed: list[ObjectSpec] = []
    order = None if places is None else rng.permutation(len(places))
    while len(placed) < len(names):
        region_x, region_y = REGION_X, REGION_Y
        if places is not None and order is not None:
            x, y = places[int(order[len(placed)])]
            region_x, region_y = (x - about, x + about), (y - about, y + about)
        another = _placed_apart(rng, len(placed), names[len(placed)], placed, region_x, region_y)
        placed = [] if another is None else [*placed, another]
    return SceneSpec(name="tabletop", kind="table", robot="baxter", objects=tuple(placed), seed=seed)


def standing(
    rng: np.random.Generator,
    identity: int,
    name: str,
    region_x: tuple[float, float],
    region_y: tuple[float, float],
) -> ObjectSpec:
    """Stand an object anywhere in a region [m], turned at random."""
    height = float(object_model(name).half_extents[2])
    x, y = float(rng.uniform(*region_x)), float(rng.uniform(*region_y))
    return ObjectSpec.of_model(identity, name, (x, y, height), float(rng.uniform(-np.pi, np.pi)))


def _placed_apart(
    rng: np.random.Generator,
    identity: int,
    name: str,
    others: Sequence[ObjectSpec],
    region_x: tuple[float, float],
    region_y: tuple[float, float],
) -> ObjectSpec | None:
    """Stand an object clear of others in a region [m]; None when no place was found."""
    for _ in range(_ATTEMPTS):
        here = standing(rng, identity, name, region_x, region_y)
        if all(_depth(here, other) <= -CLEARANCE for other in others):
            return here
    return None


def _depth(one: ObjectSpec, other: ObjectSpec) -> float:
    """How deep two objects overlap seen from above [m]; negative when they are apart."""
    offset = (other.position[0] - one.position[0], other.position[1] - one.position[1])
    return footprint_depth(one.half_extents, other.half_extents, offset, one.yaw, other.yaw)
