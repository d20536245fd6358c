"""Weights of a reading's features: a prior for each kind of structure, and what was learned.

The weight of every feature follows the gradient of the log likelihood of the shown move: features expected over the
readings that do what was shown, minus features expected over all readings (the conditional model of Zettlemoyer &
Collins 2005, with the scene as the only supervision as in Liang et al. 2011). Steps shrink as a feature is seen more
often (Adagrad, Duchi et al. 2011), and weights are pulled back to their priors.
"""

import math
from collections import defaultdict
from collections.abc import Mapping
from typing import Any

from learning.grammar.innate import ABOVE, BESIDE, EXTREMES, FURTHEST, NEAREST_ONE, SIDES
from learning.grammar.phrase import Feature
from learning.saved_numbers import saved_count, saved_number

STEP = 0.3
"""Size of a feature's first step."""
PULL = 0.01
"""Share of a weight that is taken off whenever its feature is seen."""
NEGLIGIBLE = 0.1
"""Weights smaller than this are not saved."""
SEPARATOR = "/"
"""Between the parts of a feature when it is written; words hold no punctuation."""

PRIORS: dict[Feature, float] = {
    ("sense", "colour alone"): -2.0,
    ("sense", "group unsaid"): -1.5,
    ("sense", "colours alone"): -2.0,
    ("sense", "side alone"): -0.5,
    ("sense", "one"): -0.5,
    **{
        ("sense", f"{how}, side"): -2.0
        for how in ("thing", "one", "collective", "group", "colour alone", "group unsaid", "colours alone")
    },
    # An action is said with what it is done to.
    ("clause", "second", "ag"): -2.0,
    ("clause", "second", "ga"): -2.0,
    # What is done next is said after a word that says so ("and", "then").
    ("clause", "linked"): 2.0,
    # Who says "one" has spoken of a thing of its sort before.
    ("reference", "to nothing"): -3.0,
    # "Nearest" is said of something more often than of the nearest one.
    ("used", "relation", "word"): -1.0,
    # One word names an action more often than several do.
    ("joined", "action"): -1.0,
    # What is beside a thing is nearest to it too, but that says less.
    ("relation", str(BESIDE), "thing"): 0.5,
    ("relation", str(BESIDE), "place"): -4.0,
    # What is in a place is on its ground too, but that says less.
    ("relation", str(ABOVE), "place"): -1.0,
    # What is to one side of a place is off the board, or is part of it and called so.
    **{("relation", str(side), "place"): -2.0 for side in SIDES},
    # Nobody adds words that tell nothing.
    ("modified", "in vain"): -1.0,
    ("ranked", "in vain"): -1.5,
    ("modified", "variant 1"): -0.5,
    ("modified", "variant 2"): -0.5,
    ("modified", "again"): -0.5,
    **{("ranked", str(rank)): -1.0 for rank in (*EXTREMES, FURTHEST, NEAREST_ONE)},
    # A command is meant to allow one move.
    ("moves", "2"): -0.7,
    ("moves", "3"): -1.1,
    **{("moves", str(2**power)): -0.7 * power for power in range(2, 14)},
}
"""Innate expectations about how things are said, the same for every language."""
NEVER_PRAISED = frozenset({("modified", "in vain"), ("ranked", "in vain")})
"""Features of saying what tells nothing. Their weights may fall but never rise above their priors: where few things
look alike much is said in vain, and a function word would be taken for a rank that is nearly always true."""


class Weights:
    """Weights of features and their accumulated squared gradients."""

    def __init__(self) -> None:
        """Start with the priors alone."""
        self.learned: dict[Feature, float] = {}
        self.squares: defaultdict[Feature, float] = defaultdict(float)

    def clear(self) -> None:
        """Forget what was learned."""
        self.learned.clear()
        self.squares.clear()

    def of(self, feature: Feature) -> float:
        """Give the weight of a feature, its prior when nothing was learned of it."""
        prior = PRIORS.get(feature)
        learned = self.learned.get(feature, 0.0)
        return learned if prior is None else learned + prior

    def follow(self, gradient: Mapping[Feature, float]) -> None:
        """Take one step along a gradient."""
        for feature, slope in gradient.items():
            weight = self.learned.get(feature, 0.0)
            step = slope - PULL * weight
            if abs(step) < 1e-6:
                continue
            self.squares[feature] += step * step
            weight += STEP * step / math.sqrt(self.squares[feature] + 1.0)
            self.learned[feature] = min(weight, 0.0) if feature in NEVER_PRAISED else weight

    def rename(self, old: str, new: str) -> None:
        """Rename the features about a concept; a feature that exists already keeps its weight."""
        for table in (self.learned, self.squares):
            for feature in [each for each in table if each[-1] == old]:
                table.setdefault((*feature[:-1], new), table.pop(feature))

    def to_json(self) -> dict[str, list[float]]:
        """Feature to weight and accumulated squared gradient; weights of no consequence are left out."""
        return {
            SEPARATOR.join(feature): [round(weight, 3), round(self.squares[feature], 3)]
            for feature, weight in sorted(self.learned.items())
            if abs(weight) >= NEGLIGIBLE
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Weights":
        """Rebuild; raises TypeError, ValueError or AttributeError for what `to_json` did not write."""
        weights = cls()
        for text, (weight, square) in data.items():
            feature = tuple(text.split(SEPARATOR))
            weights.learned[feature] = saved_number(weight, f"weight of '{text}'")
            weights.squares[feature] = saved_count(square, f"squared gradient of '{text}'")
        return weights
