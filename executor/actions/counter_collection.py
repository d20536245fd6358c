"""A Mico picks up, puts down and moves things at the counter, so that other robots can learn that from it too."""

from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np

from executor.collections import rules
from executor.collections.attempt import Attempt
from executor.collections.performance import perform
from executor.collections.table_goals import Goal, reached
from executor.collections.table_plans import planned
from executor.collections.truths import objects_of
from teleop.annotators import TableAction
from twin import World
from twin.objects import CATALOGUES
from twin.ordering_scene import random_ordering

ACTIONS: tuple[TableAction, ...] = get_args(TableAction)
OBJECTS = CATALOGUES["ordering"]
FARTHER = 0.06
"""What was moved is so far from where it was, at least [m]."""


@dataclass(frozen=True, slots=True)
class CounterCollection:
    """Demos without sentences: only the action is shown.

    Attributes:
        folder: Where the demos go; it must be there.
        seed: Seed of everything.
    """

    folder: Path
    seed: int

    @property
    def name(self) -> str:
        """`counter`."""
        return "counter"

    def shows(self, number: int) -> tuple[TableAction, str]:
        """The action and the object of a demo: actions follow each other, objects in a shuffled order."""
        order = np.random.default_rng([self.seed, number // len(OBJECTS)]).permutation(len(OBJECTS))
        return ACTIONS[number % len(ACTIONS)], OBJECTS[int(order[number % len(OBJECTS)])]

    def attempt(self, number: int, attempt: int, path: Path) -> Attempt:
        """Try to record a demo."""
        action, thing = self.shows(number)
        rng = np.random.default_rng([self.seed, number, attempt])
        with World(random_ordering(rng, seed=self.seed, including=thing)) as world:
            target = world.spec.objects[0].id
            plan = planned(world, action, target, rng)
            if plan is None:
                return Attempt(action, "out of reach")
            judge = rules.judge_of(_rule(action, plan.goal, world), world.model_of(target))
            reason = perform(world, plan.demo, judge, path, lambda _: [], rng)
            if reason:
                return Attempt(action, reason, simulated=world.time)
            truth = {
                "collection": self.name,
                "action": action,
                "number": number,
                "attempt": attempt,
                "arm": plan.demo.arm,
                "target": target,
                "objects": objects_of(world.spec),
                "sentences": [],
            }
            return Attempt(action, "", truth, world.time)


def _rule(action: TableAction, goal: Goal | None, world: World) -> rules.Rule:
    """When a demo shows what it shall."""

    def put(facts: rules.Facts, goal: Goal) -> str:
        if facts.held[-1]:
            return "still held at the end"
        if facts.held[0] != (action == "put down"):
            return "held otherwise at the start than the action says"
        if facts.slipped:
            return "slipped out of the hand"
        if action == "move" and facts.moved < FARTHER:
            return f"moved {1000 * facts.moved:.0f} mm only"
        return "toppled" if facts.tilted() else reached(facts, goal, world)

    return rules.picked_up if goal is None else lambda facts: put(facts, goal)
