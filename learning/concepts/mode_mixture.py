"""Concepts of spaces in which people have a convention of how wide a kind is: the modes of what was seen.

1. Sightings whose root mean square distance is below the width of a kind are parts (average linkage).
2. The density of all parts, smoothed at the scale of that width, has modes. What climbs to one mode is one concept
   (mean shift): the few things between two places are no place of their own, and half way between left and front is
   not a direction of its own, until there are as many of them as there are of others.
3. A part that one demo showed and no other in `PATIENCE` demos is an outlier, and is forgotten.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, merged, stacked
from learning.concepts.linkage import average_linkage
from learning.concepts.modes import bandwidth, mode_holders
from learning.concepts.part import Part, rounded
from learning.concepts.part_mixture import PATIENCE, PartMixture
from robots.pose import FloatArray


class ModeMixture(PartMixture):
    """The concepts of one feature space whose `kinds` are `wide`. Satisfies `Mixture`."""

    def __init__(self, space: type[FeatureSpace]) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with the width of a kind.
        """
        if space.kinds != "wide":
            raise ValueError(f"feature space '{space.name}' has kinds that are {space.kinds}, not wide")
        super().__init__(space)

    def _add(self, sightings: Sequence[Part]) -> list[int]:
        """Join what is nearer than the width of a kind, and is not called differently."""
        parts = [*self._parts, *sightings]
        means, covariances = stacked([part.gaussian for part in parts], self.space.dimension)
        called = np.array([part.name or "" for part in parts])
        apart = (called[:, None] != called[None]) & (called[:, None] != "") & (called[None] != "")
        spreads = np.trace(covariances, axis1=1, axis2=2)
        counts = np.array([part.count for part in parts])
        labels = average_linkage(means, spreads, counts, self.space.kind_width**2, apart)
        joined: dict[int, Part] = {}
        for part, label in zip(parts, labels.tolist(), strict=True):
            known = joined.get(label)
            joined[label] = part if known is None else known.joined(part, _merged(known, part))
        self._parts = list(joined.values())
        places = list(joined)
        return [places.index(label) for label in labels[len(labels) - len(sightings) :].tolist()]

    def _groups(self) -> NDArray[np.int64]:
        """What climbs to one mode is one."""
        means, covariances = stacked([part.gaussian for part in self._parts], self.space.dimension)
        counts = self._counts()
        return mode_holders(means, counts, bandwidth(self.space.kind_width, covariances, counts, self.space.floor))

    def _axes(self) -> FloatArray:
        """Axes in which parts spread by 1 on the whole, (d, d)."""
        _, covariances = stacked([part.gaussian for part in self._parts], self.space.dimension)
        counts = self._counts()
        spread, vectors = np.linalg.eigh(np.einsum("k,kij->ij", counts / counts.sum(), covariances))
        return np.asarray(vectors / np.sqrt(spread))

    def _stale(self) -> list[int]:
        """Parts that one demo showed, long ago."""
        return [
            place
            for place, part in enumerate(self._parts)
            if part.gaussian.demos == 1 and self._demos - part.last_seen >= PATIENCE and part.name is None
        ]


def _merged(one: Part, other: Part) -> Gaussian:
    """Statistics of both, rounded so that the file stays small."""
    both = merged(one.gaussian, other.gaussian, demos=1)
    return Gaussian(rounded(both.mean), rounded(both.covariance), both.count)
