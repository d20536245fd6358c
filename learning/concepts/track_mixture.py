"""Concepts of things that are never seen twice alike: what replaces pure IGMM where that splinters.

Song and Wang's tests (appendix A) ask whether two components are *equal*. Two mugs seen by a camera never are: they
differ in size and in the side that they show, every difference is significant with enough frames, and one kind becomes
many concepts. Here two components are one concept when they differ by little *compared with how things of one kind
differ*:

1. The scatter of the values of one track about their mean tells noise, in every direction of the space at once
   (`TrackNoise`), pooled over demos. Tracks are must-link information that needs no label. What was merged tells more:
   the scatter of sightings within concepts. Both together are the spread of a kind.
2. Sightings are compared along the discriminant axes: the generalised eigenvectors of the scatter of all sightings
   against the spread of a kind (Fisher 1936) along which things differ. All others, most of the 33 bins of a
   histogram seen from one side, say nothing.
3. After each demo the closest two concepts are merged as long as the root mean square distance between what they hold
   (average linkage, from the statistics alone) is below `KIND_FACTOR` times that between two things of one kind. Merges
   widen the spread, so this is repeated until nothing changes. Equations A.1 to A.5 give mean, covariance and
   weight, as in appendix A.
4. What was seen in one demo and never again in `PATIENCE` demos is an outlier (a cut-off segment, a hidden half): its
   number becomes an alias of the nearest concept, which it does not change.

Where a space states the width of a kind (`kinds` is `wide`), that is used in the place of 1 and 2.

Kept are the components and two scatters: a demo costs the same however many came before.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, merged
from learning.concepts.mixture_json import components_from_json, components_to_json, noise_from_json, noise_to_json
from learning.concepts.numbered_components import NumberedComponents
from learning.concepts.track_noise import TrackNoise
from learning.errors import PerceptionError
from learning.saved_numbers import saved_count
from robots.pose import FloatArray

PATIENCE = 60
"""Demos after which what was seen in only one of them is an outlier."""
KIND_FACTOR = 2.5
"""Two kinds differ by at least so many times what two things of one kind do. From 2.5 to 2.9 the same shapes come out
of scenes of the tabletop catalogue that were rendered to choose it, in whatever order they are seen."""
LEAST_RATIO = 4.0
"""Axes along which sightings vary by less than this many times the spread of a kind tell nothing."""
PRIOR_MERGES = 60.0
"""What the noise within tracks counts in the spread of a kind, in merged sightings."""
PASSES = 4
"""Times that merging is repeated with the wider spread, at most; the next demo goes on."""
DIGITS = 6
"""Significant decimal digits of what is kept: sensors give four at most, and the file stays small."""


class TrackMixture(NumberedComponents):
    """The concepts of one feature space whose `kinds` are `wide` or `learned`. Satisfies `Mixture`.

    Attributes:
        space: The feature space.
    """

    def __init__(self, space: type[FeatureSpace]) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with its scales.
        """
        if space.kinds == "tested":
            raise ValueError(f"feature space '{space.name}' has kinds that are tested; use IncrementalMixture")
        super().__init__()
        self.space = space
        self._last_seen: dict[int, int] = {}
        self._noise = TrackNoise.none(space.dimension)
        self._within = TrackNoise.none(space.dimension)
        self._prepared: tuple[NDArray[np.int64], FloatArray, FloatArray] | None = None

    def update(
        self,
        components: Sequence[Gaussian],
        noise: TrackNoise | None = None,
        names: Sequence[str | None] | None = None,
    ) -> list[int]:
        """Merge the components of one demo; each is one sighting.

        Args:
            components: The demo's own mixture.
            noise: Scatter within its tracks.
            names: What a user calls each component; None where nothing was said.

        Returns:
            The concept number that each component became part of.
        """
        if not components:
            return []
        self._demos += 1
        if noise is not None:
            summed = self._noise.plus(noise)
            self._noise = TrackNoise(_rounded(summed.scatter), summed.freedom)
        old = set(self._components)
        temporary = self._next_number  # numbers for now; those that are merged at once are never told anybody
        given = names or [None] * len(components)
        for component, name in zip(components, given, strict=True):
            number = self._next_number
            self._next_number += 1
            sighting = Gaussian(component.mean, component.covariance, 1.0)
            self._components[number] = sighting
            self._last_seen[number] = self._demos
            if name is not None:
                self._names[number] = name
        self._spread_names(sorted(old))
        self._merge_names()
        for _ in range(PASSES):
            if not self._merge_kinds():
                break
        self._forget_outliers()
        numbers = [self.resolve(temporary + index) for index in range(len(components))]
        renamed = self._close_gaps(temporary, old)
        self._prepared = None
        return [renamed.get(number, number) for number in numbers]

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """The nearest concept, all kinds taken to spread alike, and its distance in standard deviations, both (...).

        Raises:
            PerceptionError: There is no concept yet.
        """
        if not self._components:
            raise PerceptionError(f"nothing is known of feature space '{self.space.name}' yet: learn from a demo first")
        if self._prepared is None:
            kept = list(self.components.values())
            whiten = self._axes()[0]
            if self.space.kinds == "wide":
                counts = np.array([component.count for component in kept])
                pooled = np.einsum("k,kij->ij", counts / counts.sum(), [each.covariance for each in kept])
                spread, vectors = np.linalg.eigh(pooled)
                whiten = vectors / np.sqrt(spread)
            means = np.array([component.mean for component in kept]) @ whiten
            self._prepared = np.array(list(self.components), dtype=np.int64), means, whiten
        numbers, means, whiten = self._prepared
        flat = np.asarray(values, dtype=np.float64).reshape(-1, self.space.dimension) @ whiten
        squared = np.sum((flat[:, None] - means[None]) ** 2, axis=2)
        nearest = np.argmin(squared, axis=1)
        shape = np.asarray(values).shape[:-1]
        distance = np.sqrt(squared[np.arange(len(flat)), nearest])
        return numbers[nearest].reshape(shape), distance.reshape(shape)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same mixture back exactly."""
        return {
            "demos": self._demos,
            "next": self._next_number,
            "aliases": {str(number): kept for number, kept in sorted(self._aliases.items())},
            "names": {str(number): name for number, name in self.names.items()},
            "last_seen": {str(number): demo for number, demo in sorted(self._last_seen.items())},
            "components": components_to_json(self.components, self.space),
            "noise": noise_to_json(self._noise),
            "within": noise_to_json(self._within),
        }

    @classmethod
    def from_json(cls, space: type[FeatureSpace], data: Mapping[str, Any]) -> "TrackMixture":
        """Rebuild a mixture.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        mixture = cls(space)
        mixture._components = components_from_json(data["components"], space)
        mixture._aliases = {int(number): int(kept) for number, kept in data["aliases"].items()}
        mixture._names = {int(number): str(name) for number, name in data["names"].items()}
        mixture._last_seen = {int(n): int(saved_count(d, "demo of last sight")) for n, d in data["last_seen"].items()}
        mixture._next_number = int(saved_count(data["next"], f"numbers given in {space.name}"))
        mixture._demos = int(saved_count(data["demos"], f"demos of {space.name}"))
        mixture._noise = noise_from_json(data["noise"], space, "noise")
        mixture._within = noise_from_json(data["within"], space, "spread")
        known = sorted([*mixture._components, *mixture._aliases])
        if known != list(range(mixture._next_number)):
            raise ValueError(
                f"numbers of {space.name} must be 0..{mixture._next_number - 1}, each a concept or an alias"
            )
        if set(mixture._last_seen) != set(mixture._components):
            raise ValueError(f"last sights of {space.name} must fit its {len(mixture._components)} concepts")
        for number in mixture._aliases:
            seen = {number}
            while number in mixture._aliases:
                number = mixture._aliases[number]
                if number in seen:
                    raise ValueError(f"aliases of {space.name} must end at a concept")
                seen.add(number)
        return mixture

    def _axes(self) -> tuple[FloatArray, float]:
        """Axes to compare along, (d, k), and the square of the distance along them below which two are one."""
        dimension = self.space.dimension
        if self.space.kinds == "wide":
            return np.eye(dimension) / self.space.kind_width, 1.0
        noise = PRIOR_MERGES * self._noise.covariance(self.space.floor)
        spread = (noise + self._within.scatter) / (PRIOR_MERGES + self._within.freedom)
        counts = np.array([component.count for component in self._components.values()])
        means = np.array([component.mean for component in self._components.values()])
        centred = means - counts @ means / counts.sum()
        total = (self._within.scatter + (counts[:, None] * centred).T @ centred) / counts.sum()
        ratios, vectors = scipy.linalg.eigh(total, spread)
        first = min(int(np.searchsorted(ratios, LEAST_RATIO)), dimension - 1)
        axes = np.asarray(vectors[:, first:], dtype=np.float64)
        if first and self._names:
            axes = np.concatenate([axes, self._named_axes(np.asarray(vectors[:, :first]), spread)], axis=1)
        # Along whitened axes the mean square distance between two things of one kind is twice their number.
        return axes, KIND_FACTOR**2 * 2.0 * axes.shape[1]

    def _named_axes(self, rest: FloatArray, spread: FloatArray) -> FloatArray:
        """Among axes that tell nothing, (d, r), those along which concepts of different names do differ, (d, k).

        A user who tells a fork from a knife says that the direction from one to the other matters.
        """
        named = [self._components[number].mean for number in sorted(self._names) if number in self._components]
        if len(named) < 2:
            return rest[:, :0]
        # Differences in the coordinates of the axes: `rest` is orthonormal in the metric of the spread.
        offsets = (np.array(named[1:]) - named[0]) @ spread @ rest
        _, sizes, directions = np.linalg.svd(offsets, full_matrices=False)
        return np.asarray(rest @ directions[sizes > 1.0].T)

    def _spreads(self, numbers: Sequence[int], axes: FloatArray) -> FloatArray:
        """Mean square distance of what concepts hold from their means, along axes (d, k), (n,)."""
        if self.space.kinds == "wide":
            return np.array([np.sum(axes * (self._components[number].covariance @ axes)) for number in numbers])
        # Kinds spread alike; a single sighting does not spread.
        counts = np.array([self._components[number].count for number in numbers])
        return np.asarray(axes.shape[1] * (counts - 1.0) / counts)

    def _spread_names(self, old: Sequence[int]) -> None:
        """Call the concept that a named sighting would become part of by that name, if it has none."""
        sightings = [number for number in self._names if number not in old]
        if not sightings or not old:
            return
        axes, width = self._axes()
        means = np.array([self._components[number].mean for number in old]) @ axes
        spreads = self._spreads(old, axes)
        for number in sightings:
            squared = np.sum((means - self._components[number].mean @ axes) ** 2, axis=1) + spreads
            nearest = int(np.argmin(squared))
            if squared[nearest] < width:
                self._names.setdefault(old[nearest], self._names[number])

    def _merge_names(self) -> None:
        """Make one concept of all that a user calls the same."""
        for name in sorted(set(self._names.values())):
            first, *others = sorted(number for number, called in self._names.items() if called == name)
            for other in others:
                self._merge(first, other)

    def _merge_kinds(self) -> bool:
        """Line 21 of algorithm 2, with the width of a kind in the place of the tests; returns whether any merged."""
        axes, width = self._axes()
        numbers = sorted(self._components)
        means = np.array([self._components[number].mean for number in numbers]) @ axes
        spreads = self._spreads(numbers, axes)
        squared = np.sum((means[:, None] - means[None]) ** 2, axis=2) + spreads[:, None] + spreads[None]
        names = np.array([self._names.get(number, "") for number in numbers])
        apart = (names[:, None] != names[None]) & (names[:, None] != "") & (names[None] != "")
        np.fill_diagonal(apart, True)
        squared[apart] = np.inf
        merged_any = False
        while len(numbers) > 1:
            row, column = np.unravel_index(int(np.argmin(squared)), squared.shape)
            if not squared[row, column] < width:
                break
            merged_any = True
            first, gone = sorted((int(row), int(column)))
            self._merge(numbers[first], numbers[gone])
            means[first] = self._components[numbers[first]].mean @ axes
            spreads[first] = self._spreads(numbers[first : first + 1], axes)[0]
            apart[first] |= apart[gone]
            apart[:, first] = apart[first]
            away = np.sum((means - means[first]) ** 2, axis=1) + spreads + spreads[first]
            squared[first] = squared[:, first] = np.where(apart[first], np.inf, away)
            numbers.pop(gone)
            means, spreads = np.delete(means, gone, axis=0), np.delete(spreads, gone)
            squared = np.delete(np.delete(squared, gone, axis=0), gone, axis=1)
            apart = np.delete(np.delete(apart, gone, axis=0), gone, axis=1)
        return merged_any

    def _merge(self, kept: int, gone: int) -> None:
        """Merge a concept into another by equations A.1 to A.3."""
        first, second = self._components[kept], self._components.pop(gone)
        between = first.mean - second.mean
        scatter = self._within.scatter + first.count * second.count / (first.count + second.count) * np.outer(
            between, between
        )
        self._within = TrackNoise(_rounded(scatter), self._within.freedom + 1.0)
        same = self._last_seen[kept] == self._last_seen[gone] == self._demos  # two sightings in this demo
        demos = min(first.demos + second.demos - same, self._demos)
        both = merged(first, second, demos)
        covariance = np.diag(np.diag(both.covariance)) if self.space.diagonal else both.covariance
        self._components[kept] = Gaussian(_rounded(both.mean), _rounded(covariance), both.count, demos)
        self._last_seen[kept] = max(self._last_seen[kept], self._last_seen.pop(gone))
        if gone in self._names:
            self._names.setdefault(kept, self._names.pop(gone))
        self._aliases[gone] = kept

    def _forget_outliers(self) -> None:
        """Make aliases of concepts that one demo showed, long ago."""
        stale = [
            number
            for number, component in self._components.items()
            if component.demos == 1 and self._demos - self._last_seen[number] >= PATIENCE and number not in self._names
        ]
        if not stale or len(stale) == len(self._components):
            return
        axes, _ = self._axes()
        lasting = [number for number in sorted(self._components) if number not in stale]
        means = np.array([self._components[number].mean for number in lasting]) @ axes
        for number in stale:
            away = np.sum((means - self._components.pop(number).mean @ axes) ** 2, axis=1)
            self._aliases[number] = lasting[int(np.argmin(away))]
            del self._last_seen[number]

    def _close_gaps(self, first_new: int, old: set[int]) -> dict[int, int]:
        """Number the components that came with this demo and stayed anew: nobody knows those merged at once."""
        stayed = sorted(number for number in self._components if number not in old)
        renamed = {number: first_new + index for index, number in enumerate(stayed)}
        for number, new_number in renamed.items():  # downwards, so that none is overwritten
            self._components[new_number] = self._components.pop(number)
            self._last_seen[new_number] = self._last_seen.pop(number)
            if number in self._names:
                self._names[new_number] = self._names.pop(number)
        self._aliases = {gone: renamed.get(k, k) for gone, k in self._aliases.items() if gone < first_new}
        self._next_number = first_new + len(stayed)
        return renamed


def _rounded(values: FloatArray) -> FloatArray:
    """Values to `DIGITS` significant digits."""
    values = np.asarray(values, dtype=np.float64)
    magnitude = np.maximum(np.abs(values), 1e-100)  # what is smaller is 0
    scale = 10.0 ** (DIGITS - 1 - np.floor(np.log10(magnitude)))
    return np.asarray(np.round(values * scale) / scale)
