"""Concepts that are groups of parts: what is one for sure is kept as a part, and what is of one kind is found anew.

A merge of two components can not be undone: what looks like one kind after three demos stays one for ever, and widens
what counts as one kind. So only what is one for sure is merged, into parts, and after every demo the parts are grouped
into concepts from the start. A concept keeps its number as long as most of what it held stays together. Where two are
found to be one, the smaller one's number becomes an alias; where one falls apart, the smaller part gets a new number.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.mixture_json import noise_from_json, noise_to_json
from learning.concepts.numbered_components import NumberedComponents
from learning.concepts.part import NO_NUMBER, Part, parts_from_json, parts_to_json, rounded
from learning.concepts.track_noise import TrackNoise
from learning.errors import PerceptionError
from learning.saved_numbers import saved_count
from robots.pose import FloatArray

PATIENCE = 60
"""Demos after which what was seen in only one of them is an outlier."""


class PartMixture(NumberedComponents, ABC):
    """The concepts of one feature space, made of parts. Satisfies `Mixture`.

    Attributes:
        space: The feature space.
    """

    def __init__(self, space: type[FeatureSpace]) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with its scales.
        """
        super().__init__()
        self.space = space
        self._parts: list[Part] = []
        self._noise = TrackNoise.none(space.dimension)
        self._prepared: tuple[NDArray[np.int64], FloatArray, FloatArray] | None = None

    def update(
        self,
        components: Sequence[Gaussian],
        noise: TrackNoise | None = None,
        names: Sequence[str | None] | None = None,
    ) -> list[int]:
        """Take in the components of one demo; each is one sighting.

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
            self._noise = TrackNoise(rounded(summed.scatter), summed.freedom)
        given = names or [None] * len(components)
        places = self._add(
            [
                Part(Gaussian(component.mean, component.covariance, 1.0), self._demos, name=name)
                for component, name in zip(components, given, strict=True)
            ]
        )
        self._number(self._groups_by_name(self._groups()))
        numbers = [self._parts[place].concept for place in places]
        self._forget_outliers()
        self._prepared = None
        return numbers

    @abstractmethod
    def _add(self, sightings: Sequence[Part]) -> list[int]:
        """Make sightings parts, or part of parts that they are one with for sure; returns the place of each."""

    @abstractmethod
    def _groups(self) -> NDArray[np.int64]:
        """Which parts make one concept: a label for each, (n,)."""

    @abstractmethod
    def _axes(self) -> FloatArray:
        """Axes along which concepts are compared, (d, k), scaled so that kinds spread by 1."""

    @abstractmethod
    def _stale(self) -> list[int]:
        """Places of the parts that are outliers."""

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """The nearest concept, all kinds taken to spread alike, and its distance in standard deviations, both (...).

        Raises:
            PerceptionError: There is no concept yet.
        """
        if not self._components:
            raise PerceptionError(f"nothing is known of feature space '{self.space.name}' yet: learn from a demo first")
        if self._prepared is None:
            axes = self._axes()
            means = np.array([component.mean for component in self.components.values()]) @ axes
            self._prepared = np.array(list(self.components), dtype=np.int64), means, axes
        numbers, means, axes = self._prepared
        values = np.asarray(values, dtype=np.float64)
        squared = np.sum(((values @ axes)[..., None, :] - means) ** 2, axis=-1)
        nearest = np.argmin(squared, axis=-1)
        return numbers[nearest], np.sqrt(np.take_along_axis(squared, nearest[..., None], axis=-1)[..., 0])

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same mixture back exactly."""
        return {
            "demos": self._demos,
            "next": self._next_number,
            "aliases": {str(number): kept for number, kept in sorted(self._aliases.items())},
            "parts": parts_to_json(self._parts, self.space, self._common_covariance() is None),
            "noise": noise_to_json(self._noise),
        }

    @classmethod
    def from_json(cls, space: type[FeatureSpace], data: Mapping[str, Any]) -> Self:
        """Rebuild a mixture.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        mixture = cls(space)
        mixture._aliases = {int(number): int(kept) for number, kept in data["aliases"].items()}
        mixture._next_number = int(saved_count(data["next"], f"numbers given in {space.name}"))
        mixture._demos = int(saved_count(data["demos"], f"demos of {space.name}"))
        mixture._noise = noise_from_json(data["noise"], space, "noise")
        mixture._restore(data)
        mixture._parts = parts_from_json(data["parts"], space, mixture._common_covariance())
        mixture._make_components()
        known = sorted([*mixture._components, *mixture._aliases])
        if known != list(range(mixture._next_number)):
            raise ValueError(
                f"numbers of {space.name} must be 0..{mixture._next_number - 1}, each a concept or an alias"
            )
        for number in mixture._aliases:
            seen = {number}
            while number in mixture._aliases:
                number = mixture._aliases[number]
                if number in seen:
                    raise ValueError(f"aliases of {space.name} must end at a concept")
                seen.add(number)
        return mixture

    def _restore(self, data: Mapping[str, Any]) -> None:
        """Read what a mixture keeps besides."""

    def _common_covariance(self) -> FloatArray | None:
        """Covariance of all parts, (d, d); None where each has its own."""
        return None

    def _means(self) -> FloatArray:
        """Means of all parts, (n, d)."""
        return np.array([part.mean for part in self._parts]).reshape(-1, self.space.dimension)

    def _counts(self) -> FloatArray:
        """Sightings of all parts, (n,)."""
        return np.array([part.count for part in self._parts])

    def _groups_by_name(self, groups: NDArray[np.int64]) -> NDArray[np.int64]:
        """Groups in which what a user calls the same is one, and what is called differently never, (n,).

        In a group of several names every part goes with the named one that is nearest.
        """
        named = np.array([place for place, part in enumerate(self._parts) if part.name is not None], dtype=np.int64)
        if not len(named):
            return groups
        places = self._means() @ self._axes()
        names = sorted({str(self._parts[place].name) for place in named})
        result = groups + len(names)
        for place, group in enumerate(groups):
            inside = named[groups[named] == group]
            if len(inside):
                nearest = inside[np.argmin(np.sum((places[inside] - places[place]) ** 2, axis=1))]
                result[place] = names.index(str(self._parts[nearest].name))
        return result

    def _number(self, groups: NDArray[np.int64]) -> None:
        """Give every group of parts a number: that of the concept that most of it was, or a new one."""
        held: dict[int, dict[int, float]] = {}
        for part, group in zip(self._parts, groups.tolist(), strict=True):
            if part.concept != NO_NUMBER:
                shares = held.setdefault(part.concept, {})
                shares[group] = shares.get(group, 0.0) + part.count
        claims: dict[int, list[tuple[float, int]]] = {}
        for number, shares in sorted(held.items()):
            group = max(shares, key=lambda each: shares[each])
            claims.setdefault(group, []).append((-shares[group], number))
        numbers: dict[int, int] = {}
        for group in dict.fromkeys(groups.tolist()):
            if group in claims:
                numbers[group], *others = [number for _, number in sorted(claims[group])]
                self._aliases |= dict.fromkeys(others, numbers[group])
            else:
                numbers[group] = self._next_number
                self._next_number += 1
        self._parts = [
            replace(part, concept=numbers[group]) for part, group in zip(self._parts, groups.tolist(), strict=True)
        ]
        before = dict(self._components)
        self._make_components()
        self._alias_what_is_gone(before)

    def _make_components(self) -> None:
        """Make the concepts of their parts by equations A.1 to A.3."""
        self._components, self._names = {}, {}
        for number in sorted({part.concept for part in self._parts}):
            parts = [part for part in self._parts if part.concept == number]
            counts = np.array([part.count for part in parts])
            means = np.array([part.mean for part in parts])
            mean = counts @ means / counts.sum()
            off = means - mean
            covariance = (counts[:, None] * off).T @ off / counts.sum()
            covariance += np.einsum("k,kij->ij", counts / counts.sum(), [part.gaussian.covariance for part in parts])
            if self.space.diagonal:
                covariance = np.diag(np.diag(covariance))
            once = len({part.last_seen for part in parts}) == 1 and all(part.gaussian.demos == 1 for part in parts)
            demos = 1 if once else min(sum(part.gaussian.demos for part in parts), self._demos)
            self._components[number] = Gaussian(mean, covariance, float(counts.sum()), demos)
            for part in parts:
                if part.name is not None:
                    self._names[number] = part.name

    def _forget_outliers(self) -> None:
        """Forget parts that are outliers; the number of a concept that had no others becomes an alias."""
        stale = set(self._stale())
        if not stale or len(stale) == len(self._parts):
            return
        before = dict(self._components)
        self._parts = [part for place, part in enumerate(self._parts) if place not in stale]
        self._make_components()
        self._alias_what_is_gone(before)

    def _alias_what_is_gone(self, before: Mapping[int, Gaussian]) -> None:
        """Make numbers of concepts that no part has any more aliases of the nearest ones."""
        numbers = list(self._components)
        axes = self._axes()
        means = np.array([self._components[number].mean for number in numbers]) @ axes
        for number, component in before.items():
            if number not in self._components and number not in self._aliases:
                away = np.sum((means - component.mean @ axes) ** 2, axis=1)
                self._aliases[number] = numbers[int(np.argmin(away))]
