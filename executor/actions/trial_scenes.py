"""New scenes in which learned actions are tried: a random object among others, and where it shall go."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from robots.pose import FloatArray
from twin import SceneSpec
from twin.board_scene import random_board
from twin.ordering_scene import REGION_X as COUNTER_X
from twin.ordering_scene import REGION_Y as COUNTER_Y
from twin.ordering_scene import random_ordering
from twin.scene_spec import ObjectSpec
from twin.tabletop_scene import CLEARANCE, random_tabletop
from twin.tabletop_scene import REGION_X as TABLE_X
from twin.tabletop_scene import REGION_Y as TABLE_Y

FARTHER = 0.08
"""A destination is so far from where the object stands, at least [m]."""
DRAWN = 400
"""Destinations that are drawn before another object is chosen."""


@dataclass(frozen=True, slots=True)
class TrialScene:
    """A scene and what to do in it.

    Attributes:
        spec: The scene.
        object_id: The object to act on.
        destination: Where its centre shall come to rest, (3,) [m].
    """

    spec: SceneSpec
    object_id: int
    destination: FloatArray


def trial_scene(robot: str, starts_held: bool, rng: np.random.Generator) -> TrialScene:
    """A new scene for a robot.

    Args:
        robot: Its name; an arm of three joints works on the board, a robot on wheels at the counter, others at a table.
        starts_held: Whether the action starts with the object in the hand: the board has scenes that do.
        rng: Where chance comes from.
    """
    if robot == "three_dof":
        return _board(starts_held, rng)
    if robot == "mico_segway":
        return _table(random_ordering, COUNTER_X, COUNTER_Y, robot, rng)
    return _table(random_tabletop, TABLE_X, TABLE_Y, robot, rng)


def _board(starts_held: bool, rng: np.random.Generator) -> TrialScene:
    """A board with a task of the kind that people describe: from or to any stack."""
    from teleop import random_task

    task = random_task(random_board(rng), rng, kinds=("drop",) if starts_held else ("move",))
    return TrialScene(task.scene, task.object_id, np.asarray(task.task.goal, dtype=np.float64))


def _table(
    make: Callable[..., SceneSpec],
    region_x: tuple[float, float],
    region_y: tuple[float, float],
    robot: str,
    rng: np.random.Generator,
) -> TrialScene:
    """A table with a free place that is as far from the others as they are from each other."""
    while True:
        spec = make(rng)
        spec = spec if spec.robot == robot else spec.model_copy(update={"robot": robot})
        thing = spec.objects[int(rng.integers(len(spec.objects)))]
        others = [each for each in spec.objects if each.id != thing.id]
        for _ in range(DRAWN):
            place = np.array([rng.uniform(*region_x), rng.uniform(*region_y), thing.position[2]])
            away = float(np.hypot(*(place - thing.position)[:2]))
            if away > FARTHER and _clear(thing, place, others):
                return TrialScene(spec, thing.id, place)


def _clear(thing: ObjectSpec, place: FloatArray, others: Sequence[ObjectSpec]) -> bool:
    """Whether an object turned in any way is clear of the others at a place."""
    radius = float(np.hypot(*thing.half_extents[:2]))
    return all(
        float(np.hypot(*(place[:2] - np.array(each.position[:2]))))
        > radius + float(np.hypot(*each.half_extents[:2])) + CLEARANCE / 2
        for each in others
    )
