"""How an action is done: Gaussians of what is continuous in each state of its graphlet, for carrying it out again.

A graphlet says in which order things happen. How high an object is raised, where the hand touches it and how hard it
presses are numbers, and what was shown of them is kept as mean, covariance and count, whatever the number of demos.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from learning.concepts.gaussian import Gaussian, merged
from learning.saved_numbers import saved_count, saved_number
from robots.pose import FloatArray

MEASURES: dict[str, int] = {
    "duration": 1,
    "opening": 1,
    "force": 3,
    "clearance": 1,
    "offset": 3,
    "height": 1,
    "faces": 2,
    "approach": 3,
    "travel": 1,
    "displacement": 3,
}
"""Number of components of each measure:

- duration: how long the state lasted [s];
- opening: gap between the fingers [m], median;
- force: pull at the wrist, axes of the world [N], mean; the hand's own weight is in it, so compare states;
- clearance: of an object in the air: how high its underside was above the table [m];
- offset: in a state in which touching began: tool point as seen from the object's centre [m], in the action's frame;
- height: the same state: the tool's height above the object's centre in half heights of the object: 1 is its top;
- faces: the same state: tool point above the object's top and outside its outline [m]; negative inside;
- approach: the same state: unit vector along which the hand came, in the action's frame;
- travel: in a state in which the object came to another place: distance along the table from its first place [m];
- displacement: the same state: where it came to as seen from its first place, axes of the world [m].

The action's frame has z up and x along the table in the direction in which the object moved while it was touched from
outside, else in which the hand came. Of an object that rose or fell straight, x is the hand's way too.
"""
DECIMALS = 6
"""Decimals kept of a mean: micrometres, micronewtons, microseconds. A covariance has twice as many."""

Measures = Mapping[str, FloatArray]
"""What one demo shows of one state: measure to its value; what does not apply is left out."""


class ActionStatistics:
    """Sufficient statistics of the continuous parameters of one action graphlet.

    Attributes:
        demos: Number of demos it was seen in.
        states: For each state of the graphlet, measure to its Gaussian; a measure that never applied is not there.
    """

    def __init__(self, length: int) -> None:
        """Start without any demo of a graphlet with `length` states."""
        self.demos = 0
        self.states: list[dict[str, Gaussian]] = [{} for _ in range(length)]

    def update(self, measured: Sequence[Measures]) -> None:
        """Add what one demo shows, one mapping a state.

        Raises:
            ValueError: The number of states is not the graphlet's, or a measure is unknown or of the wrong length.
        """
        if len(measured) != len(self.states):
            raise ValueError(f"measures of {len(measured)} states for a graphlet of {len(self.states)}")
        self.demos += 1
        for known, values in zip(self.states, measured, strict=True):
            for name, value in values.items():
                size = MEASURES.get(name)
                if size is None or np.shape(value) != (size,):
                    raise ValueError(f"measure '{name}' of shape {np.shape(value)}; known are {MEASURES}")
                if np.all(np.isfinite(value)):
                    one = Gaussian(np.asarray(value, dtype=np.float64), np.zeros((size, size)), 1.0)
                    known[name] = _rounded(merged(known[name], one, self.demos) if name in known else one)

    def mean(self, state: int, name: str) -> FloatArray | None:
        """Mean of a measure in a state, (d,); None where it never applied."""
        found = self.states[state].get(name)
        return None if found is None else found.mean

    def spread(self, state: int, name: str) -> FloatArray | None:
        """Standard deviation of a measure in a state, (d,); None where it never applied."""
        found = self.states[state].get(name)
        return None if found is None else np.sqrt(np.maximum(np.diag(found.covariance), 0.0))

    def to_json(self) -> dict[str, Any]:
        """Per state and measure: count, mean, and the upper triangle of the covariance."""
        return {
            "demos": self.demos,
            "states": [{name: _numbers(known[name]) for name in MEASURES if name in known} for known in self.states],
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "ActionStatistics":
        """Rebuild the statistics.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        statistics = cls(len(data["states"]))
        statistics.demos = int(saved_count(data["demos"], "demos of an action"))
        for known, entry in zip(statistics.states, data["states"], strict=True):
            for name, numbers in entry.items():
                known[name] = _gaussian(name, numbers)
        return statistics


def _rounded(gaussian: Gaussian) -> Gaussian:
    """What is saved is what is kept, so that learning goes on from a file as if it had never stopped."""
    mean, covariance = np.round(gaussian.mean, DECIMALS), np.round(gaussian.covariance, 2 * DECIMALS)
    return Gaussian(mean, covariance, gaussian.count, gaussian.demos)


def _numbers(gaussian: Gaussian) -> list[float]:
    """Count, mean and upper triangle of the covariance in one row."""
    upper = gaussian.covariance[np.triu_indices(len(gaussian.mean))]
    return [gaussian.count, *gaussian.mean.tolist(), *upper.tolist()]


def _gaussian(name: str, numbers: Sequence[Any]) -> Gaussian:
    """Read a row of `_numbers`."""
    if name not in MEASURES:
        raise ValueError(f"unknown measure '{name}'; known are {', '.join(MEASURES)}")
    size = MEASURES[name]
    rows, columns = np.triu_indices(size)
    if len(numbers) != 1 + size + len(rows):
        raise ValueError(f"measure '{name}' must have {1 + size + len(rows)} numbers, got {len(numbers)}")
    count, *rest = (saved_number(number, f"measure '{name}'") for number in numbers)
    saved_count(count, f"count of measure '{name}'", least=1)
    covariance = np.zeros((size, size))
    covariance[rows, columns] = covariance[columns, rows] = rest[size:]
    if np.any(np.diag(covariance) < 0.0):
        raise ValueError(f"measure '{name}': variances must not be negative")
    return Gaussian(np.array(rest[:size]), covariance, count)
