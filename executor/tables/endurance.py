"""Commands without a pause at one table: does the world stay sound, and does memory stay flat?"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from executor.actions.success import fault_of
from executor.actions.things import clear_below, pose_of
from executor.actions.witness import WitnessedWorld
from executor.collections import leeds, ordering
from executor.collections.performance import PlannedDemo
from executor.collections.table_goals import Goal, put_rule
from executor.execution.answer import Answer
from executor.execution.evaluation.endurance import UNDONE, WARM, Endurance, resident
from executor.executor import Executor
from executor.follow import wait
from executor.tables.commands import LOOKS, SETTLE, Judge, by_rule
from executor.tables.table_doer import TableDoer
from learning import Knowledge
from robots.kinematics import rotation_matrix
from teleop.annotators import (
    Destination,
    OrderingFacts,
    Place,
    TableAction,
    TableFacts,
    Thing,
    place_at,
    tell_ordering,
    tell_table,
)
from twin import WorldState

PEOPLE = 5
"""People who are asked to say it, until one says it without a mistake."""
EMPTY_HANDED = ("grasp", "lift", "hold", "lower", "drop", "press", "push")
"""What can be said at the counter,"""
RAISED, GRASPED = ("hold", "lower", "drop"), ("lift", "hold")
"""The same while the thing is in the hand, in the air or still on the counter."""
OFF = 0.02
"""In the air it is so far above the counter [m]."""
UPRIGHT = 0.88
"""A thing whose vertical axis points up by less than this (cosine) lies on its side, and is put back too."""
OFF_COUNTER_X, OFF_COUNTER_Y = (0.42, 0.72), (-0.25, 0.25)
"""Where the thing leaves this [m], it is put back by hand, as people do."""
UNTOUCHED = 0.004
"""What nothing was done to moves less than this in a command [m]."""

Asked = tuple[str, int, Judge]
"""A sentence, the id of the thing that it is about, and who judges what comes of it."""


@dataclass(slots=True)
class _Tally:
    """What is counted on the way."""

    commands: int = 0
    right: int = 0
    done: int = 0
    false: int = 0
    undone: int = 0
    passed: float = 0.0
    drift: float = 0.0
    errors: list[str] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    memory: list[float] = field(default_factory=list)


def endure_at_table(
    robot: str, knowledge: Path, minutes: float, seed: int, language: str, on_minute: Callable[[], None]
) -> Endurance:
    """Give commands for so many simulated minutes: each about the world as the last one left it.

    Where the thing of a counter was pushed to its edge or fell over, the world is put back to its start, as somebody
    would do.
    `drift` is how far things moved, in one command at most, that it was not about.

    Args:
        robot: `baxter` or `mico_segway`.
        knowledge: Knowledge file.
        minutes: Simulated time [min].
        seed: Seed of scene, commands and noise.
        language: Language of the sentences.
        on_minute: Called after every simulated minute.
    """
    rng = np.random.default_rng([seed, 13, *robot.encode()])
    tally, told = _Tally(), 0
    scene = (
        leeds.scene_with(rng, "red_cube", seed)
        if robot == "baxter"
        else ordering.scene_with(rng, "small_red_can", seed)
    )
    with WitnessedWorld(scene) as world:
        start = world.snapshot()
        executor = Executor(world, Knowledge.load(knowledge), rng)
        doer = executor.doer
        assert isinstance(doer, TableDoer)
        doer.on_start = world.watch
        while tally.passed < 60.0 * minutes:
            asked = _at_tabletop(world, rng, language) if robot == "baxter" else _at_counter(world, rng, language)
            if asked is None:
                world.restore(start)
                doer.resume()
                continue
            _give(world, executor, asked, rng, tally)
            while told < tally.passed / 60.0:
                told += 1
                on_minute()
        doer.close()
    memory = tally.memory or [resident()]
    return Endurance(
        tally.commands,
        tally.right,
        tally.done,
        tally.false,
        tally.undone,
        tally.passed,
        tally.drift,
        (memory[0], memory[len(memory) // 2], memory[-1]),
        tuple(tally.errors),
        tuple(tally.faults),
    )


def _give(world: WitnessedWorld, executor: Executor, asked: Asked, rng: np.random.Generator, tally: _Tally) -> None:
    """Give one command, and count what came of it."""
    sentence, target, judge = asked
    before = world.state()
    try:
        report = executor.execute(sentence)
    except Exception as error:  # a crash is what is looked for
        tally.errors.append(f"{sentence}: {type(error).__name__}: {error}")
        return
    after = world.state()
    # A command that is answered without a motion takes no time: a second of it counts, so that all this ends.
    tally.passed += max(after.time - before.time, 1.0)
    tally.commands += 1
    fault = judge(world, before)
    tally.right += not fault
    tally.done += report.success
    tally.false += report.answer is Answer.DONE and bool(fault)
    if fault:
        tally.faults.append(f"{sentence}: {report.answer}, {fault}; told: {report.reason}")
    else:
        moves = [
            float(np.linalg.norm(pose_of(after, each.id).position - each.pose_object_in_world.position))
            for each in before.objects
            if each.id != target
        ]
        tally.drift = max([tally.drift, *(move for move in moves if move < UNTOUCHED)])
    if report.answer.moved and rng.random() < UNDONE:
        executor.undo()
        tally.undone += 1
        if _apart(before, world.state()) > 1e-9:
            tally.errors.append(f"{sentence}: undone, and the world is not as before")
    if tally.commands >= WARM:
        tally.memory.append(resident())


def _at_tabletop(world: WitnessedWorld, rng: np.random.Generator, language: str) -> Asked | None:
    """Pick up a thing, or bring it to another part of the table; what is in a hand is brought somewhere."""
    state = world.state()
    looks = {each.id: each for each in world.spec.objects}
    where = {each.id: each.pose_object_in_world.position for each in state.objects}
    things = tuple(
        Thing(number, looks[number].shape, looks[number].colour, float(at[0]), float(at[1]))
        for number, at in where.items()
    )
    held = next((arm.held for arm in state.arms if arm.gripper_closed and arm.held is not None), None)
    on_it = [each for each in things if where[each.id][2] > 0.0]
    if not on_it:
        return None
    target = next((each for each in things if each.id == held), on_it[int(rng.integers(len(on_it)))])
    action: TableAction = "put down" if held is not None else "pick up" if rng.random() < 0.3 else "move"
    goal = None
    if action != "pick up":
        place = _free_place(target, things, rng)
        if place is None:
            return None
        goal = Goal(Destination(place=place), np.asarray(where[target.id]))
    facts = TableFacts(action, target, things, None if goal is None else goal.destination, action == "put down")
    told = tell_table(facts, PEOPLE, language, rng)
    sentence = next((each.text for each in told if not each.mistakes), told[0].text)
    rule = put_rule(world, action, target.id, goal)
    return sentence, target.id, by_rule(rule, PlannedDemo("", target.id, ()))


def _free_place(target: Thing, things: tuple[Thing, ...], rng: np.random.Generator) -> Place | None:
    """A part of the table where nothing stands."""
    taken = {each.place for each in things}
    free: list[Place] = [
        place_at(x, y) for x, y in leeds.PLACES if place_at(x, y) not in taken and place_at(x, y) != target.place
    ]
    return free[int(rng.integers(len(free)))] if free else None


def _at_counter(world: WitnessedWorld, rng: np.random.Generator, language: str) -> Asked | None:
    """Any action with the thing on the counter; None where somebody has to put it back."""
    state = world.state()
    spec = world.spec.objects[0]
    x, y, z = pose_of(state, spec.id).position.tolist()
    held = any(arm.held == spec.id and arm.gripper_closed for arm in state.arms)
    inside = OFF_COUNTER_X[0] < x < OFF_COUNTER_X[1] and OFF_COUNTER_Y[0] < y < OFF_COUNTER_Y[1]
    lies = rotation_matrix(pose_of(state, spec.id).orientation_xyzw)[2, 2] < UPRIGHT
    if not held and (not inside or z < 0.0 or lies):
        return None
    raised = clear_below(world, spec.id) > OFF
    known = EMPTY_HANDED if not held else RAISED if raised else GRASPED
    action = known[int(rng.integers(len(known)))]
    told = [tell_ordering(OrderingFacts.of_model(action, str(spec.model)), language, rng) for _ in range(PEOPLE)]
    sentence = next((each.text for each in told if not each.mistakes), told[0].text)

    def judge(world: WitnessedWorld, before: WorldState) -> str:
        wait(world, SETTLE * LOOKS, world.commanded_openings)
        evidence = world.evidence()
        return "not begun: nothing was touched" if evidence is None else fault_of(action, evidence, None)

    return sentence, spec.id, judge


def _apart(one: WorldState, other: WorldState) -> float:
    pairs = zip(one.objects, other.objects, strict=True)
    return max(float(np.abs(a.pose_object_in_world.position - b.pose_object_in_world.position).max()) for a, b in pairs)
