"""The feature spaces in which concepts are found, one small class each (thesis 3.3.2 and 3.3.3).

A class says where its values are measured (`measured`), turns them into vectors in which near means alike (`embed`),
and states the scales at which its space is looked at. The classes here are those of the board, `table_spaces` holds
those of a table seen through a camera, and `space_set` says how a new one is added.
"""

from typing import ClassVar, Literal

import numpy as np

from learning.perception.observation import Observation
from robots.pose import FloatArray

NEAR = 0.0845
"""Objects whose centres are closer than this relate to one another [m]: a bit more than twice the side of a block, so
that a block relates to those in the cells around, above and below it, diagonals included."""
FAR = 0.13
"""What every distance beyond `NEAR` counts as [m]: perception tells near distances apart, and far is just far."""

Kinds = Literal["tested", "wide", "learned"]


class FeatureSpace:
    """What a feature space must say about itself.

    Attributes:
        name: Short name, as in the concept id `colour_3`.
        dimension: Length d of an embedded value.
        diagonal: Whether covariances are kept diagonal.
        shared_noise: Whether the components of one demo are fitted with one covariance, that of the sensor. A component
            of its own for a few values then costs few parameters, so that BIC does not lump rare things together.
        grain: Standard deviation added in the fit of one demo (`reg_covar`): finer structure is not looked for.
        floor: Standard deviation below which differences mean nothing: its square is added to a concept's variances.
        resolution: Modes closer than this start out as one in the search for the number of components.
        correlation: Share of a value's variance that all values of one demo have in common (intraclass correlation):
            light, placement and viewpoint stay the same within a demo, so its values are not independent draws.
        relation: Whether its values are offsets between two things, rather than properties of one.
        farthest: Pairs of things further apart than this have no value in a space of relations [m].
        of_object: Whether a value belongs to the object wherever it rests, so that all its values are known to be of
            one thing, in whatever place and turned whichever way; else to the object in its place.
        in_motion: Whether a value is measured while the object moves too, and not only at rest.
        kinds: How concepts are told apart over demos. `tested`: their covariances and means are tested for equality
            (`IncrementalMixture`). `wide`: what climbs to one mode, at the scale of `kind_width`, is one
            (`ModeMixture`). `learned`: how much things of one kind differ is learned from the tracks and from what is
            of one kind (`TrackMixture`).
        kind_width: Root mean square distance, embedded, between what two concepts hold, below which they are one;
            for `wide` only.
    """

    name: ClassVar[str]
    dimension: ClassVar[int]
    relation: ClassVar[bool] = False
    farthest: ClassVar[float] = np.inf
    of_object: ClassVar[bool] = False
    in_motion: ClassVar[bool] = False
    kinds: ClassVar[Kinds] = "tested"
    kind_width: ClassVar[float] = 0.0
    diagonal: ClassVar[bool] = False
    shared_noise: ClassVar[bool] = True
    grain: ClassVar[float]
    floor: ClassVar[float]
    resolution: ClassVar[float]
    correlation: ClassVar[float]

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """Measured values of a property, (F, N, m); NaN where one is not known, None where none is.

        Unless a space says otherwise they are `Observation.features` of its name. Relations measure offsets.
        """
        return observation.features.get(cls.name)

    @classmethod
    def glimpsed(cls, observation: Observation) -> FloatArray | None:
        """As `measured`, also where a thing was seen badly: what that changes is no difference between things.

        Only spaces that learn how much things of one kind differ ask for it.
        """
        return cls.measured(observation)

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed measured values, (..., m) to (..., d)."""
        return np.asarray(values, dtype=np.float64)


class Colour(FeatureSpace):
    """Hue, saturation and lightness, each 0..1.

    Hue is an angle about the axis of greys: red does not break where hue wraps, and a grey has no hue.
    """

    name = "colour"
    dimension = 3
    grain = 0.08
    floor = 0.08
    resolution = 0.35
    correlation = 0.3

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """What the tracks hold."""
        return observation.colour

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed H, S, L as (S cos 2 pi H, S sin 2 pi H, L)."""
        hue, saturation, lightness = np.moveaxis(np.asarray(values, dtype=np.float64), -1, 0)
        angle = 2.0 * np.pi * hue
        return np.stack([saturation * np.cos(angle), saturation * np.sin(angle), lightness], axis=-1)


class Shape(FeatureSpace):
    """Fast point feature histogram of an object, 33 bins that sum to 1."""

    name = "shape"
    dimension = 33
    diagonal = True
    shared_noise = False
    grain = 0.001
    floor = 0.003
    resolution = 0.03
    correlation = 0.3

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """What the tracks hold."""
        return observation.shape


class Location(FeatureSpace):
    """Where an object is, projected onto the table: a place [m]. Height stays with the tracks."""

    name = "location"
    dimension = 2
    grain = 0.003
    floor = 0.008
    resolution = 0.025
    correlation = 0.5

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """What the tracks hold."""
        return observation.location

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Keep x and y of (..., 3)."""
        return np.asarray(values, dtype=np.float64)[..., :2]


class Direction(FeatureSpace):
    """Where one object is as seen from another: azimuth and altitude as a unit vector."""

    name = "direction"
    dimension = 3
    relation = True
    farthest = NEAR
    grain = 0.03
    floor = 0.08
    resolution = 0.3
    correlation = 0.3

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed offsets (..., 3) [m] as unit vectors; a zero offset has none and stays zero."""
        offsets = np.asarray(values, dtype=np.float64)
        length = np.linalg.norm(offsets, axis=-1, keepdims=True)
        return np.asarray(np.divide(offsets, length, out=np.zeros_like(offsets), where=length > 0.0))

    @staticmethod
    def azimuth_altitude(offsets: FloatArray) -> FloatArray:
        """The thesis's two angles [rad] of offsets (..., 3): azimuth from +x towards +y, altitude above the table."""
        x, y, z = np.moveaxis(np.asarray(offsets, dtype=np.float64), -1, 0)
        return np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))], axis=-1)


class Distance(FeatureSpace):
    """Distance between two centres [m]; all that is beyond `NEAR` is the same far."""

    name = "distance"
    dimension = 1
    relation = True
    farthest = NEAR
    grain = 0.004
    floor = 0.008
    resolution = 0.018
    correlation = 0.4

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed offsets (..., 3) [m] as their length, `FAR` where it exceeds `NEAR`."""
        length = np.linalg.norm(np.asarray(values, dtype=np.float64), axis=-1, keepdims=True)
        return np.where(length > NEAR, FAR, length)


FEATURE_SPACES: dict[str, type[FeatureSpace]] = {
    space.name: space for space in (Colour, Shape, Location, Direction, Distance)
}
"""The feature spaces of the board by name."""
PROPERTIES = ("colour", "shape", "location")
RELATIONS = ("direction", "distance")
