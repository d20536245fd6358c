"""Evaluation of actions: learned from a few demos of each, replayed in new scenes, also by other robots."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from executor.actions.learned import LearnedAction
from executor.actions.trials import Tried
from learning.evaluation.actions import ActionScore
from learning.evaluation.machine import machine

TRANSFERRED = ("pick up", "put down", "move")
"""Actions that robots learn from each other."""


@dataclass(frozen=True, slots=True)
class ActionsReport:
    """What was learned and how it went.

    Attributes:
        scores: How well concepts agree with true actions, by the robot that showed them.
        learned: Actions as they were learned.
        tried: All trials.
        settings: How it was run.
        seed: Seed of everything.
    """

    scores: Mapping[str, ActionScore]
    learned: Sequence[LearnedAction]
    tried: Sequence[Tried]
    settings: Mapping[str, Any]
    seed: int

    def success(self, action: str | None = None, robot: str | None = None, source: str | None = None) -> float | None:
        """Share of trials that succeeded, of all or some; None where there were none."""
        chosen = [
            each
            for each in self.tried
            if action in (None, each.action) and robot in (None, each.robot) and source in (None, each.source)
        ]
        return sum(not each.fault for each in chosen) / len(chosen) if chosen else None

    def causes(self) -> list[tuple[str, str, str, str, int]]:
        """Source, robot, action, kind of failure and how often, the most frequent first."""
        counted = Counter((each.source, each.robot, each.action, each.cause) for each in self.tried if each.fault)
        return [(*key, count) for key, count in counted.most_common()]

    def figures(self) -> dict[str, float | None]:
        """Figures by dotted name; those of a single robot's own actions need no robot in their names."""
        figures: dict[str, float | None] = {}
        own = len(self.scores) == 1
        for robot, score in self.scores.items():
            before = "" if own else f"{robot}."
            figures[f"{before}v_measure"] = score.v_measure
            figures[f"{before}concepts"] = float(score.graphlets)
            figures[f"{before}true_actions"] = float(score.true_actions)
        figures["replay_success"] = self.success()
        pairs = sorted({(each.source, each.robot) for each in self.tried})
        for source, robot in pairs:
            before = "" if len(pairs) == 1 else f"{source}_to_{robot}."
            if before:
                figures[f"{before}success"] = self.success(None, robot, source)
            for action in sorted({e.action for e in self.tried if (e.source, e.robot) == (source, robot)}):
                figures[f"{before}{action.replace(' ', '_')}.success"] = self.success(action, robot, source)
        return figures

    def to_json(self) -> dict[str, Any]:
        """The object that `--json` prints."""
        return {
            "figures": self.figures(),
            "graphlets": {
                robot: {
                    each.name: {"graphlet": str(each.graphlet), "quantities": _numbers(each)}
                    for each in self.learned
                    if each.robot == robot
                }
                for robot in self.scores
            },
            "failures": [
                {
                    "source": each.source,
                    "robot": each.robot,
                    "action": each.action,
                    "trial": each.number,
                    "object": each.thing,
                    "reason": each.fault,
                }
                for each in self.tried
                if each.fault
            ],
            "settings": dict(self.settings),
            "machine": machine(),
            "seed": self.seed,
        }


def _numbers(action: LearnedAction) -> dict[str, Any]:
    """What the demos of an action told, as numbers."""
    quantities = action.quantities
    return {
        "rise_m": quantities.rise,
        "shift_m": quantities.shift,
        "force_n": {side.name.lower(): force for side, force in quantities.force.items()},
        "durations_s": {str(number): seconds for number, seconds in quantities.durations.items()},
    }
