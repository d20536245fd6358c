"""Parts of concepts: sightings that are one for sure. Which parts make one concept is found anew after every demo."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from learning.concepts.feature_space import FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.mixture_json import components_from_json, components_to_json
from learning.saved_numbers import saved_count
from robots.pose import FloatArray

NO_NUMBER = -1
"""Concept of a part that was not given to one yet."""
DIGITS = 5
"""Significant decimal digits of what is kept: sensors give four at most, and the file stays small."""


@dataclass(frozen=True, slots=True)
class Part:
    """Sightings that are one for sure.

    Attributes:
        gaussian: Their mean, covariance, number, and how many demos they are from.
        last_seen: Number of the last of these demos.
        concept: Number of the concept that it is part of.
        name: What a user calls it; None where nothing was said.
    """

    gaussian: Gaussian
    last_seen: int
    concept: int = NO_NUMBER
    name: str | None = None

    @property
    def mean(self) -> FloatArray:
        """Mean of its sightings, (d,)."""
        return self.gaussian.mean

    @property
    def count(self) -> float:
        """Its number of sightings."""
        return self.gaussian.count

    def joined(self, other: "Part", gaussian: Gaussian) -> "Part":
        """Both as one, given their common statistics but for the number of demos."""
        same = self.last_seen == other.last_seen and 1 in (self.gaussian.demos, other.gaussian.demos)
        demos = self.gaussian.demos + other.gaussian.demos - same
        larger = self if self.count >= other.count else other
        concept = larger.concept if larger.concept != NO_NUMBER else max(self.concept, other.concept)
        statistics = replace(gaussian, demos=demos)
        return Part(statistics, max(self.last_seen, other.last_seen), concept, self.name or other.name)


def parts_to_json(parts: Sequence[Part], space: type[FeatureSpace], covariances: bool) -> list[dict[str, Any]]:
    """Parts as plain numbers; their covariances only where they differ."""
    plain = components_to_json({number: part.gaussian for number, part in enumerate(parts)}, space)
    entries = []
    for part, entry in zip(parts, plain.values(), strict=True):
        if not covariances:
            del entry["covariance"]
        entry |= {"seen": part.last_seen, "concept": part.concept}
        entries.append(entry if part.name is None else entry | {"name": part.name})
    return entries


def parts_from_json(
    data: Sequence[Mapping[str, Any]], space: type[FeatureSpace], covariance: FloatArray | None = None
) -> list[Part]:
    """Rebuild parts.

    Args:
        data: What `parts_to_json` wrote.
        space: Their feature space.
        covariance: That of all parts, (d, d); None where each has its own.

    Raises:
        ValueError, KeyError, TypeError: `data` is not what `parts_to_json` wrote.
    """
    plain: dict[str, Mapping[str, Any]] = {}
    rows = np.arange(space.dimension), np.arange(space.dimension)
    if not space.diagonal:
        rows = np.triu_indices(space.dimension)
    for number, entry in enumerate(data):
        own = {} if covariance is None else {"covariance": covariance[rows].tolist()}
        plain[str(number)] = {**entry, **own}
    gaussians = components_from_json(plain, space)
    return [
        Part(
            gaussians[number],
            int(saved_count(entry["seen"], f"demo of last sight in {space.name}")),
            int(saved_count(entry["concept"], f"concept of a part of {space.name}")),
            None if entry.get("name") is None else str(entry["name"]),
        )
        for number, entry in enumerate(data)
    ]


def rounded(values: FloatArray) -> FloatArray:
    """Values to `DIGITS` significant digits."""
    values = np.asarray(values, dtype=np.float64)
    magnitude = np.maximum(np.abs(values), 1e-100)  # what is smaller is 0
    scale = 10.0 ** (DIGITS - 1 - np.floor(np.log10(magnitude)))
    return np.asarray(np.round(values * scale) / scale)
