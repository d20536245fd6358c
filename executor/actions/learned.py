"""Action graphlets really learned from a few demos, each under its true name for the judge."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from executor.actions.quantities import Quantities, quantities_of
from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.demo_concepts import fit_demo
from learning.evaluation.actions import ActionScore, score_actions
from learning.graphs.action_graphlet import ActionGraphlet
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation

LEARNED_DEMOS = 5
"""Demos of each action that are learned from, at most."""
BOARD_NAMES: Mapping[str, str] = {"take": "pick up", "drop": "put down", "move": "move"}
"""What the board's tasks are as actions."""


@dataclass(frozen=True, slots=True)
class LearnedAction:
    """An action as it was learned.

    Attributes:
        name: Its true name: for the judge, never for the player.
        graphlet: What was learned.
        quantities: How much of each change.
        robot: The robot that showed it.
    """

    name: str
    graphlet: ActionGraphlet
    quantities: Quantities
    robot: str


def true_name(truth: Mapping[str, object]) -> str | None:
    """True name of a demo's action as its sidecar has it; None where it has none."""
    if "action" in truth:
        return str(truth["action"])
    return BOARD_NAMES.get(str(truth.get("task")))


def learn_actions(
    pairs: Sequence[tuple[Observation, str]],
    robot: str,
    rng: np.random.Generator,
    spaces: ConceptSpaces | None = None,
    learned_demos: int = LEARNED_DEMOS,
) -> tuple[ActionScore, list[LearnedAction]]:
    """Learn from the first demos of each action, and find which concept each true action became.

    Args:
        pairs: Observations of demos and their true actions.
        robot: The robot that showed them.
        rng: Draws values to cluster.
        spaces: Concepts to go on from; None starts with none.
        learned_demos: Demos of each action that are learned from.

    Raises:
        ValueError: There are no pairs.
    """
    spaces = ConceptSpaces() if spaces is None else spaces
    if all(observation.extent is None for observation, _ in pairs):
        # The board's predicates are distance concepts; a camera's tracks tell touching by their gaps.
        for observation, _ in _first(pairs, learned_demos):
            spaces.update(fit_demo(observation, rng))
    score = score_actions(pairs, spaces, learned_demos)
    numbers: defaultdict[str, dict[int, int]] = defaultdict(dict)
    for (name, number), count in score.counts.items():
        if number != NO_CONCEPT:
            numbers[name][number] = count
    learned = []
    for name in sorted(numbers):
        number = max((count, -each) for each, count in numbers[name].items())[1] * -1
        graphlet = spaces.actions[number]
        quantities = quantities_of(graphlet, spaces.actions.statistics(number))
        learned.append(LearnedAction(name, graphlet, quantities, robot))
    return score, learned


def _first(pairs: Sequence[tuple[Observation, str]], most: int) -> list[tuple[Observation, str]]:
    """The first demos of each action."""
    seen: defaultdict[str, int] = defaultdict(int)
    kept = []
    for observation, name in pairs:
        seen[name] += 1
        if seen[name] <= most:
            kept.append((observation, name))
    return kept
