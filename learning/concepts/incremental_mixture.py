"""Incremental Gaussian mixture of one feature space (thesis appendix A, after Song and Wang 2005)."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.concepts.equality_tests import (
    SHAPE_CORRELATION,
    covariance_p_value,
    effective_size,
    mean_p_value,
)
from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, merged, squared_mahalanobis, stacked
from robots.pose import FloatArray

SIGNIFICANCE = 0.001
"""Both tests reject equality below this p-value: a demo compares some sixty components, and one false alarm makes a
concept that should not be."""


class IncrementalMixture:
    """The concepts of one feature space. Only these components are kept, no values.

    Concept numbers are never used twice: number n keeps its meaning as learning goes on. When two old components turn
    out to be equivalent, the smaller number stays and the larger becomes an alias of it (`resolve`).
    """

    def __init__(self, space: type[FeatureSpace]) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with its scales.
        """
        self.space = space
        self._components: dict[int, Gaussian] = {}
        self._aliases: dict[int, int] = {}
        self._next_number = 0
        self._prepared: tuple[NDArray[np.int64], FloatArray, FloatArray] | None = None

    @property
    def components(self) -> Mapping[int, Gaussian]:
        """Concept number to component, aliases left out, in ascending order of number."""
        return dict(sorted(self._components.items()))

    @property
    def numbers_given(self) -> int:
        """How many concept numbers were ever given: numbers are 0 .. this - 1, aliases included."""
        return self._next_number

    @property
    def weights(self) -> dict[int, float]:
        """Concept number to mixture weight pi (A.3, A.4, A.5); they sum to 1."""
        total = sum(component.count for component in self._components.values())
        return {number: component.count / total for number, component in self.components.items()}

    def resolve(self, number: int) -> int:
        """The number under which a concept is kept now; itself when it was never merged into an older one."""
        while number in self._aliases:
            number = self._aliases[number]
        return number

    def update(self, components: Sequence[Gaussian]) -> list[int]:
        """Merge the components of one demo into the mixture (algorithm 2).

        Takes time in proportion to the number of concepts, whatever the number of demos seen.

        Args:
            components: The demo's own mixture.

        Returns:
            The concept number that each component became part of.
        """
        old = dict(self._components)
        matches = [self._most_likely_equivalent(component, old) for component in components]
        numbers: list[int] = []
        seen: set[int] = set()
        for component, match in zip(components, matches, strict=True):
            if match is None:  # (A.4): its weight is its share of the new total
                number = self._next_number
                self._next_number += 1
                self._components[number] = component
            else:  # (A.1) to (A.3)
                number = match
                kept = self._components[number]
                # Two components of one demo that match the same concept are one sighting of it.
                self._components[number] = self._shaped(merged(kept, component, kept.demos + (number not in seen)))
            seen.add(number)
            numbers.append(number)
        self._merge_equivalent(seen)
        self._prepared = None
        return [self.resolve(number) for number in numbers]

    def classify(self, values: FloatArray) -> NDArray[np.int64]:
        """Concept number with the smallest Mahalanobis distance (eq. 3.1) to each embedded value, (..., d) to (...).

        Raises:
            ValueError: There is no concept yet.
        """
        return self.classify_with_distance(values)[0]

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Like `classify`, with the Mahalanobis distance to that concept, both (...)."""
        if not self._components:
            raise ValueError(f"feature space {self.space.name} has no concept yet: update it with a demo first")
        if self._prepared is None:
            components = self.components
            means, covariances = stacked(list(components.values()), self.space.dimension)
            self._prepared = np.array(list(components), dtype=np.int64), means, np.linalg.inv(covariances)
        numbers, means, precisions = self._prepared
        flat = np.asarray(values, dtype=np.float64).reshape(-1, self.space.dimension)
        squared = squared_mahalanobis(flat, means, precisions)
        nearest = np.argmin(squared, axis=1)
        shape = np.asarray(values).shape[:-1]
        distance = np.sqrt(np.maximum(np.take_along_axis(squared, nearest[:, None], axis=1)[:, 0], 0.0))
        return numbers[nearest].reshape(shape), distance.reshape(shape)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same mixture back exactly."""
        rows, columns = self._kept_entries()
        return {
            "next": self._next_number,
            "aliases": {str(number): kept for number, kept in sorted(self._aliases.items())},
            "components": {
                str(number): {
                    "mean": component.mean.tolist(),
                    "covariance": component.covariance[rows, columns].tolist(),
                    "count": component.count,
                    "demos": component.demos,
                }
                for number, component in self.components.items()
            },
        }

    @classmethod
    def from_json(cls, space: type[FeatureSpace], data: Mapping[str, Any]) -> "IncrementalMixture":
        """Rebuild a mixture.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        mixture = cls(space)
        rows, columns = mixture._kept_entries()
        for number, entry in data["components"].items():
            mean = np.array(entry["mean"], dtype=np.float64)
            covariance = np.zeros((space.dimension, space.dimension))
            covariance[rows, columns] = entry["covariance"]
            covariance[columns, rows] = entry["covariance"]
            if mean.shape != (space.dimension,) or not np.all(np.isfinite(mean)):
                raise ValueError(f"concept {space.name}_{number}: mean must be {space.dimension} finite numbers")
            if not np.all(np.isfinite(covariance)) or np.any(np.diag(covariance) <= 0.0):
                raise ValueError(f"concept {space.name}_{number}: variances must be finite and positive")
            mixture._components[int(number)] = Gaussian(mean, covariance, float(entry["count"]), int(entry["demos"]))
        mixture._aliases = {int(number): int(kept) for number, kept in data["aliases"].items()}
        mixture._next_number = int(data["next"])
        if any(kept >= number for number, kept in mixture._aliases.items()):
            raise ValueError(f"aliases of {space.name} must point to smaller numbers")
        return mixture

    def _kept_entries(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Rows and columns of the covariance that are stored: its diagonal, or its upper triangle."""
        if self.space.diagonal:
            return np.diag_indices(self.space.dimension)
        return np.triu_indices(self.space.dimension)

    def _shaped(self, component: Gaussian) -> Gaussian:
        """Drop what the space does not keep of a covariance."""
        if not self.space.diagonal:
            return component
        return Gaussian(component.mean, np.diag(np.diag(component.covariance)), component.count, component.demos)

    def _most_likely_equivalent(self, component: Gaussian, among: Mapping[int, Gaussian]) -> int | None:
        """The component that passes both tests, ties broken by the likelihood of the new values (lines 8 to 14)."""
        if not among:
            return None
        numbers = list(among)
        others = list(among.values())
        means, covariances = stacked(others, self.space.dimension)
        counts = np.array([other.count for other in others])
        demos = np.array([other.demos for other in others], dtype=np.float64)
        own_count, own_demos = np.array(component.count), np.array(component.demos)
        spread_size = effective_size(own_count, own_demos, SHAPE_CORRELATION)
        other_spread_size = effective_size(counts, demos, SHAPE_CORRELATION)
        same_covariance = covariance_p_value(
            component.covariance,
            covariances,
            spread_size * other_spread_size / (spread_size + other_spread_size),
            self.space.diagonal,
        )
        same_mean = mean_p_value(
            component.mean,
            component.covariance,
            component.count,
            float(effective_size(own_count, own_demos, self.space.correlation)),
            means,
            covariances,
            counts,
            effective_size(counts, demos, self.space.correlation),
        )
        passed = (same_covariance > SIGNIFICANCE) & (same_mean > SIGNIFICANCE)
        if not np.any(passed):
            return None
        likelihood = _mean_log_likelihood(component, means, covariances)
        return numbers[int(np.argmax(np.where(passed, likelihood, -np.inf)))]

    def _merge_equivalent(self, changed: set[int]) -> None:
        """Line 21: merge equivalent components. Pairs in which nothing changed were tested before."""
        queue = sorted(changed)
        while queue:
            number = queue.pop(0)
            if number not in self._components:
                continue
            rest = {other: component for other, component in self._components.items() if other != number}
            match = self._most_likely_equivalent(self._components[number], rest)
            if match is None:
                continue
            kept, gone = min(number, match), max(number, match)
            first, second = self._components[kept], self._components.pop(gone)
            demos = max(first.demos, second.demos) if gone in changed and kept in changed else first.demos + second.demos
            self._components[kept] = self._shaped(merged(first, second, demos))
            self._aliases[gone] = kept
            queue.append(kept)


def _mean_log_likelihood(component: Gaussian, means: FloatArray, covariances: FloatArray) -> FloatArray:
    """Mean log likelihood of a component's values under each other component, (K,), from its statistics alone."""
    precisions = np.linalg.inv(covariances)
    _, log_determinant = np.linalg.slogdet(covariances)
    squared = squared_mahalanobis(component.mean[None, :], means, precisions)[0]
    spread = np.einsum("kij,ji->k", precisions, component.covariance)
    return np.asarray(-0.5 * (component.mean.shape[0] * np.log(2.0 * np.pi) + log_determinant + spread + squared))
