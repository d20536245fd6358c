"""The whole loop: teleoperated demos are recorded, perceived and learned from, and new commands are tried."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from time import perf_counter

import numpy as np

from executor.collection import BoardCollection, Recorded, in_processes, record_board
from executor.demo_files import open_demo
from executor.trial import Trial, Verdict, new_task, run_trial
from learning import Knowledge, Learner
from learning.concepts import DemoConcepts, fit_demo
from learning.perception import Observation, observe_demo

TRIAL_SEEDS = 1_000_000
"""Added to the seed for new commands, so that no scene and sentence of a demo comes back."""


@dataclass(frozen=True, slots=True)
class Shown:
    """A recorded demo as the learner gets it.

    Attributes:
        recorded: The file.
        utterances: What was said.
        observation: What perception got of it.
        concepts: The demo's own mixtures.
    """

    recorded: Recorded
    utterances: tuple[str, ...]
    observation: Observation
    concepts: DemoConcepts


@dataclass(frozen=True, slots=True)
class Lessons:
    """What came of showing.

    Attributes:
        knowledge: What was learned.
        recorded: The demos, in order.
        sentences: Sentences heard.
        validated: How many were read in a way that does what was shown.
        seconds: Wall-clock time [s].
    """

    knowledge: Knowledge
    recorded: tuple[Recorded, ...]
    sentences: int
    validated: int
    seconds: float


def show_one(collection: BoardCollection, number: int) -> Shown:
    """Record one demo, read it back from its file, and perceive it."""
    recorded = record_board(collection, number)
    demo = open_demo(recorded.path)
    rng = np.random.default_rng([collection.seed, number, 1])
    observation = observe_demo(demo, rng)
    return Shown(recorded, demo.utterances, observation, fit_demo(observation, rng))


def show_and_learn(collection: BoardCollection, count: int, jobs: int, on_demo: Callable[[], None]) -> Lessons:
    """Record demos in several processes and learn from them in order, one at a time, as they come.

    Args:
        collection: What to record. Earlier demos in its folder are replaced, once all new ones are there.
        count: How many demos.
        jobs: Processes; 0 takes one a core.
        on_demo: Called after every demo.
    """
    begun = perf_counter()
    folder = collection.folder
    fresh = folder.with_name(f"{folder.name}.partial")
    shutil.rmtree(fresh, ignore_errors=True)
    fresh.mkdir(parents=True)
    learner = Learner(seed=collection.seed)
    waiting: dict[int, Shown] = {}
    recorded: list[Recorded] = []
    sentences = validated = 0
    work = partial(show_one, replace(collection, folder=fresh))
    for index, shown in in_processes(work, range(count), jobs, on_demo):
        waiting[index] = shown
        while len(recorded) in waiting:  # in order, so that the same seed learns the same
            each = waiting.pop(len(recorded))
            lesson = learner.study(each.observation, each.utterances, each.concepts)
            sentences, validated = sentences + lesson.sentences, validated + lesson.validated
            recorded.append(each.recorded)
    learner.settle()
    shutil.rmtree(folder, ignore_errors=True)
    fresh.rename(folder)
    return Lessons(learner.knowledge, tuple(recorded), sentences, validated, perf_counter() - begun)


def try_commands(
    knowledge: Path,
    count: int,
    seed: int,
    robot: str | None,
    variety: float,
    jobs: int,
    view_size: tuple[int, int],
    on_trial: Callable[[], None],
) -> list[Verdict]:
    """Try new commands in new scenes, in several processes; the first move is filmed."""
    kinds = [new_task(seed + TRIAL_SEEDS, number, variety).kind for number in range(count)]
    first_move = kinds.index("move") if "move" in kinds else 0
    trials = [
        Trial(seed + TRIAL_SEEDS, number, knowledge, robot, variety, view_size, filmed=number == first_move)
        for number in range(count)
    ]
    done = in_processes(run_trial, trials, jobs, on_trial)
    return [verdict for _, verdict in sorted(done, key=lambda pair: pair[0])]
