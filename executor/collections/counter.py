"""A Mico picks up, puts down and moves things at the counter, so that other robots can learn that from it too."""

from dataclasses import dataclass
from pathlib import Path
from typing import get_args

import numpy as np

from executor.collections.attempt import Attempt, Trying
from executor.collections.table_goals import put_rule
from executor.collections.table_plans import planned
from teleop.annotators import TableAction
from twin import World
from twin.objects import CATALOGUES
from twin.ordering_scene import random_ordering

ACTIONS: tuple[TableAction, ...] = get_args(TableAction)
OBJECTS = CATALOGUES["ordering"]
COUNTER_COUNT = len(ACTIONS) * len(OBJECTS)
"""96 demos."""


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
            rule = put_rule(world, action, target, plan.goal)
            return Trying(self.name, action, number, attempt, path).perform(world, plan.demo, rule, (), rng)
