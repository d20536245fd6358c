"""Making collections of scripted demos: random scenes and tasks, recorded over several processes."""

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import numpy as np

from executor.errors import InputError
from robots.workers import end_with_parent, worker_count
from twin.quiet import load_physics

VARIETY = 0.25
"""Usual probability of each word being a synonym of the plain one."""
SENTENCES = 3
"""Usual number of sentences with a demo."""

PARTIAL = ".partial"
"""Suffix of a demo that is being recorded; it opens like any other when the recording was cut short."""

Job = TypeVar("Job")
Done = TypeVar("Done")


@dataclass(frozen=True, slots=True)
class Recorded:
    """One demo that was recorded.

    Attributes:
        path: The demo.
        sentence: What was said with it.
        kind: What kind of task it shows.
        simulated: Simulated time [s].
        wall: Wall-clock time it took, without starting the process [s].
    """

    path: Path
    sentence: str
    kind: str
    simulated: float
    wall: float

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds a second."""
        return self.simulated / self.wall


def demo_path(folder: Path, collection: str, seed: int, number: int) -> Path:
    """Where demo `number` of a collection lies."""
    return folder / f"{collection}_{seed}_{number:04d}.mcap"


@dataclass(frozen=True, slots=True)
class BoardCollection:
    """What a collection of board demos is made of; the same values give the same demos.

    Attributes:
        folder: Where the demos go; it must be there.
        seed: Seed of scenes, tasks, sentences and the operator's hand.
        robot: Robot to use instead of the board arm.
        variety: Probability of each word being a synonym of the plain one.
        sentences: How many people describe each demo, each in words of their own.
    """

    folder: Path
    seed: int
    robot: str | None = None
    variety: float = VARIETY
    sentences: int = SENTENCES


def record_board(collection: BoardCollection, number: int) -> Recorded:
    """Record demo `number` of a collection: a random task on a random board."""
    from time import perf_counter

    from executor.paraphrase import told
    from teleop import ScriptedOperator, random_task, record_demo, write_truth
    from twin import World, random_board

    begun = perf_counter()  # after the imports, which happen once in a process
    seed = collection.seed
    rng = np.random.default_rng([seed, number])
    asked = random_task(random_board(rng, seed=seed), rng, variety=collection.variety)
    utterances = told(asked.sentence, collection.sentences, np.random.default_rng([seed, number, 2]))
    path = demo_path(collection.folder, "board", seed, number)
    partial_path = path.with_suffix(PARTIAL)
    with World.from_scene(asked.scene, robot=collection.robot) as world:
        operator = ScriptedOperator(asked.task, rng)
        record_demo(world, operator, partial_path, utterances=utterances)
        simulated = world.time
    write_truth(path, asked.truth())
    os.replace(partial_path, path)
    return Recorded(path, asked.sentence, asked.kind, simulated, perf_counter() - begun)


def record_collection(
    collection: BoardCollection, count: int, *, jobs: int = 0, on_demo: Callable[[], None] = lambda: None
) -> list[Recorded]:
    """Record a board collection; returns the demos in order.

    Args:
        collection: What it is made of.
        count: How many demos.
        jobs: Processes; 0 takes one a core.
        on_demo: Called after every demo.

    Raises:
        InputError: A demo of that name is there already.
    """
    names = [demo_path(collection.folder, "board", collection.seed, number) for number in range(count)]
    there = [path for path in names if path.exists()]
    if there:
        raise InputError(f"{there[0]} is there already; choose another folder or another --seed")
    work = partial(record_board, collection)
    return [done for _, done in sorted(in_processes(work, range(count), jobs, on_demo), key=lambda pair: pair[0])]


def in_processes(
    work: Callable[[Job], Done], jobs: Sequence[Job], processes: int, on_done: Callable[[], None]
) -> Iterator[tuple[int, Done]]:
    """Do jobs in several processes; yields each job's index and outcome as it comes.

    Fresh processes are started (not forked): physics clients and threads do not survive a fork.

    Args:
        work: What to do; can be pickled.
        jobs: What to do it with.
        processes: How many; 0 takes one a core.
        on_done: Called after every job.
    """
    processes = min(worker_count(processes), len(jobs))
    if processes <= 1:
        for index, job in enumerate(jobs):
            yield index, work(job)
            on_done()
        return
    for library in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(
            library, "1"
        )  # inherited: a process a core is enough, each with threads would be too many
    with ProcessPoolExecutor(processes, get_context("spawn"), initializer=_start_worker) as pool:
        waiting = {pool.submit(work, job): index for index, job in enumerate(jobs)}
        try:
            for future in as_completed(waiting):
                yield waiting[future], future.result()
                on_done()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _start_worker() -> None:
    """Leave interrupts to the parent, end with it, and be quiet."""
    end_with_parent()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    load_physics()
