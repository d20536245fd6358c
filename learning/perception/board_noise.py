"""True states of the board made into what a sensor would measure (thesis 3.5.7, design section 7)."""

import colorsys
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from learning.perception.descriptors import board_descriptors
from learning.perception.observation import Observation
from robots.pose import FloatArray
from twin.scene_spec import ObjectSpec


@dataclass(frozen=True, slots=True)
class BoardNoise:
    """Standard deviations of the Gaussian noise on every feature.

    Attributes:
        location: Of each coordinate of objects and gripper [m].
        colour: Of H, S and L, in every frame.
        lighting: Of a shift of H, S and L that a whole demo has in common.
        shape: Of every FPFH bin, as a share of its value.
    """

    location: float = 0.003
    colour: float = 0.03
    lighting: float = 0.02
    shape: float = 0.05


BOARD_NOISE = BoardNoise()
FRAME_TIME = 0.1
"""Time between two frames of an observation [s]."""


@dataclass(frozen=True, slots=True)
class TrueTracks:
    """Noise-free tracks over F frames of the gripper and N objects.

    Attributes:
        times: (F,) [s].
        gripper_location: Tool frame in the world, (F, 3) [m].
        gripper_closed: (F,) bool.
        location: Object centres in the world, (F, N, 3) [m].
    """

    times: FloatArray
    gripper_location: FloatArray
    gripper_closed: NDArray[np.bool_]
    location: FloatArray


def observed(
    tracks: TrueTracks, objects: Sequence[ObjectSpec], rng: np.random.Generator, noise: BoardNoise = BOARD_NOISE
) -> Observation:
    """Look at tracks through noise. Of the objects' specification only looks are used: rgb numbers and the mesh.

    Args:
        tracks: The truth.
        objects: The N objects in the order of the tracks.
        rng: Source of the noise.
        noise: Its standard deviations.

    Raises:
        PerceptionError: An object is none of the board's.
    """
    frames, number = tracks.location.shape[:2]
    descriptors = board_descriptors()
    for thing in objects:
        if thing.model is not None:
            raise PerceptionError(
                f"object {thing.id} is a {thing.shape} of a table scene, which only a camera sees; "
                f"on the board there are {', '.join(descriptors)}"
            )
    looks = np.array([hsl(thing.rgb) for thing in objects]).reshape(number, 3)
    colour = looks + rng.normal(0.0, noise.lighting, 3) + rng.normal(0.0, noise.colour, (frames, number, 3))
    colour[..., 0] %= 1.0
    np.clip(colour[..., 1:], 0.0, 1.0, out=colour[..., 1:])
    shape = np.array([descriptors[thing.shape] for thing in objects]).reshape(number, 33)
    shape = np.maximum(shape * (1.0 + rng.normal(0.0, noise.shape, (frames, number, 33))), 0.0)
    return Observation(
        times=tracks.times,
        gripper_location=tracks.gripper_location + rng.normal(0.0, noise.location, (frames, 3)),
        gripper_closed=tracks.gripper_closed,
        object_ids=np.array([thing.id for thing in objects], dtype=np.int64),
        location=tracks.location + rng.normal(0.0, noise.location, (frames, number, 3)),
        colour=colour,
        shape=shape,
    )


def hsl(rgb: tuple[float, float, float]) -> tuple[float, float, float]:
    """Hue, saturation, lightness in 0..1 of red, green, blue in 0..1."""
    hue, lightness, saturation = colorsys.rgb_to_hls(*rgb)
    return hue, saturation, lightness
