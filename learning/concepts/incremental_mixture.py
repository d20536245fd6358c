"""Incremental Gaussian mixture of one feature space (thesis appendix A, after Song and Wang 2005)."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.concepts.equality_tests import (
    Statistics,
    covariance_p_values,
    mean_log_likelihoods,
    mean_p_values,
)
from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, merged, squared_mahalanobis, stacked
from learning.errors import PerceptionError
from learning.saved_numbers import saved_count
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
        self._demos = 0
        self._prepared: tuple[NDArray[np.int64], FloatArray, FloatArray, FloatArray] | None = None

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
        if not components:
            return []
        self._demos += 1
        first_new = self._next_number
        matches: list[int | None] = [None] * len(components)
        if self._components:
            known = list(self._components)
            likelihood = self._equivalents(components, list(self._components.values()))
            # Line 14: ties are broken by the likelihood of the new values.
            matches = [known[int(np.argmax(row))] if np.any(row > -np.inf) else None for row in likelihood]
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
        self._merge_equivalent(seen, first_new)
        self._prepared = None
        numbers = [self.resolve(number) for number in numbers]
        renamed = self._close_gaps(first_new)
        return [renamed.get(number, number) for number in numbers]

    def classify(self, values: FloatArray) -> NDArray[np.int64]:
        """Concept number of the most likely concept (eq. 3.1, weighted) for each embedded value, (..., d) to (...).

        Raises:
            PerceptionError: There is no concept yet.
        """
        return self.classify_with_distance(values)[0]

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """Like `classify`, with the Mahalanobis distance to that concept, both (...)."""
        if not self._components:
            raise PerceptionError(f"nothing is known of feature space '{self.space.name}' yet: learn from a demo first")
        if self._prepared is None:
            components = self.components
            means, covariances = stacked(list(components.values()), self.space.dimension)
            precisions = np.asarray(np.linalg.inv(covariances), dtype=np.float64)
            _, log_determinants = np.linalg.slogdet(covariances)
            counts = np.array([component.count for component in components.values()])
            # By 3.1 alone the widest component wins far from all means, be it an outlier of two demos that mixed red
            # with yellow: the rest of the Gaussian's log likelihood, and how often each was seen, count as well.
            handicap = log_determinants - 2.0 * np.log(counts / counts.sum())
            self._prepared = np.array(list(components), dtype=np.int64), means, precisions, handicap
        numbers, means, precisions, handicap = self._prepared
        flat = np.asarray(values, dtype=np.float64).reshape(-1, self.space.dimension)
        squared = squared_mahalanobis(flat, means, precisions)
        nearest = np.argmin(squared + handicap, axis=1)
        shape = np.asarray(values).shape[:-1]
        distance = np.sqrt(np.maximum(np.take_along_axis(squared, nearest[:, None], axis=1)[:, 0], 0.0))
        return numbers[nearest].reshape(shape), distance.reshape(shape)

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; `from_json` gives the same mixture back exactly."""
        rows, columns = self._kept_entries()
        return {
            "demos": self._demos,
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
            entries = np.array(entry["covariance"], dtype=np.float64)
            if entries.shape != rows.shape:
                raise ValueError(f"concept {space.name}_{number}: covariance must be {len(rows)} numbers")
            covariance = np.zeros((space.dimension, space.dimension))
            covariance[rows, columns] = entries
            covariance[columns, rows] = entries
            if mean.shape != (space.dimension,) or not np.all(np.isfinite(mean)):
                raise ValueError(f"concept {space.name}_{number}: mean must be {space.dimension} finite numbers")
            if not np.all(np.isfinite(covariance)) or np.any(np.linalg.eigvalsh(covariance) <= 0.0):
                raise ValueError(
                    f"concept {space.name}_{number}: variances must be finite and positive, in every direction"
                )
            count = saved_count(entry["count"], f"concept {space.name}_{number}: count")
            demos = saved_count(entry["demos"], f"concept {space.name}_{number}: demos", least=1)
            if count == 0.0:
                raise ValueError(f"concept {space.name}_{number}: count is 0, expected more")
            mixture._components[int(number)] = Gaussian(mean, covariance, count, int(demos))
        mixture._aliases = {int(number): int(kept) for number, kept in data["aliases"].items()}
        mixture._next_number = int(saved_count(data["next"], f"numbers given in {space.name}"))
        mixture._demos = int(saved_count(data["demos"], f"demos of {space.name}"))
        known = sorted([*mixture._components, *mixture._aliases])
        if len(known) != mixture._next_number or known != list(range(len(known))):
            raise ValueError(
                f"numbers of {space.name} must be 0..{mixture._next_number - 1}, each a concept or an alias"
            )
        if any(kept >= number for number, kept in mixture._aliases.items()):
            raise ValueError(f"aliases of {space.name} must point to smaller numbers")
        return mixture

    def _kept_entries(self) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Rows and columns of the covariance that are stored: its diagonal, or its upper triangle."""
        if self.space.diagonal:
            diagonal = np.arange(self.space.dimension)
            return diagonal, diagonal
        return np.triu_indices(self.space.dimension)

    def _shaped(self, component: Gaussian) -> Gaussian:
        """Drop what the space does not keep of a covariance."""
        if not self.space.diagonal:
            return component
        return Gaussian(component.mean, np.diag(np.diag(component.covariance)), component.count, component.demos)

    def _equivalents(self, new: Sequence[Gaussian], old: Sequence[Gaussian]) -> FloatArray:
        """Log likelihood of each old component for the values of each new one, -inf unless both tests pass, (A, K)."""
        first, second = Statistics.of(new), Statistics.of(old)
        passed = covariance_p_values(first, second, self.space.diagonal) > SIGNIFICANCE
        passed &= mean_p_values(first, second, self.space.correlation, self.space.diagonal) > SIGNIFICANCE
        return np.where(passed, mean_log_likelihoods(first, second), -np.inf)

    def _close_gaps(self, first_new: int) -> dict[int, int]:
        """Number the components that came with this demo and stayed anew: nobody knows those merged at once."""
        stayed = sorted(number for number in self._components if number >= first_new)
        renamed = {number: first_new + index for index, number in enumerate(stayed)}
        for number, new_number in renamed.items():  # downwards, so that none is overwritten
            self._components[new_number] = self._components.pop(number)
        self._aliases = {gone: kept for gone, kept in self._aliases.items() if gone < first_new}
        self._next_number = first_new + len(stayed)
        return renamed

    def _merge_equivalent(self, changed: set[int], first_new: int) -> None:
        """Line 21: merge equivalent components. Pairs in which nothing changed were tested before.

        Two components that are both new were told apart by BIC in one light, which the tests would allow for.
        """
        while changed:
            numbers, rows = list(self._components), sorted(changed)
            components = list(self._components.values())
            likelihood = self._equivalents([self._components[number] for number in rows], components)
            likelihood[np.arange(len(rows)), [numbers.index(number) for number in rows]] = -np.inf
            both_new = (np.array(rows) >= first_new)[:, None] & (np.array(numbers) >= first_new)
            likelihood[both_new] = -np.inf
            row, column = np.unravel_index(int(np.argmax(likelihood)), likelihood.shape)
            if likelihood[row, column] == -np.inf:
                return
            number, match = rows[row], numbers[column]
            kept, gone = min(number, match), max(number, match)
            first, second = self._components[kept], self._components.pop(gone)
            # Some demos may have shown both; which ones was not kept.
            demos = min(first.demos + second.demos, self._demos)
            self._components[kept] = self._shaped(merged(first, second, demos))
            self._aliases[gone] = kept
            changed = (changed - {gone}) | {kept}
