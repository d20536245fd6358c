"""How large things of each kind usually are, and what is small or large among its own kind.

A small bottle may be larger than a large cup: words for size compare a thing with others of its shape. That such a
comparison is made is innate, as is where things rest; which word says its outcome is learned.
"""

import math
from collections.abc import Mapping
from typing import Any

from learning.concept_id import Concept
from learning.saved_numbers import saved_count

AMONG_KIND = "size among its kind"
"""Space of the two outcomes."""
SMALLER, LARGER = Concept(AMONG_KIND, 0), Concept(AMONG_KIND, 1)
LEAST_SEEN = 5.0
"""Things of a kind before others are compared with them."""
LEAST_SPREAD = 0.1
"""Things of a kind come in sizes when their lengths differ by so much of themselves (standard deviation);"""
OFF = 0.1
"""a thing is small or large when it is so many of these standard deviations off their mean."""


class KindSizes:
    """Count, mean and spread of sizes of the things of each kind.

    Attributes:
        kinds: Concept of shape to the number of things seen, the mean of the logarithms of their sizes, and the sum of
            the squared deviations from it.
    """

    def __init__(self) -> None:
        """Know no kind."""
        self.kinds: dict[Concept, tuple[float, float, float]] = {}

    def see(self, kind: Concept, size: float) -> None:
        """Count a thing: its kind and the logarithm of its size."""
        count, mean, square = self.kinds.get(kind, (0.0, 0.0, 0.0))
        off = size - mean
        mean += off / (count + 1.0)
        self.kinds[kind] = count + 1.0, mean, square + off * (size - mean)

    def among(self, kind: Concept, size: float) -> Concept | None:
        """Whether a thing of a kind is small or large among its like; None where it is neither or that is not known."""
        count, mean, square = self.kinds.get(kind, (0.0, 0.0, 0.0))
        if count < LEAST_SEEN:
            return None
        spread = math.sqrt(square / count)
        if spread < LEAST_SPREAD or abs(size - mean) < OFF * spread:
            return None
        return LARGER if size > mean else SMALLER

    def rename(self, old: Concept, new: Concept) -> None:
        """Count things of a kind that turned out to be another as of that."""
        if old not in self.kinds:
            return
        n, mean, square = self.kinds.pop(old)
        m, other, other_square = self.kinds.get(new, (0.0, 0.0, 0.0))
        off, total = other - mean, n + m
        self.kinds[new] = total, mean + off * m / total, square + other_square + off * off * n * m / total

    def to_json(self) -> dict[str, list[float]]:
        """Kind to its three numbers."""
        return {str(kind): [row[0], round(row[1], 4), round(row[2], 4)] for kind, row in sorted(self.kinds.items())}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "KindSizes":
        """Rebuild; raises KeyError, TypeError, ValueError or AttributeError for what `to_json` did not write."""
        sizes = cls()
        for text, (count, mean, square) in data.items():
            seen = saved_count(count, f"things of {text}", least=1)
            sizes.kinds[Concept.parse(text)] = seen, float(mean), saved_count(square, f"spread of {text}")
        return sizes
