"""Incremental Gaussian mixture of one feature space (thesis appendix A, after Song and Wang 2005)."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.concepts.equality_tests import (
    CLUSTERED,
    EqualityRules,
    Statistics,
    covariance_p_values,
    mean_log_likelihoods,
    mean_p_values,
)
from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian, merged, squared_mahalanobis, stacked
from learning.concepts.mixture_json import components_from_json, components_to_json
from learning.concepts.numbered_components import NumberedComponents
from learning.concepts.track_noise import TrackNoise
from learning.errors import PerceptionError
from learning.saved_numbers import saved_count
from robots.pose import FloatArray

SIGNIFICANCE = 0.001
"""Both tests reject equality below this p-value: a demo compares some sixty components, and one false alarm makes a
concept that should not be."""


class IncrementalMixture(NumberedComponents):
    """The concepts of one feature space. Only these components are kept, no values. Satisfies `Mixture`.

    Concept numbers are never used twice: number n keeps its meaning as learning goes on. When two old components turn
    out to be equivalent, the smaller number stays and the larger becomes an alias of it (`resolve`).
    """

    def __init__(self, space: type[FeatureSpace], rules: EqualityRules = CLUSTERED) -> None:
        """Start without concepts.

        Args:
            space: The feature space, with its scales.
            rules: How values are counted in the tests of equality.
        """
        super().__init__()
        self.space = space
        self._rules = rules
        self._prepared: tuple[NDArray[np.int64], FloatArray, FloatArray, FloatArray] | None = None

    def update(
        self,
        components: Sequence[Gaussian],
        noise: TrackNoise | None = None,
        names: Sequence[str | None] | None = None,
    ) -> list[int]:
        """Merge the components of one demo into the mixture (algorithm 2).

        Takes time in proportion to the number of concepts, whatever the number of demos seen.

        Args:
            components: The demo's own mixture.
            noise: Not used: components are compared by their own covariances.
            names: What a user calls each component, None where nothing was said: those of one name become one concept,
                and those of different names never do.

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
        called = names or [None] * len(components)
        for component, matched, name in zip(components, matches, called, strict=True):
            match = self._named(None if matched is None else self.resolve(matched), name)
            if match is None:  # (A.4): its weight is its share of the new total
                number = self._next_number
                self._next_number += 1
                self._components[number] = component
            else:  # (A.1) to (A.3)
                number = match
                kept = self._components[number]
                # Two components of one demo that match the same concept are one sighting of it.
                self._components[number] = self._shaped(merged(kept, component, kept.demos + (number not in seen)))
            if name is not None:
                self._names.setdefault(number, name)
            seen.add(number)
            numbers.append(number)
        self._merge_equivalent({self.resolve(number) for number in seen}, first_new)
        self._prepared = None
        numbers = [self.resolve(number) for number in numbers]
        renamed = self._close_gaps(first_new)
        return [renamed.get(number, number) for number in numbers]

    def classify_with_distance(self, values: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        """The most likely concept (eq. 3.1, weighted) and the Mahalanobis distance to it, both (...).

        Raises:
            PerceptionError: There is no concept yet.
        """
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
        data = {
            "demos": self._demos,
            "next": self._next_number,
            "aliases": {str(number): kept for number, kept in sorted(self._aliases.items())},
            "components": components_to_json(self.components, self.space),
        }
        if self._names:
            data["names"] = {str(number): name for number, name in self.names.items()}
        return data

    @classmethod
    def from_json(cls, space: type[FeatureSpace], data: Mapping[str, Any]) -> "IncrementalMixture":
        """Rebuild a mixture.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        mixture = cls(space)
        mixture._components = components_from_json(data["components"], space)
        mixture._names = {int(number): str(name) for number, name in data.get("names", {}).items()}
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

    def _named(self, match: int | None, name: str | None) -> int | None:
        """Concept that a component becomes part of, given the equal one and what a user calls it; None for a new one.

        An equal concept without a name that a user now calls like another is the same as that one.
        """
        if name is None:
            return match
        known = next((number for number, called in self._names.items() if called == name), None)
        if match is None or self._names.get(match, name) != name:
            return known
        if known is None or known == match:
            return match
        return self._join(known, match)

    def _join(self, first: int, second: int) -> int:
        """Merge two concepts; returns the number that stays."""
        kept, gone = min(first, second), max(first, second)
        one, other = self._components[kept], self._components.pop(gone)
        # Some demos may have shown both; which ones was not kept.
        demos = min(one.demos + other.demos, self._demos)
        self._components[kept] = self._shaped(merged(one, other, demos))
        self._aliases[gone] = kept
        if gone in self._names:
            self._names.setdefault(kept, self._names.pop(gone))
        return kept

    def _shaped(self, component: Gaussian) -> Gaussian:
        """Drop what the space does not keep of a covariance."""
        if not self.space.diagonal:
            return component
        return Gaussian(component.mean, np.diag(np.diag(component.covariance)), component.count, component.demos)

    def _equivalents(self, new: Sequence[Gaussian], old: Sequence[Gaussian]) -> FloatArray:
        """Log likelihood of each old component for the values of each new one, -inf unless both tests pass, (A, K)."""
        first, second = Statistics.of(new), Statistics.of(old)
        passed = covariance_p_values(first, second, self.space.diagonal, self._rules) > SIGNIFICANCE
        passed &= mean_p_values(first, second, self.space.correlation, self.space.diagonal, self._rules) > SIGNIFICANCE
        return np.where(passed, mean_log_likelihoods(first, second), -np.inf)

    def _close_gaps(self, first_new: int) -> dict[int, int]:
        """Number the components that came with this demo and stayed anew: nobody knows those merged at once."""
        stayed = sorted(number for number in self._components if number >= first_new)
        renamed = {number: first_new + index for index, number in enumerate(stayed)}
        for number, new_number in renamed.items():  # downwards, so that none is overwritten
            self._components[new_number] = self._components.pop(number)
            if number in self._names:
                self._names[new_number] = self._names.pop(number)
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
            if self._names:
                called = [self._names.get(number) for number in numbers]
                for index, number in enumerate(rows):
                    name = self._names.get(number)
                    likelihood[index, [name is not None and other not in (None, name) for other in called]] = -np.inf
            row, column = np.unravel_index(int(np.argmax(likelihood)), likelihood.shape)
            if likelihood[row, column] == -np.inf:
                return
            number, match = rows[row], numbers[column]
            kept, gone = min(number, match), max(number, match)
            self._join(kept, gone)
            changed = (changed - {gone}) | {kept}
