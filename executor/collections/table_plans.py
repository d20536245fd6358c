"""Picking up, putting down and moving a thing on a table as strokes of a hand, each done a little differently."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from executor.collections.driven_grasps import ChosenGrasp, moved, pose_of, reachable_grasps
from executor.collections.performance import PlannedDemo
from executor.collections.rehearsal import Rehearsal
from executor.collections.table_goals import Goal, goals
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose
from teleop.annotators import TableAction
from teleop.strokes import Grip, Manner, Reach, Rest, Stroke
from twin import World

QUICK = 0.28
"""Speed of what is not shown [m/s]."""
SPEEDS = (0.10, 0.25)
"""Slowest and quickest hand [m/s]."""
MIDDLE = 0.10
"""Things so near to the middle are taken by either hand [m]."""
TURNS = (0.0, 0.4, -0.4, 0.9, -0.9, 1.5, -1.5)
"""By how much a thing is turned on the way where it is not in reach otherwise [rad]."""
GOALS_TRIED = 8
"""Goals that are tried in the mind with each grasp."""
FAR_ENOUGH = 0.09
"""What is moved is brought so far at least [m]."""
SETTLING = 0.012
"""Height from which a thing is set down slowly [m],"""
SLOW = 0.03
"""at this speed [m/s],"""
TOUCHED = 3.0
"""until the table pushes back with this force [N];"""
BELOW = 0.003
"""the hand goes on so far below at most [m]."""
CARRIED_CLEAR = 0.006
"""Least distance of what is carried from other things [m]."""


@dataclass(frozen=True, slots=True)
class TablePlan:
    """A planned demo and where the thing goes.

    Attributes:
        demo: The demo.
        goal: Where the thing goes; None when it is only picked up.
    """

    demo: PlannedDemo
    goal: Goal | None = None


def planned(world: World, action: TableAction, target: int, rng: np.random.Generator) -> TablePlan | None:
    """Plan a demo of an action; None where no arm can do it here.

    Args:
        world: A world in which nothing has moved yet.
        action: What to show.
        target: With which thing.
        rng: Source of all choices.
    """
    for arm in _arms(world, target, rng):
        plan = _picking(world, arm, target, rng) if action == "pick up" else _putting(world, arm, target, action, rng)
        if plan is not None:
            return plan
    return None


def _arms(world: World, target: int, rng: np.random.Generator) -> list[str]:
    """The hands, that on the thing's side first."""
    side = float(pose_of(world, target).position[1])
    homes = {name: float(arm.forward_kinematics(arm.home).position[1]) for name, arm in world.robot.arms.items()}
    mine = sorted(homes, key=lambda name: -side * homes[name])
    return mine[::-1] if abs(side) < MIDDLE and rng.random() < 0.5 else mine


def _manner(rng: np.random.Generator) -> Manner:
    return Manner(tremble=float(rng.uniform(0.002, 0.008)), hesitation=float(rng.uniform(0.05, 0.3)))


def _picking(world: World, arm: str, target: int, rng: np.random.Generator) -> TablePlan | None:
    speed = float(rng.uniform(*SPEEDS))
    for chosen in reachable_grasps(world, Rehearsal(world, arm), target, rng, speed):
        tool, width = chosen.grasp.pose_tool_in_world, chosen.grasp.width
        height = float(rng.uniform(0.08, 0.22))
        aside = rng.uniform(-0.06, 0.06, 2) if rng.random() < 0.5 else np.zeros(2)
        end = moved(tool, np.array([*aside, height]))
        off = moved(tool, np.array([0.0, 0.0, 0.03]))
        arched = (Reach(moved(tool, np.array([*(0.3 * aside), 0.7 * height])), 0.8 * speed, onwards=True),)
        lifting: tuple[Reach, ...] = (*(arched if rng.random() < 0.4 else ()), Reach(end, 0.7 * speed, near=0.006))
        holding = Rehearsal(world, arm, target, tool)
        up = holding.along(chosen.q, (Reach(off, speed),), width, -0.02)
        if up.reason or holding.along(up.q, lifting, width, CARRIED_CLEAR).reason:
            continue
        taking = (Rest(0.2), *_with_pause(chosen.ways, rng), Grip("close"))
        shown: tuple[Stroke, ...] = (*taking, *lifting, Rest(float(rng.uniform(0.6, 1.5))))
        return TablePlan(PlannedDemo(arm, target, shown, manner=_manner(rng)))
    return None


