"""The `leeds` collection: a Baxter picks up, puts down and moves each of 51 objects four times (thesis 6.2.2)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.collections import rules
from executor.collections.attempt import Attempt, Trying
from executor.collections.table_goals import Goal, put_rule
from executor.collections.table_plans import planned
from teleop.annotators import TableAction, TableFacts, Thing, tell_table
from twin import World
from twin.objects import CATALOGUES
from twin.scene_spec import SceneSpec
from twin.state import WorldState
from twin.tabletop_scene import random_tabletop

ACTIONS: tuple[TableAction, ...] = ("pick up", "put down", "move")
OBJECTS = CATALOGUES["tabletop"]
TIMES = 4
LEEDS_COUNT = TIMES * len(OBJECTS)
"""204 demos."""
SENTENCES = 5
"""Sentences with a demo in each language; every 51st has one more, 1,024 in all."""
PLACES = tuple((x, y) for x in (0.53, 0.77) for y in (0.25, 0.0, -0.25))
"""Where things stand: canonical places of the table, as people lay a table for a demonstration (thesis 3.3.2) [m],"""
ABOUT = 0.025
"""so near to them [m]."""


@dataclass(frozen=True, slots=True)
class LeedsCollection:
    """What the collection is made of.

    Attributes:
        folder: Where the demos go; it must be there.
        seed: Seed of everything.
        languages: Languages of the sentences.
    """

    folder: Path
    seed: int
    languages: tuple[str, ...] = ("en",)

    @property
    def name(self) -> str:
        """`leeds`."""
        return "leeds"

    def shows(self, number: int) -> tuple[TableAction, str]:
        """The action and the object of a demo: all objects follow each other four times, shuffled each time."""
        turn, place = divmod(number, len(OBJECTS))
        order = np.random.default_rng([self.seed, turn]).permutation(len(OBJECTS))
        return ACTIONS[number % len(ACTIONS)], OBJECTS[int(order[place])]

    def attempt(self, number: int, attempt: int, path: Path) -> Attempt:
        """Try to record a demo."""
        action, thing = self.shows(number)
        rng = np.random.default_rng([self.seed, number, attempt])
        scene = scene_with(rng, thing, self.seed)
        target = next(each.id for each in scene.objects if each.model == thing)
        with World(scene) as world:
            plan = planned(world, action, target, rng)
            if plan is None:
                return Attempt(action, "out of reach")
            facts = facts_of(scene, action, target, plan.goal)
            count = SENTENCES + (number % len(OBJECTS) == 0)
            told = [
                each
                for index, language in enumerate(self.languages)
                for each in tell_table(facts, count, language, np.random.default_rng([self.seed, number, 7, index]))
            ]
            trying = Trying(self.name, action, number, attempt, path)
            rule = put_rule(world, action, target, plan.goal)
            return trying.perform(world, plan.demo, rule, told, rng, lambda end: _destination(plan.goal, end, target))


def scene_with(rng: np.random.Generator, thing: str, seed: int) -> SceneSpec:
    """A random scene with an object among others; which number it has says nothing."""
    scene = random_tabletop(rng, seed=seed, including=thing, places=PLACES, about=ABOUT)
    order = rng.permutation(len(scene.objects)).tolist()
    objects = tuple(scene.objects[old].model_copy(update={"id": new}) for new, old in enumerate(order))
    return scene.model_copy(update={"objects": objects})


def facts_of(scene: SceneSpec, action: TableAction, target: int, goal: Goal | None) -> TableFacts:
    """What there is to say of a demo."""
    things = tuple(
        Thing(each.id, each.shape, each.colour, each.position[0], each.position[1]) for each in scene.objects
    )
    mine = next(each for each in things if each.id == target)
    return TableFacts(action, mine, things, None if goal is None else goal.destination, action == "put down")


def _destination(goal: Goal | None, end: WorldState, target: int) -> dict[str, object] | None:
    """Where a thing went, for the sidecar."""
    if goal is None:
        return None
    said = goal.destination
    position = rules.place_of(end, target).position.tolist()
    kind = "part" if said.relation is None else "in or on" if said.relation in ("in", "on") else "beside"
    return {
        "kind": kind,
        "place": None if said.place is None else list(said.place),
        "relation": said.relation,
        "reference": said.reference,
        "position": position,
    }
