"""Trying learned actions in new scenes, judged by physics."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from executor.actions.learned import LearnedAction
from executor.actions.player import ActionPlayer
from executor.actions.success import fault_of
from executor.actions.trial_scenes import trial_scene
from executor.actions.witness import WitnessedWorld
from executor.collection import in_processes
from executor.errors import RefusalError
from executor.follow import wait

REST = 0.7
"""Time [s] in which all comes to rest before the judge looks."""


@dataclass(frozen=True, slots=True)
class ActionTrial:
    """One trial to make.

    Attributes:
        action: What was learned.
        robot: The robot that tries it.
        seed: Seed of the trials.
        number: Number of the trial among those of its action.
    """

    action: LearnedAction
    robot: str
    seed: int
    number: int


@dataclass(frozen=True, slots=True)
class Tried:
    """How a trial went.

    Attributes:
        action: True name of the action.
        source: The robot that showed it.
        robot: The robot that tried it.
        number: Number of the trial.
        thing: What it was tried with.
        fault: What went wrong; empty when it succeeded. The words before the first colon are the kind of failure.
    """

    action: str
    source: str
    robot: str
    number: int
    thing: str
    fault: str

    @property
    def cause(self) -> str:
        """Kind of failure."""
        return self.fault.split(":")[0]


def try_action(trial: ActionTrial) -> Tried:
    """Play a learned action in a scene of its own; equal trials go alike."""
    action = trial.action
    rng = np.random.default_rng([trial.seed, trial.number, *trial.robot.encode(), *action.name.encode()])
    states = action.graphlet.states
    scene = trial_scene(trial.robot, states[0].holds, rng)
    thing = next(each for each in scene.spec.objects if each.id == scene.object_id)
    goal = scene.destination if any(not state.holds for state in states[1:]) else None
    name = thing.model or f"{thing.colour} {thing.shape}"
    with WitnessedWorld(scene.spec) as world:
        try:
            played = ActionPlayer(world, rng).play(
                action.graphlet,
                scene.object_id,
                goal,
                action.quantities,
                on_start=lambda arm: world.watch(scene.object_id, arm),
            )
        except RefusalError as refusal:
            fault = f"refused: {refusal}"
        else:
            fault = played.reason
        if not fault:
            wait(world, REST, world.commanded_openings)
            evidence = world.evidence()
            fault = "not begun" if evidence is None else fault_of(action.name, evidence, goal)
    return Tried(action.name, action.robot, trial.robot, trial.number, name, fault)


def try_actions(
    actions: Sequence[LearnedAction],
    robot: str,
    scenes: int,
    seed: int,
    jobs: int = 0,
    on_trial: Callable[[], None] = lambda: None,
) -> list[Tried]:
    """Try each action in so many new scenes; returns how each trial went, in order."""
    trials = [ActionTrial(action, robot, seed, number) for action in actions for number in range(scenes)]
    done = sorted(in_processes(try_action, trials, jobs, on_trial), key=lambda pair: pair[0])
    return [tried for _, tried in done]
