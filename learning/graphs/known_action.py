"""One known action: its graphlet, the variants of it that were seen, and how it is done."""

from collections.abc import Sequence
from typing import Any

from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_statistics import ActionStatistics, Measures

SHORT_STATE = 0.6
"""A state that lasts less than this on average may be flicker that smoothing let through [s]."""


class KnownAction:
    """An action graphlet with its variants.

    Now and then a demo shows a state too many or too few: the camera lost an object for a moment, or a pause was too
    short to be seen. Such a graphlet is at graph edit distance one (one state node with what hangs on it) from the one
    that most demos show, and the state in question is short. It is then a variant of the same action. How a demo begins
    and ends is no flicker: the first and the last state are never the one in question.
    """

    def __init__(self, graphlet: ActionGraphlet) -> None:
        """Know an action from a graphlet, of which nothing is measured yet."""
        self._variants: dict[ActionGraphlet, ActionStatistics | None] = {graphlet: None}

    @property
    def graphlet(self) -> ActionGraphlet:
        """The variant seen most often, of equals the first."""
        return max(self.counts.items(), key=lambda entry: entry[1])[0]

    @property
    def statistics(self) -> ActionStatistics | None:
        """How that variant is done."""
        return self._variants[self.graphlet]

    @property
    def counts(self) -> dict[ActionGraphlet, int]:
        """Variant to the number of demos it was measured in."""
        return {graphlet: known.demos if known else 0 for graphlet, known in self._variants.items()}

    @property
    def demos(self) -> int:
        """Demos of all variants."""
        return sum(self.counts.values())

    def matches(self, graphlet: ActionGraphlet) -> bool:
        """Whether the graphlet is a variant that was seen."""
        # Canonical graphlets that are equal are isomorphic: no need to search for the isomorphism.
        return graphlet in self._variants or any(known.matches(graphlet) for known in self._variants)

    def is_near(self, graphlet: ActionGraphlet, measured: Sequence[Measures]) -> bool:
        """Whether the graphlet is the most frequent one with a short state too many, or without one of its short ones.

        Args:
            graphlet: A canonical graphlet.
            measured: What its demo shows of its states.
        """
        known, statistics = self.graphlet, self.statistics
        lasting = [float(state["duration"][0]) for state in measured]
        if _differs_by_one(graphlet, lasting, known):
            return True
        if statistics is None:
            return False
        means = (statistics.mean(state, "duration") for state in range(len(known.states)))
        return _differs_by_one(known, [float("inf") if mean is None else float(mean[0]) for mean in means], graphlet)

    def update(self, graphlet: ActionGraphlet, measured: Sequence[Measures]) -> None:
        """Learn from one more demo of this action, in the variant `graphlet`."""
        for known in self._variants:
            if known != graphlet and known.matches(graphlet):
                graphlet = known
                break
        statistics = self._variants.get(graphlet)
        if statistics is None:
            statistics = self._variants[graphlet] = ActionStatistics(len(graphlet.states))
        statistics.update(measured)

    def adopt(self, other: "KnownAction") -> None:
        """Take over the variants of an action that turned out to be this one, seen badly."""
        for graphlet, statistics in other._variants.items():
            self._variants.setdefault(graphlet, statistics)

    def to_json(self) -> Any:
        """The graphlet's rows where nothing was measured, else `{"variants": [...]}`, the first seen first."""
        if all(statistics is None for statistics in self._variants.values()):
            (graphlet,) = self._variants
            return graphlet.to_json()
        return {
            "variants": [
                {"graphlet": graphlet.to_json(), "statistics": statistics.to_json() if statistics else None}
                for graphlet, statistics in self._variants.items()
            ]
        }

    @classmethod
    def from_json(cls, data: Any) -> "KnownAction":
        """Rebuild an action.

        Raises:
            ValueError, KeyError, TypeError: `data` is not what `to_json` wrote.
        """
        if not isinstance(data, dict):
            return cls(ActionGraphlet.from_json(data))
        variants: dict[ActionGraphlet, ActionStatistics | None] = {}
        for entry in data["variants"]:
            graphlet = ActionGraphlet.from_json(entry["graphlet"])
            found = None if entry["statistics"] is None else ActionStatistics.from_json(entry["statistics"])
            if found is not None and len(found.states) != len(graphlet.states):
                raise ValueError(f"statistics of {len(found.states)} states for the graphlet {graphlet}")
            variants[graphlet] = found
        if not variants:
            raise ValueError("an action must have at least one variant")
        action = cls(next(iter(variants)))
        action._variants = variants
        return action


def _differs_by_one(longer: ActionGraphlet, lasting: Sequence[float], shorter: ActionGraphlet) -> bool:
    """Whether taking one short state out of the middle of `longer` gives `shorter`.

    Args:
        longer: The graphlet with the state too many.
        lasting: How long its states last [s].
        shorter: The graphlet without.
    """
    return any(
        lasting[index] < SHORT_STATE
        and ActionGraphlet.of(longer.states[:index] + longer.states[index + 1 :]) == shorter
        for index in range(1, len(longer.states) - 1)
    )
