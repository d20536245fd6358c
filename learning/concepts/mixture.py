"""What the incremental mixtures of all kinds have in common."""

from collections.abc import Mapping, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.track_noise import TrackNoise
from robots.pose import FloatArray


class Mixture(Protocol):
    """The concepts of one feature space: `IncrementalMixture` (appendix A), `ModeMixture` or `TrackMixture`.

    Concept numbers are never used twice. A concept that was merged into another stays known as an alias (`resolve`).
    """

    space: type[FeatureSpace]

    @property
    def components(self) -> Mapping[int, Gaussian]:
        """Concept number to component, aliases left out, in ascending order of number."""

    @property
    def names(self) -> Mapping[int, str]:
        """Names that a user gave to concepts, by number."""

    @property
    def numbers_given(self) -> int:
        """How many concept numbers were ever given: numbers are 0 .. this - 1, aliases included."""

    @property
    def weights(self) -> dict[int, float]:
        """Concept number to mixture weight; they sum to 1."""

    def resolve(self, number: int) -> int:
        """The number under which a concept is kept now; itself when it was never merged into another."""

    def update(
        self,
        components: Sequence[Gaussian],
        noise: TrackNoise | None = None,
        names: Sequence[str | None] | None = None,
    ) -> list[int]:
        """Merge the components of one demo; returns the concept number that each became part of.

        Args:
            components: The demo's own mixture.
            noise: Scatter within its tracks.
            names: What a user calls each component, None where nothing was said. Components of one name become one
                concept, and those of different names never do.
        """

    def classify(self, values: FloatArray) -> NDArray[np.int64]:
        """Concept number of each embedded value, (..., d) to (...)."""

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Like `classify`, with the Mahalanobis distance to that concept, both (...)."""

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings."""
