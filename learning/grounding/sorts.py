"""Sorts of things that words tell apart where looks alone do not: linear discriminants trained by what is said.

Looks are clustered without a word, and kinds that look much alike become one concept. What those who speak call the
thing in hand (`Namings`) trains a linear discriminant over the same measured values: a mean for each sort and one
covariance for all (Fisher 1936), both incremental. Its classes are concepts beside those of the mixture, and words
that fit them better move there.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.percept import NO_CONCEPT
from learning.saved_numbers import saved_count
from robots.pose import FloatArray

LEAST_SIGHTINGS = 2.0
"""Sightings of a sort before things are taken to be of it."""
SHRINKAGE = 0.1
"""Share of the mean variance, the same in all directions, in the covariance of a sort."""
PRIOR_SIGHTINGS = 4.0
"""Sightings that the shrunk part is worth, beside."""
DIGITS = 4


class Sorts:
    """Means of the sorts of one feature space, and how things of a sort scatter about them.

    Attributes:
        kinds: Name of each sort's kind (`Namings.kind`), in the order of first sighting.
        counts: Sightings of each.
        means: Mean of each, (d,).
        scatter: Sum of squared deviations from the means, (d, d); None before the first sighting.
    """

    def __init__(self) -> None:
        """Know no sort."""
        self.kinds: list[str] = []
        self.counts: list[float] = []
        self.means: list[FloatArray] = []
        self.scatter: FloatArray | None = None
        self._precision: FloatArray | None = None

    def see(self, kind: str, value: FloatArray) -> None:
        """Learn from a thing that was named.

        Args:
            kind: Name of its kind.
            value: What it looks like, (d,); passed over where it was not measured.
        """
        if not np.all(np.isfinite(value)):
            return
        if self.scatter is None:
            self.scatter = np.zeros((len(value), len(value)))
        if kind not in self.kinds:
            self.kinds.append(kind)
            self.counts.append(0.0)
            self.means.append(np.zeros_like(value))
        at = self.kinds.index(kind)
        self.counts[at] += 1.0
        off = value - self.means[at]
        self.means[at] = self.means[at] + off / self.counts[at]
        self.scatter = self.scatter + np.outer(off, value - self.means[at])
        self._precision = None

    def told_apart(self, values: FloatArray, numbers: NDArray[np.int64], homes: NDArray[np.int64]) -> NDArray[np.int64]:
        """Sort of each thing whose concept several sorts share, (N,); `NO_CONCEPT` for all others.

        Args:
            values: What things look like, (N, d).
            numbers: Their concepts, (N,).
            homes: The concept that the mean of each sort is of, (K,).
        """
        found = np.full(len(values), NO_CONCEPT, dtype=np.int64)
        for concept in sorted({int(number) for number in numbers if number != NO_CONCEPT}):
            sharing = [
                number
                for number, count in enumerate(self.counts)
                if homes[number] == concept and count >= LEAST_SIGHTINGS
            ]
            if len(sharing) >= 2 and self.scatter is not None:
                there = np.flatnonzero(numbers == concept)
                offsets = values[there][:, None] - np.array([self.means[number] for number in sharing])[None]
                squared = np.einsum("nki,ij,nkj->nk", offsets, self._inverse(self.scatter), offsets)
                found[there] = np.array(sharing)[np.argmin(squared, axis=1)]
        return found

    def _inverse(self, scatter: FloatArray) -> FloatArray:
        known = self._precision
        if known is None:
            sightings = max(sum(self.counts) - len(self.counts), 0.0)
            usual = max(float(np.trace(scatter)) / len(scatter), 1e-9)
            round_one = np.eye(len(scatter)) * usual
            covariance = (1.0 - SHRINKAGE) * scatter + (SHRINKAGE + PRIOR_SIGHTINGS / (sightings + 1.0)) * round_one
            known = self._precision = np.asarray(np.linalg.inv(covariance), dtype=np.float64)
        return known

    def to_json(self) -> dict[str, Any]:
        """Plain numbers, lists and strings; of the scatter the lower triangle."""
        rows = [] if self.scatter is None else [_rounded(row[: at + 1]) for at, row in enumerate(self.scatter)]
        return {
            "kinds": list(self.kinds),
            "counts": [int(count) for count in self.counts],
            "means": [_rounded(mean) for mean in self.means],
            "scatter": rows,
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Sorts":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        sorts = cls()
        sorts.kinds = [str(kind) for kind in data["kinds"]]
        sorts.counts = [saved_count(count, "sightings of a sort", least=1) for count in data["counts"]]
        sorts.means = [np.array(mean, dtype=np.float64) for mean in data["means"]]
        rows = data["scatter"]
        if not len(sorts.kinds) == len(sorts.counts) == len(sorts.means):
            raise ValueError("kinds, counts and means of sorts must be as many")
        if rows:
            lower = np.zeros((len(rows), len(rows)))
            for at, row in enumerate(rows):
                lower[at, : at + 1] = row
            sorts.scatter = lower + np.tril(lower, -1).T
        return sorts


def _rounded(values: FloatArray) -> list[float]:
    return [float(f"{value:.{DIGITS}g}") for value in values]
