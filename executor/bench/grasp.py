"""Random picks, lifts, carries of 0.3 m and places, by friction alone, over all objects of a robot."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from executor.bench.pool import spread
from executor.bench.report import BenchReport
from executor.handling import CarryPlan, Handling
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose
from twin import SceneSpec, World
from twin.board import ALL_COLOURS_RGB, ALL_SHAPES, CELL, CELLS, cell_centre
from twin.objects import CATALOGUES
from twin.ordering_scene import random_ordering
from twin.scene_spec import ObjectSpec
from twin.tabletop_scene import random_tabletop
from twin.world import TABLE_X, TABLE_Y

LIFT = 0.10
CARRY = 0.30
"""Height and length [m] of what is done with each object."""
DIRECTIONS = 24
"""Directions of the carry that are tried, in random order; the first that ends on the table and in reach is taken."""
TURNS = (0.0, 0.5, -0.5, 1.0, -1.0, 1.57, -1.57, 2.2, -2.2)
"""Turns about the vertical [rad] that are tried where no straight carry is in reach."""
BESIDE = 0.20
"""How far beside the board a block may end [m]: from its middle no carry of 0.3 m ends on it."""
ROOM = 0.06
"""Distance [m] of an object's goal from the edges of the table."""
NEAR = 0.02
"""How far [m] from its goal an object may end."""
UPRIGHT = 0.17
"""By how much [rad] it may have tilted: 10 degrees."""
APART = 0.12
"""Distance [m] of the goal from other objects."""
REST = 1.0
"""Time [s] after which the object must be where it was put."""


@dataclass(frozen=True, slots=True)
class Pick:
    """One trial.

    Attributes:
        robot: The robot.
        model: The object.
        reason: Why it failed; empty when it did not.
        off: Distance of the object from its goal at the end [m]; NaN where it was never let go.
        slip: Largest movement in the hand seen at the ends of the motions [m].
    """

    robot: str
    model: str
    reason: str
    off: float = float("nan")
    slip: float = 0.0


def objects_of(robot: str) -> tuple[str, ...]:
    """Names of all objects that a robot is tried with."""
    if robot == "baxter":
        return CATALOGUES["tabletop"]
    if robot == "mico_segway":
        return CATALOGUES["ordering"]
    return tuple(f"{colour} {shape}" for shape in ALL_SHAPES for colour in ALL_COLOURS_RGB)


def run(
    seed: int, picks: int, robots: Sequence[str], jobs: int = 0, on_done: Callable[[], None] = lambda: None
) -> BenchReport:
    """Try every robot.

    Args:
        seed: Decides scenes, order of objects, and directions.
        picks: Trials a robot; each object has its turn before one is tried again.
        robots: Their names.
        jobs: Processes; 0 takes one a core.
        on_done: Called after each trial.
    """
    figures: dict[str, float | None] = {}
    notes: list[str] = []
    for number, robot in enumerate(robots):
        names = list(objects_of(robot))
        np.random.default_rng([seed, number]).shuffle(names)
        tasks = [(robot, names[trial % len(names)], seed, trial) for trial in range(picks)]
        done = []
        for each in spread(try_pick, tasks, jobs):
            done.append(each)
            on_done()
        good = [each for each in done if not each.reason]
        figures[f"{robot}.success"] = len(good) / picks
        figures[f"{robot}.picks"] = picks
        figures[f"{robot}.objects"] = len({each.model for each in done})
        figures[f"{robot}.median_off_mm"] = 1000 * float(np.median([each.off for each in good])) if good else None
        figures[f"{robot}.worst_slip_mm"] = 1000 * max((each.slip for each in good), default=0.0)
        failed = Counter((each.model, each.reason) for each in done if each.reason)
        notes += [f"{robot}: {model}: {reason} (x{count})" for (model, reason), count in sorted(failed.items())]
    settings = {
        "showtell": f"friction only (no constraint holds anything); lift {LIFT:g} m, carry {CARRY:g} m, place; right "
        f"if the object was held all the way and lies at rest within {1000 * NEAR:g} mm and {UPRIGHT:g} rad of its "
        f"goal {REST:g} s after it was let go"
    }
    return BenchReport(figures, settings=settings, notes=tuple(notes))


def try_pick(task: tuple[str, str, int, int]) -> Pick:
    """Make one trial in a world of its own: robot, object, seed and number of the trial."""
    robot, name, seed, trial = task
    rng = np.random.default_rng([seed, trial, *robot.encode()])
    with World(_scene(robot, name, rng)) as world:
        return _pick(world, robot, name, rng)


