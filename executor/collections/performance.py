"""Driving a planned demo and recording it: what leads to its start is driven first and kept as the demo's prelude."""

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from teleop.drive_command import DriveCommand
from teleop.drive_session import DriveSession
from teleop.gamepad import GamepadState
from teleop.gamepad_mapping import GamepadMapping
from teleop.record import STATE_EVERY
from teleop.recorder import Recorder
from teleop.strokes import Manner, Stroke
from teleop.table_operator import LOOK_EVERY, TableOperator
from twin import World
from twin.state import WorldState

LONGEST = 40.0
"""A performance that takes longer is given up [s]."""


@dataclass(frozen=True, slots=True)
class PlannedDemo:
    """What the operator will do.

    Attributes:
        arm: The arm that acts.
        target: Id of the object that is handled.
        shown: The strokes of the demo.
        before: Strokes that lead to its start.
        manner: How the operator drives.
    """

    arm: str
    target: int
    shown: tuple[Stroke, ...]
    before: tuple[Stroke, ...] = ()
    manner: Manner = Manner()


@dataclass(frozen=True, slots=True)
class Shown:
    """What was to be seen from a demo's start to its end, 30 times a second.

    Attributes:
        plan: What was planned.
        hand: Number of the arm that acts.
        states: States of the world, at least two.
        felt: Largest force against the hand's motion that its operator felt [N].
    """

    plan: PlannedDemo
    hand: int
    states: tuple[WorldState, ...]
    felt: float


Judge = Callable[[Shown], str]
"""Says what is wrong with a demo as shown; empty when it shows what it shall."""


def perform(
    world: World,
    plan: PlannedDemo,
    judge: Judge,
    path: Path,
    sentences: Callable[[WorldState], list[tuple[str, str]]],
    rng: np.random.Generator,
) -> str:
    """Drive and record; the file is removed again when something went wrong.

    Args:
        world: A world in which nothing has moved yet.
        plan: What to do.
        judge: Says whether the demo shows what it shall.
        path: Where the demo goes.
        sentences: Sentence and language of each utterance, told the state in which the demo starts.
        rng: Source of the operator's tremble.

    Returns:
        What went wrong; empty when all is well.
    """
    session, arms = DriveSession(world), tuple(world.robot.arms)
    driven: list[DriveCommand] = []
    if plan.before:
        operator = TableOperator(arms, plan.arm, plan.before, rng, plan.manner)
        command = DriveCommand()
        while not operator.done or len(driven) % STATE_EVERY:
            if len(driven) % LOOK_EVERY == 0:
                command = operator.act(world.state())
            result = session.step(command)
            driven.append(command)
            if operator.failed:
                held_back = f" ({result.reason})" if result.reason else ""
                return f"before the start: {operator.failed}{held_back}"
            if world.time > LONGEST:
                return "too slow: it took too long to come to the start"
    details = {"trim": json.dumps({"origin": path.with_suffix(".mcap").name, "first": len(driven), "last": -1})}
    rate, begun = round(1.0 / World.DT), world.time
    operator = TableOperator(arms, plan.arm, plan.shown, rng, plan.manner)
    states: list[WorldState] = []
    reason = ""
    try:
        with Recorder(
            path, world.spec, GamepadMapping(), rate, robot=world.robot, details=details if driven else None
        ) as recorder:
            for step, command in enumerate(driven):
                recorder.prelude(step, command)
            for text, language in sentences(world.state()):
                recorder.utterance(text, language=language)
            command, step = DriveCommand(), 0
            while True:
                if step % LOOK_EVERY == 0:
                    state = world.state()
                    if step % STATE_EVERY == 0:
                        states.append(state)
                        recorder.state(step, replace(state, time=state.time - begun))
                        if operator.done or world.time > LONGEST:
                            break
                    command = operator.act(state)
                recorder.drive(step, GamepadState(), command, session.step(command))
                step += 1
            reason = operator.failed or ("" if operator.done else "too slow: it took too long")
            reason = reason or judge(Shown(plan, arms.index(plan.arm), tuple(states), operator.felt))
            recorder.outcome("failure" if reason else "success", reason)
    finally:
        if reason or not states:
            path.unlink(missing_ok=True)
    return reason
