"""Concepts of things that are never seen twice alike: what replaces pure IGMM where that splinters.

Song and Wang's tests (appendix A) ask whether two components are *equal*. Two mugs seen by a camera never are: they
differ in size and in the side that they show, every difference is significant with enough frames, and one kind becomes
many concepts. Here two things are of one kind when they differ by little *compared with how things of one kind differ*:

1. The scatter of the values of one track about their mean tells noise, in every direction of the space at once
   (`TrackNoise`), pooled over demos. Tracks are must-link information that needs no label. Sightings that differ by
   less than noise are one part: the same thing, as far as anybody can tell.
2. The spread of a kind is that noise, and the scatter of parts within kinds as far as they are known.
3. Parts are compared along the discriminant axes: the generalised eigenvectors of the scatter of all parts against the
   spread of a kind (Fisher 1936) along which things differ. All others, most of the 33 bins of a histogram seen from
   one side, say nothing.
4. Parts are joined as long as the root mean square distance between what two kinds hold (average linkage) is below
   `KIND_FACTOR` times that between two things of one kind. That widens the spread, so 2 to 4 are repeated until nothing
   changes. All of this starts anew with every demo (`PartMixture`).
5. A concept that one demo showed and no other in `PATIENCE` demos is an outlier (a cut-off segment), and is forgotten.

Kept are the means of the parts and two scatters: a demo costs the same however many came before.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.linkage import average_linkage
from learning.concepts.mixture_json import noise_from_json, noise_to_json
from learning.concepts.part import Part, rounded
from learning.concepts.part_mixture import PATIENCE, PartMixture
from learning.concepts.track_noise import TrackNoise
from robots.pose import FloatArray

KIND_FACTOR = 2.5
"""Two kinds differ by at least so many times what two things of one kind do. From 2.5 to 2.9 the same shapes come out
of scenes of the tabletop catalogue that were rendered to choose it, in whatever order they are seen."""
LEAST_RATIO = 4.0
"""Axes along which sightings vary by less than this many times the spread of a kind tell nothing."""
PRIOR_SIGHTINGS = 60.0
"""What the noise within tracks counts in the spread of a kind, in sightings."""
PASSES = 4
"""Times that joining is repeated with the wider spread, at most; the next demo goes on."""
MOST_PARTS = 48
"""Parts that are kept at most; of more, the two that differ least are made one."""


class TrackMixture(PartMixture):
    """The concepts of one feature space whose `kinds` are `learned`. Satisfies `Mixture`."""

    def __init__(self, space: type[FeatureSpace]) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with its scales.
        """
        if space.kinds != "learned":
            raise ValueError(f"feature space '{space.name}' has kinds that are {space.kinds}, not learned")
        super().__init__(space)
        self._within = TrackNoise.none(space.dimension)
        self._kinds: tuple[NDArray[np.int64], FloatArray] | None = None

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same mixture back exactly."""
        return super().to_json() | {"within": noise_to_json(self._within)}

    def _restore(self, data: Mapping[str, Any]) -> None:
        """Read the scatter within parts."""
        self._within = noise_from_json(data["within"], self.space, "spread")

    def _common_covariance(self) -> FloatArray:
        """How the sightings of a part scatter, (d, d)."""
        return self._within.covariance(self.space.floor)

    def _add(self, sightings: Sequence[Part]) -> list[int]:
        """Make each sighting part of the nearest one that it differs from by less than noise, else a new one."""
        self._kinds = None
        whiten = np.linalg.inv(np.linalg.cholesky(self._noise.covariance(self.space.floor))).T
        places = []
        for sighting in sightings:
            away = np.sum(((self._means() - sighting.mean) @ whiten) ** 2, axis=1)
            away[[part.name is not None and sighting.name not in (None, part.name) for part in self._parts]] = np.inf
            place = int(np.argmin(away)) if len(away) else 0
            # Two sightings of one thing are twice the noise apart along every axis.
            if len(away) and away[place] < 2.0 * self.space.dimension:
                self._parts[place] = self._joined(self._parts[place], sighting)
            else:
                place = len(self._parts)
                mean = self._rounded_mean(sighting.mean)
                self._parts.append(replace(sighting, gaussian=replace(sighting.gaussian, mean=mean)))
            places.append(place)
        while len(self._parts) > MOST_PARTS:
            kept, gone = self._closest(whiten)
            self._parts[kept] = self._joined(self._parts[kept], self._parts.pop(gone))
            places = [kept if place == gone else place - (place > gone) for place in places]
        common = self._common_covariance()
        self._parts = [replace(part, gaussian=replace(part.gaussian, covariance=common)) for part in self._parts]
        return places

    def _joined(self, one: Part, other: Part) -> Part:
        """Both as one; how they differ tells how the sightings of a part scatter."""
        count = one.count + other.count
        between = other.mean - one.mean
        scatter = self._within.scatter + one.count * other.count / count * np.outer(between, between)
        self._within = TrackNoise(rounded(scatter), self._within.freedom + 1.0)
        mean = self._rounded_mean(one.mean + other.count / count * between)
        return one.joined(other, Gaussian(mean, one.gaussian.covariance, count))

    def _rounded_mean(self, mean: FloatArray) -> FloatArray:
        """A mean (d,) to a hundredth of what means nothing or finer, so that the file stays small."""
        return np.asarray(np.round(mean, int(np.ceil(2.0 - np.log10(self.space.floor)))))

    def _closest(self, whiten: FloatArray) -> tuple[int, int]:
        """Places of the two parts that differ least and are not called differently."""
        means = self._means() @ whiten
        away = np.sum((means[:, None] - means[None]) ** 2, axis=2)
        away[self._apart() | np.eye(len(means), dtype=bool)] = np.inf
        kept, gone = np.unravel_index(int(np.argmin(away)), away.shape)
        return min(int(kept), int(gone)), max(int(kept), int(gone))

    def _apart(self) -> NDArray[np.bool_]:
        """Pairs of parts that a user calls differently, (n, n)."""
        called = np.array([part.name or "" for part in self._parts])
        return np.asarray((called[:, None] != called[None]) & (called[:, None] != "") & (called[None] != ""))

    def _groups(self) -> NDArray[np.int64]:
        """Parts of one kind."""
        return self._found()[0]

    def _axes(self) -> FloatArray:
        """The discriminant axes."""
        return self._found()[1]

    def _found(self) -> tuple[NDArray[np.int64], FloatArray]:
        """Labels of the parts, (n,), and the axes along which they were compared, (d, k)."""
        if self._kinds is None:
            means, counts = self._means(), self._counts()
            centred = means - counts @ means / counts.sum()
            total = (self._within.scatter + (counts[:, None] * centred).T @ centred) / counts.sum()
            labels, within = np.arange(len(means)), self._within
            for _ in range(PASSES):
                axes = self._discriminant(total, within)
                dimension = axes.shape[1]
                spreads = dimension * (counts - 1.0) / counts
                # Along whitened axes the mean square distance between two things of one kind is twice their number.
                width = KIND_FACTOR**2 * 2.0 * dimension
                found = average_linkage(means @ axes, spreads, counts, width, self._apart(), alike=True)
                if np.array_equal(found, labels):
                    break
                labels, within = found, self._scatter(found)
            self._kinds = labels, axes
        return self._kinds

    def _discriminant(self, total: FloatArray, within: TrackNoise) -> FloatArray:
        """Axes along which parts vary more than a kind spreads, (d, k): at least one."""
        noise = PRIOR_SIGHTINGS * self._noise.covariance(self.space.floor)
        spread = (noise + within.scatter) / (PRIOR_SIGHTINGS + within.freedom)
        ratios, vectors = scipy.linalg.eigh(total, spread)
        first = min(int(np.searchsorted(ratios, LEAST_RATIO)), self.space.dimension - 1)
        axes = np.asarray(vectors[:, first:], dtype=np.float64)
        named = self._named_axes(np.asarray(vectors[:, :first]), spread)
        return np.concatenate([axes, named], axis=1)

    def _named_axes(self, rest: FloatArray, spread: FloatArray) -> FloatArray:
        """Among axes that tell nothing, (d, r), those along which parts of different names do differ, (d, k).

        A user who tells a fork from a knife says that the direction from one to the other matters.
        """
        means: dict[str, FloatArray] = {}
        for part in self._parts:
            if part.name is not None:
                means.setdefault(part.name, part.mean)
        if len(means) < 2 or not rest.shape[1]:
            return rest[:, :0]
        first, *others = (means[name] for name in sorted(means))
        # Differences in the coordinates of the axes: `rest` is orthonormal in the metric of the spread.
        offsets = (np.array(others) - first) @ spread @ rest
        _, sizes, directions = np.linalg.svd(offsets, full_matrices=False)
        return np.asarray(rest @ directions[sizes > 1.0].T)

    def _scatter(self, labels: NDArray[np.int64]) -> TrackNoise:
        """The scatter within kinds: that within parts, and of parts about the means of their kinds."""
        means, counts = self._means(), self._counts()
        scatter = self._within.scatter.copy()
        kinds = np.unique(labels)
        for kind in kinds:
            inside = labels == kind
            off = means[inside] - counts[inside] @ means[inside] / counts[inside].sum()
            scatter += (counts[inside, None] * off).T @ off
        return TrackNoise(scatter, float(counts.sum()) - len(kinds))

    def _stale(self) -> list[int]:
        """Parts of concepts that one demo showed, long ago."""
        return [
            place
            for place, part in enumerate(self._parts)
            if self._components[part.concept].demos == 1
            and self._demos - part.last_seen >= PATIENCE
            and part.concept not in self._names
        ]

    def _forget_outliers(self) -> None:
        """Forget them; kinds are found anew when they are next asked for."""
        parts = len(self._parts)
        super()._forget_outliers()
        if len(self._parts) != parts:
            self._kinds = None