def _pick(world: World, robot: str, name: str, rng: np.random.Generator) -> Pick:
    target = world.spec.objects[0].id
    start = _pose(world, target)
    reason = ""
    for arm in _arms_by_nearness(world, start):
        hands = Handling(world, arm, rng)
        picked = hands.pick(target, LIFT)
        if picked.success or not picked.reason.startswith(("out of reach", "no room", "no way")):
            break
        reason = picked.reason  # the other arm may reach it
    if not picked.success:
        return Pick(robot, name, reason or picked.reason)
    slips = [picked.slip.distance if picked.slip else 0.0]
    found = _way(world, hands, start, target, rng)
    if found is None:
        return Pick(robot, name, "no direction: no carry of 0.3 m ends on the table, free and in reach")
    way, plan = found
    carried = hands.carry(plan)
    if not carried.success:
        return Pick(robot, name, carried.reason)
    slips.append(carried.slip.distance if carried.slip else 0.0)
    placed = hands.place(plan)
    if not placed.success:
        return Pick(robot, name, placed.reason)
    hands.rest(REST)
    end = _pose(world, target)
    off = float(np.linalg.norm(end.position - start.position - way))
    tilt = _tilt(start, end)
    if off > NEAR:
        return Pick(robot, name, f"misplaced: {1000 * off:.0f} mm from its goal", off, max(slips))
    if tilt > UPRIGHT:
        return Pick(robot, name, f"toppled: tilted by {tilt:.2f} rad", off, max(slips))
    return Pick(robot, name, "", off, max(slips))


def _scene(robot: str, name: str, rng: np.random.Generator) -> SceneSpec:
    """A random scene whose first object is the one to pick."""
    if robot == "baxter":
        return random_tabletop(rng, including=name)
    if robot == "mico_segway":
        return random_ordering(rng, including=name)
    colour, shape = name.split()
    cells = rng.permutation(CELLS * CELLS)[: rng.integers(4, 9)]
    looks = [(colour, shape)]
    looks += [(str(rng.choice(list(ALL_COLOURS_RGB))), str(rng.choice(ALL_SHAPES))) for _ in cells[1:]]
    objects = tuple(
        ObjectSpec(
            id=number, colour=each[0], shape=each[1], position=tuple(cell_centre(cell % CELLS, cell // CELLS, 0))
        )
        for number, (each, cell) in enumerate(zip(looks, cells.tolist(), strict=True))
    )
    return SceneSpec(name="board", robot=robot, objects=objects)


def _arms_by_nearness(world: World, thing: Pose) -> list[str]:
    """Names of the arms, the one whose shoulder side the object lies on first."""
    arms = world.robot.arms
    homes = {name: arm.forward_kinematics(arm.home).position for name, arm in arms.items()}
    return sorted(arms, key=lambda name: float(np.linalg.norm(homes[name][:2] - thing.position[:2])))


def _way(
    world: World, hands: Handling, start: Pose, target: int, rng: np.random.Generator
) -> tuple[FloatArray, CarryPlan] | None:
    """A random carry that ends on the table or board, apart from other objects, in reach.

    Returns:
        The way, (3,) [m], and its plan, with as little turning about the vertical as reach allows.
    """
    if world.spec.kind == "board":
        low, high = np.full(2, -BESIDE), np.full(2, CELLS * CELL + BESIDE)
    else:
        low, high = np.array([TABLE_X[0], TABLE_Y[0]]) + ROOM, np.array([TABLE_X[1], TABLE_Y[1]]) - ROOM
    others = [each.pose_object_in_world.position[:2] for each in world.state().objects if each.id != target]
    apart = CELL if world.spec.kind == "board" else APART
    first = rng.uniform(-np.pi, np.pi)
    ways = []
    for number in rng.permutation(DIRECTIONS):
        angle = first + 2 * np.pi * number / DIRECTIONS
        way = CARRY * np.array([np.cos(angle), np.sin(angle), 0.0])
        goal = start.position[:2] + way[:2]
        inside = bool(np.all(goal >= low) and np.all(goal <= high))
        if inside and all(np.linalg.norm(goal - other) >= apart for other in others):
            ways.append(way)
    turns = TURNS if world.spec.kind == "table" else (0.0,)
    drop = float(_pose(world, target).position[2] - start.position[2])
    for turn in turns:
        for way in ways:
            if (plan := hands.plan_carry(way, turn, drop)) is not None:
                return way, plan
    return None


def _pose(world: World, target: int) -> Pose:
    return next(each.pose_object_in_world for each in world.state().objects if each.id == target)


def _tilt(start: Pose, end: Pose) -> float:
    """Angle [rad] between the object's vertical axis before and after."""
    before, after = rotation_matrix(start.orientation_xyzw)[:, 2], rotation_matrix(end.orientation_xyzw)[:, 2]
    return float(np.arccos(np.clip(before @ after, -1.0, 1.0)))
