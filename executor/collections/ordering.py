"""The `ordering` collection: a Mico shows seven actions with each of 32 objects, five times each (thesis 6.2.3)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.collections import rules
from executor.collections.attempt import Attempt, Trying
from executor.collections.ordering_plans import ACTIONS, OrderingAction, planned
from robots.errors import ShowtellError
from teleop.annotators import OrderingFacts, tell_ordering
from twin import World
from twin.objects import CATALOGUES
from twin.ordering_scene import random_ordering
from twin.scene_spec import SceneSpec

OBJECTS = CATALOGUES["ordering"]
TIMES = 5
ORDERING_COUNT = len(ACTIONS) * len(OBJECTS) * TIMES
"""1,120 demos."""
START, START_ROOM = np.array([0.35, 0.0, 0.36]), np.array([0.04, 0.09, 0.06])
"""Where the tool starts, and how far it may be from there [m]."""
RULES: dict[OrderingAction, rules.Rule] = {
    "grasp": rules.grasped,
    "lift": rules.lifted,
    "hold": rules.held_still,
    "lower": rules.lowered,
    "drop": rules.dropped,
    "press": rules.pressed,
    "push": rules.pushed,
}


@dataclass(frozen=True, slots=True)
class OrderingCollection:
    """What the collection is made of.

    Attributes:
        folder: Where the demos go; it must be there.
        seed: Seed of everything.
        languages: Languages of the sentences; each demo has one sentence in each.
    """

    folder: Path
    seed: int
    languages: tuple[str, ...] = ("en",)

    @property
    def name(self) -> str:
        """`ordering`."""
        return "ordering"

    def shows(self, number: int) -> tuple[OrderingAction, str]:
        """The action and the object of a demo: all actions follow each other, objects in an order of the round's own.

        Args:
            number: Of the demo, from 0 to 1,119.
        """
        each = len(ACTIONS) * len(OBJECTS)
        order = np.random.default_rng([self.seed, number // each]).permutation(len(OBJECTS))
        return ACTIONS[number % len(ACTIONS)], OBJECTS[int(order[number % each // len(ACTIONS)])]

    def attempt(self, number: int, attempt: int, path: Path) -> Attempt:
        """Try to record a demo."""
        action, thing = self.shows(number)
        rng = np.random.default_rng([self.seed, number, attempt])
        try:
            world = World(scene_with(rng, thing, self.seed))
        except ShowtellError as error:  # the hand cannot start there
            return Attempt(action, str(error))
        with world:
            plan = planned(world, action, rng)
            if plan is None:
                return Attempt(action, "out of reach")
            facts = OrderingFacts.of_model(action, thing)
            told = [
                tell_ordering(facts, language, np.random.default_rng([self.seed, number, 7, index]))
                for index, language in enumerate(self.languages)
            ]
            return Trying(self.name, action, number, attempt, path).perform(world, plan, RULES[action], told, rng)


def scene_with(rng: np.random.Generator, thing: str, seed: int) -> SceneSpec:
    """A random scene with an object, and the hand somewhere before it."""
    scene = random_ordering(rng, seed=seed, including=thing)
    x, y, z = (START + rng.uniform(-1.0, 1.0, 3) * START_ROOM).tolist()
    return scene.model_copy(update={"gripper_position": (x, y, z)})