def _putting(world: World, arm: str, target: int, action: TableAction, rng: np.random.Generator) -> TablePlan | None:
    speed = float(rng.uniform(*SPEEDS))
    coming = QUICK if action == "put down" else speed
    here = pose_of(world, target).position[:2]
    wanted = [
        goal
        for goal in goals(world, target, rng)
        if action == "put down" or np.linalg.norm(goal.position[:2] - here) > FAR_ENOUGH
    ][:GOALS_TRIED]
    for chosen in _few(reachable_grasps(world, Rehearsal(world, arm), target, rng, coming)):
        holding = Rehearsal(world, arm, target, chosen.grasp.pose_tool_in_world)
        alone = Rehearsal(world, arm, without={target})
        for goal in wanted:
            carried = _carrying(world, holding, alone, chosen, goal, target, speed, rng)
            if carried is None:
                continue
            lift, rest = carried
            start = Reach(lift.pose, coming, near=0.006)
            taking: tuple[Stroke, ...] = (*chosen.ways, Grip("close"))
            if action == "put down":
                demo = PlannedDemo(
                    arm, target, (Rest(float(rng.uniform(0.4, 1.2))), *rest), (*taking, start, Rest(0.3)), _manner(rng)
                )
            else:
                shown = (Rest(0.2), *_with_pause(taking, rng), lift, *rest)
                demo = PlannedDemo(arm, target, shown, manner=_manner(rng))
            return TablePlan(demo, goal)
    return None


def _few(grasps: Iterator[ChosenGrasp]) -> Iterator[ChosenGrasp]:
    for _, chosen in zip(range(3), grasps, strict=False):
        yield chosen


def _carrying(
    world: World,
    holding: Rehearsal,
    alone: Rehearsal,
    chosen: ChosenGrasp,
    goal: Goal,
    target: int,
    speed: float,
    rng: np.random.Generator,
) -> tuple[Reach, tuple[Stroke, ...]] | None:
    """The lift and what follows it, until the thing is let go at a goal and the hand has left; None if that fails."""
    tool, width = chosen.grasp.pose_tool_in_world, chosen.grasp.width
    thing = pose_of(world, target).position
    height = float(rng.uniform(0.07, 0.16))
    arched = rng.random() < 0.5
    lift = Reach(moved(tool, np.array([0.0, 0.0, height])), speed, near=0.006, onwards=arched)
    off = Reach(moved(tool, np.array([0.0, 0.0, 0.03])), speed)
    up = holding.along(chosen.q, (off,), width, -0.02)
    if up.reason:
        return None
    first = float(rng.uniform(-0.5, 0.5)) if rng.random() < 0.3 else 0.0
    for turn in (first, *TURNS):
        at = _turned_about(tool, thing, turn, goal.position)
        above = float(rng.uniform(0.06, 0.12)) + max(float(goal.position[2] - thing[2]), 0.0)
        over = moved(at, np.array([0.0, 0.0, above]))
        near = Reach(moved(at, np.array([0.0, 0.0, SETTLING])), 0.7 * speed, near=0.004)
        way: tuple[Reach, ...] = (Reach(over, speed, near=0.008),)
        if arched:
            middle = 0.5 * (lift.pose.position + over.position) + [0.0, 0.0, float(rng.uniform(0.02, 0.05))]
            half = _turned_about(tool, thing, 0.5 * turn, goal.position).orientation_xyzw
            way = (Reach(Pose(middle, half), speed, onwards=True), Reach(over, speed, onwards=True))
        came = holding.along(up.q, (lift, *way, near), width, CARRIED_CLEAR)
        if came.reason:
            continue
        down = holding.along(came.q, (Reach(at, SLOW),), width, -0.02)
        if down.reason or alone.free(down.q, None, -0.002):
            continue
        approach = rotation_matrix(at.orientation_xyzw) @ holding.arm.gripper.approach
        away = moved(at, -float(rng.uniform(0.05, 0.09)) * approach)
        clear = moved(away, np.array([0.0, 0.0, float(rng.uniform(0.03, 0.08))]))
        leaving = (Reach(away, speed, onwards=True), Reach(clear, speed, near=0.015, aligned=0.1))
        if alone.along(down.q, (leaving[0],), None, -0.002).reason:
            continue
        setting = Reach(moved(at, np.array([0.0, 0.0, 0.0 if goal.falls else -BELOW])), SLOW, near=0.001, push=TOUCHED)
        pause = (Rest(float(rng.uniform(0.3, 0.8))),) if rng.random() < 0.25 else ()
        return lift, (*way, *pause, near, setting, Grip("open"), *leaving, Rest(float(rng.uniform(0.4, 1.0))))
    return None


def _with_pause(strokes: tuple[Stroke, ...], rng: np.random.Generator) -> tuple[Stroke, ...]:
    """Now and then, a pause before one of the strokes."""
    if rng.random() > 0.3:
        return strokes
    number = int(rng.integers(1, len(strokes))) if len(strokes) > 1 else 0
    return (*strokes[:number], Rest(float(rng.uniform(0.3, 0.8))), *strokes[number:])


def _turned_about(tool: Pose, thing: FloatArray, turn: float, goal: FloatArray) -> Pose:
    """Where the tool is when the thing that it holds is at a goal, turned about the vertical [rad]."""
    cos, sin = np.cos(turn), np.sin(turn)
    about = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    orientation = quaternion_xyzw(about @ rotation_matrix(tool.orientation_xyzw))
    return Pose(goal + about @ (tool.position - thing), orientation)
