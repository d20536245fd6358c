"""The seven actions of the ordering collection as strokes of the hand, each done a little differently every time."""

from collections.abc import Callable, Iterator
from typing import Literal, get_args

import numpy as np

from executor.collections.closed_hand import HIDDEN, QUICK, SEEN, manner, press, push
from executor.collections.driven_grasps import ChosenGrasp, moved, reachable_grasps
from executor.collections.performance import PlannedDemo
from executor.collections.rehearsal import Rehearsal
from executor.collections.sight_lines import SightLines
from robots.pose import FloatArray, Pose
from teleop.strokes import Grip, Reach, Rest, Stroke
from twin import World

OrderingAction = Literal["grasp", "lift", "hold", "lower", "drop", "press", "push"]
ACTIONS: tuple[OrderingAction, ...] = get_args(OrderingAction)


def planned(world: World, action: OrderingAction, rng: np.random.Generator) -> PlannedDemo | None:
    """Plan a demo of an action with the scene's one object; None where the arm cannot do it here.

    Args:
        world: A world in which nothing has moved yet.
        action: What to show.
        rng: Source of all choices.
    """
    arm = next(iter(world.robot.arms))
    target = world.spec.objects[0].id
    return _PLANS[action](world, arm, target, rng)


def _grasp(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    speed = float(rng.uniform(0.12, 0.25))
    chosen = next(_seen_grasps(world, arm, target, rng, speed, SightLines(world, arm, target)), None)
    if chosen is None:
        return None
    shown = (Rest(0.2), *_taking(chosen), Rest(float(rng.uniform(0.3, 0.9))))
    return PlannedDemo(arm, target, shown, manner=manner(rng))


def _lifts(
    world: World, arm: str, target: int, rng: np.random.Generator, height: float, aside: float
) -> Iterator[tuple[ChosenGrasp, Pose]]:
    """Grasps from which the object can be lifted, and where the tool is then."""
    sight = SightLines(world, arm, target)
    for chosen in _seen_grasps(world, arm, target, rng, QUICK, sight):
        tool = chosen.grasp.pose_tool_in_world
        up = moved(tool, np.array([*rng.uniform(-aside, aside, 2), height]))
        holding = Rehearsal(world, arm, target, tool)
        # What is lifted from the table touches it at the start.
        lifted = holding.along(chosen.q, (Reach(up, QUICK),), chosen.grasp.width, -0.02)
        if not lifted.reason and sight.seen(lifted.q, chosen.grasp.width, up.position - tool.position) >= SEEN:
            yield chosen, up


def _seen_grasps(
    world: World, arm: str, target: int, rng: np.random.Generator, speed: float, sight: SightLines
) -> Iterator[ChosenGrasp]:
    """Grasps at which the arm does not hide the object from the robot's camera."""

    def dislike(q: FloatArray) -> float:
        return HIDDEN * (1.0 - sight.seen(q))

    for chosen in reachable_grasps(world, Rehearsal(world, arm), target, rng, speed, dislike):
        if sight.seen(chosen.q, chosen.grasp.width) >= SEEN:
            yield chosen


def _taking(chosen: ChosenGrasp) -> tuple[Stroke, ...]:
    """The way to a grasp, and the grasp."""
    return (*chosen.ways, Grip("close"))


def _lift(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    height, speed = float(rng.uniform(0.08, 0.18)), float(rng.uniform(0.06, 0.16))
    for chosen, up in _lifts(world, arm, target, rng, height, 0.02):
        shown = (Rest(float(rng.uniform(0.2, 0.6))), Reach(up, speed, near=0.004), Rest(float(rng.uniform(0.3, 0.8))))
        return PlannedDemo(arm, target, shown, _taking(chosen), manner(rng))
    return None


def _hold(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    height = float(rng.uniform(0.05, 0.15))
    for chosen, up in _lifts(world, arm, target, rng, height, 0.02):
        before = (*_taking(chosen), Reach(up, QUICK), Rest(0.5))
        return PlannedDemo(arm, target, (Rest(float(rng.uniform(2.3, 4.0))),), before, manner(rng))
    return None


def _lower(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    height, speed = float(rng.uniform(0.06, 0.15)), float(rng.uniform(0.05, 0.13))
    for chosen, up in _lifts(world, arm, target, rng, height, 0.0):
        before = (*_taking(chosen), Reach(up, QUICK), Rest(0.3))
        tool = chosen.grasp.pose_tool_in_world
        near = moved(tool, np.array([0.0, 0.0, 0.012]))
        down = moved(tool, np.array([0.0, 0.0, -0.006]))
        shown = (
            Rest(float(rng.uniform(0.2, 0.5))),
            Reach(near, speed, near=0.004),
            Reach(down, 0.03, push=3.0, near=0.001),
            Rest(float(rng.uniform(0.4, 0.9))),
        )
        return PlannedDemo(arm, target, shown, before, manner(rng))
    return None


def _drop(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    height = float(rng.uniform(0.022, 0.05))
    for chosen, up in _lifts(world, arm, target, rng, height, 0.01):
        before = (*_taking(chosen), Reach(up, QUICK), Rest(0.2))
        away = moved(up, -float(rng.uniform(0.03, 0.07)) * chosen.grasp.approach)
        leaving: tuple[Stroke, ...] = (Reach(away, 0.12, near=0.01),) if rng.random() < 0.5 else ()
        shown = (Rest(float(rng.uniform(0.3, 0.8))), Grip("open", 0.6), *leaving, Rest(0.9))
        return PlannedDemo(arm, target, shown, before, manner(rng))
    return None


_PLANS: dict[OrderingAction, Callable[[World, str, int, np.random.Generator], PlannedDemo | None]] = {
    "grasp": _grasp,
    "lift": _lift,
    "hold": _hold,
    "lower": _lower,
    "drop": _drop,
    "press": press,
    "push": push,
}
