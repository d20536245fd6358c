"""Log-linear preferences over readings: what validation says against, counted beside what it says for.

Φ and Π count validated readings only, so a reading that is often tried and often wrong costs them nothing. Preferences
correct that: the weight of every feature of a reading (an n-gram with its concept, a word passed over, a rule) follows
the gradient of the log likelihood of the shown move: features expected over the readings that do what was shown, minus
features expected over all readings (the conditional model of Zettlemoyer & Collins 2005, with the scene as the only
supervision as in Liang et al. 2011). Steps shrink as a feature is seen more often (Adagrad, Duchi et al. 2011).
"""

import math
from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from learning.saved_numbers import saved_count, saved_number

STEP = 0.3
"""Size of a feature's first step."""
LARGEST = 6.0
"""Bound of a weight, so that no single feature can rule alone."""

NEGLIGIBLE = 0.05
"""Weights smaller than this are not saved."""


class Preferences:
    """Weights of features and their accumulated squared gradients."""

    def __init__(self) -> None:
        """Start indifferent."""
        self.weights: defaultdict[str, float] = defaultdict(float)
        self.squares: defaultdict[str, float] = defaultdict(float)

    def of(self, feature: str) -> float:
        """Give the weight of a feature, 0 when it is unknown."""
        return self.weights.get(feature, 0.0)

    def follow(self, gradient: Mapping[str, float]) -> None:
        """Take one step along a gradient."""
        for feature, slope in gradient.items():
            if abs(slope) < 1e-6:
                continue
            self.squares[feature] += slope * slope
            moved = self.weights[feature] + STEP * slope / math.sqrt(self.squares[feature] + 1.0)
            self.weights[feature] = max(-LARGEST, min(LARGEST, moved))

    def rename(self, old_end: str, new_end: str) -> None:
        """Rename the features that end in `old_end`; a feature that exists already keeps its weight."""
        for table in (self.weights, self.squares):
            for feature in [name for name in table if name.endswith(old_end)]:
                table.setdefault(feature.removesuffix(old_end) + new_end, table.pop(feature))

    def to_json(self) -> dict[str, list[float]]:
        """Feature to weight and accumulated squared gradient; weights of no consequence are left out."""
        return {
            feature: [round(weight, 3), round(self.squares[feature], 3)]
            for feature, weight in sorted(self.weights.items())
            if abs(weight) >= NEGLIGIBLE
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Preferences":
        """Rebuild; raises TypeError, ValueError or AttributeError for what `to_json` did not write."""
        preferences = cls()
        for feature, (weight, square) in data.items():
            preferences.weights[feature] = saved_number(weight, f"weight of '{feature}'")
            preferences.squares[feature] = saved_count(square, f"squared gradient of '{feature}'")
        return preferences


def lexical_feature(ngram: str, concept: object) -> str:
    """Name the feature "this n-gram is read as this concept"."""
    return f"{ngram} = {concept}"


def skip_feature(word: str) -> str:
    """Name the feature "this word is passed over"."""
    return f"{word} = none"


def rule_feature(left: str, right: tuple[str, ...]) -> str:
    """Name the feature "this rule is used"."""
    return f"{left} -> {' '.join(right)}"


MOVES_FEATURE = "log moves"
"""Feature whose value is the logarithm of the number of moves a reading allows."""
