"""The feature spaces of a table seen through a camera, and two worked examples of spaces that a user adds.

A thing on a table is never seen twice alike, so components are not tested for equality. Where people have a convention
of what is one (a colour word, a place for the hand), `kind_width` states it; what is one shape is learned.
"""

import numpy as np

from learning.concepts.feature_space import Colour, Direction, FeatureSpace, Location
from learning.perception.observation import Observation
from robots.pose import FloatArray

PROPORTION_WEIGHT = 0.6
"""What one e-fold of a proportion counts beside the roots of a histogram's bins."""
LEAST_SIDE = 0.003
"""Added to sides before they are compared [m]: a camera does not measure flat things better."""
LIGHTNESS_WEIGHT = 0.75
"""What lightness counts beside saturation: light and shade change it most."""
ADJACENT = 0.30
"""Objects on a table that are further apart than this have no direction from one another [m]."""


class TableColour(Colour):
    """Hue, saturation and lightness of an object's surface, each 0..1; lightness counts less than on the board."""

    of_object = True
    grain = 0.01
    floor = 0.015
    resolution = 0.05
    kinds = "wide"
    kind_width = 0.26

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed H, S, L as (S cos 2 pi H, S sin 2 pi H, w L)."""
        return Colour.embed(values) * (1.0, 1.0, LIGHTNESS_WEIGHT)


class TableShape(FeatureSpace):
    """Fast point feature histogram of what is seen of an object, 33 bins that sum to 1, and its proportions.

    Roots of bins, so that differences of small and large counts are alike (Hellinger distance); logarithms of width and
    height over length, so that a small and a large bottle are of one shape.
    """

    name = "shape"
    dimension = 35
    diagonal = True
    of_object = True
    grain = 0.01
    floor = 0.01
    resolution = 0.1
    correlation = 0.3
    kinds = "learned"

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """Histogram and the three sides [m] of each object, (F, N, 36); sides of 1 where none are known."""
        return cls._with_sides(observation.shape, observation)

    @classmethod
    def glimpsed(cls, observation: Observation) -> FloatArray | None:
        """The same, with histograms of half hidden views too."""
        return cls._with_sides(observation.features.get("glimpsed_shape", observation.shape), observation)

    @staticmethod
    def _with_sides(histograms: FloatArray, observation: Observation) -> FloatArray:
        sides = np.ones((*histograms.shape[:2], 3)) if observation.extent is None else observation.extent
        return np.concatenate([histograms, sides], axis=2)

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed (..., 36) as (..., 35)."""
        values = np.asarray(values, dtype=np.float64)
        bins = np.sqrt(np.maximum(values[..., :33], 0.0))
        sides = np.log(np.maximum(values[..., 33:], 0.0) + LEAST_SIDE)
        return np.concatenate([bins, PROPORTION_WEIGHT * (sides[..., 1:] - sides[..., :1])], axis=-1)


class TableLocation(Location):
    """Where an object is on the table: a place [m]."""

    grain = 0.003
    floor = 0.008
    resolution = 0.02
    kinds = "wide"
    kind_width = 0.12


class TableDirection(Direction):
    """Where one object is as seen from another that is next to it: azimuth and altitude as a unit vector."""

    farthest = ADJACENT
    grain = 0.02
    floor = 0.05
    resolution = 0.1
    kinds = "wide"
    kind_width = 0.7


class TableDistance(FeatureSpace):
    """Distance between two centres, and from the gripper to what it manipulates [m]."""

    name = "distance"
    dimension = 1
    relation = True
    grain = 0.003
    floor = 0.004
    resolution = 0.01
    correlation = 0.4
    kinds = "wide"
    kind_width = 0.056

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed offsets (..., 3) [m] as their length."""
        return np.asarray(np.linalg.norm(np.asarray(values, dtype=np.float64), axis=-1, keepdims=True))


class Size(FeatureSpace):
    """How large an object is: a worked example of a space that a user adds.

    Nothing but the place where it is measured, how values become comparable, and the scales.
    """

    name = "size"
    dimension = 1
    of_object = True
    grain = 0.01
    floor = 0.02
    resolution = 0.05
    correlation = 0.3
    kinds = "wide"
    kind_width = 0.25

    @classmethod
    def measured(cls, observation: Observation) -> FloatArray | None:
        """The feature of that name where perception gives one, else the three sides, (F, N, m) [m]."""
        return observation.features.get(cls.name, observation.extent)

    @staticmethod
    def embed(values: FloatArray) -> FloatArray:
        """Embed sides (..., m) [m] as the logarithm of their geometric mean."""
        sides = np.maximum(np.asarray(values, dtype=np.float64), 0.001)
        return np.asarray(np.log(sides).mean(axis=-1, keepdims=True))


class Weight(FeatureSpace):
    """What an object weighs in the hand [kg]: known only while it hangs there, NaN at all other times."""

    name = "weight"
    dimension = 1
    of_object = True
    in_motion = True
    grain = 0.005
    floor = 0.006
    resolution = 0.02
    correlation = 0.3
    kinds = "wide"
    kind_width = 0.1
