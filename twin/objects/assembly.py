"""From solids to an object: mass, inertia and bounds are worked out from the geometry."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray

from .model import Grasp, ObjectModel, Rgb, VisualMesh
from .solids import Solid

LATERAL_FRICTION = 1.0
SPINNING_FRICTION = 0.01
ROLLING_FRICTION = 0.0005
"""With these, fingers with friction 1.0 held 20 of 20 objects in trials; higher ones bring nothing."""


@dataclass(frozen=True, slots=True, eq=False)
class Blueprint:
    """Solids standing on z = 0, and where they can be held, the steadiest first."""

    solids: Sequence[Solid]
    grasps: Sequence[Grasp]
    rolling_friction: float = ROLLING_FRICTION
    spinning_friction: float = SPINNING_FRICTION


def assemble(name: str, shape: str, colour: str, rgb: Rgb, blueprint: Blueprint, scale: float = 1.0) -> ObjectModel:
    """Make an object of a blueprint.

    Args:
        name: Its name in the catalogue.
        shape: Its shape class.
        colour: Its colour's name.
        rgb: That colour.
        blueprint: What it is made of.
        scale: How much larger than its blueprint it is, of the same materials.
    """
    drawn = [solid for solid in blueprint.solids if solid.rgb is not None]
    corners = np.concatenate([solid.mesh.vertices for solid in drawn])
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    middle = (lower + upper) / 2
    mass, centre, inertia = _mass_properties(blueprint.solids)
    return ObjectModel(
        name=name,
        shape=shape,
        colour=colour,
        rgb=rgb,
        visuals=tuple(
            VisualMesh((solid.mesh.vertices - middle) * scale, solid.mesh.faces, solid.rgb)
            for solid in drawn
            if solid.rgb is not None
        ),
        parts=tuple(part.placed(-middle, scale) for solid in blueprint.solids for part in solid.parts),
        mass=mass * scale**3,
        centre_of_mass=(centre - middle) * scale,
        inertia=inertia * scale**5,
        lateral_friction=LATERAL_FRICTION,
        spinning_friction=blueprint.spinning_friction,
        rolling_friction=blueprint.rolling_friction,
        half_extents=(upper - lower) / 2 * scale,
        grasps=tuple(grasp.placed(-middle, scale) for grasp in blueprint.grasps),
    )


def _mass_properties(solids: Sequence[Solid]) -> tuple[float, FloatArray, FloatArray]:
    """Mass [kg], its centre (3,) [m], and the inertia (3, 3) [kg m^2] about it."""
    masses = np.array([solid.density * solid.mesh.volume for solid in solids])
    centres = np.array([solid.mesh.center_mass for solid in solids])
    mass = float(masses.sum())
    centre = masses @ centres / mass
    inertia = np.zeros((3, 3))
    for solid, part, at in zip(solids, masses, centres - centre, strict=True):
        # trimesh gives the inertia for density 1; the rest moves it to the common centre (parallel axes).
        inertia += solid.density * solid.mesh.moment_inertia + part * (at @ at * np.eye(3) - np.outer(at, at))
    return mass, centre, inertia
