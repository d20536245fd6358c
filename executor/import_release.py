"""A public release, driven on the twin: one demo for each scene in which exactly one block moves."""

import os
import signal
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from executor.errors import ExecutorError, InputError
from learning.train_robots import Release, Scene, ShownMove, extended, scene_spec
from robots.errors import ShowtellError
from robots.workers import end_with_parent
from twin.board import BLOCK, CELL, cell_centre
from twin.quiet import load_physics

if TYPE_CHECKING:
    from twin import WorldState

MOST_JOBS = 64
_PARTIAL = ".partial"


@dataclass(frozen=True, slots=True)
class SceneOutcome:
    """How driving one scene ended.

    Attributes:
        scene: Scene number of the release.
        right: Whether every block ended within half a cell of where the after-layout has it.
        reason: What was wrong; empty when right.
        simulated: Simulated time [s].
        wall: Time that it took [s]; 0 for a demo that was kept.
        kept: Whether the demo was there from an earlier run.
    """

    scene: int
    right: bool
    reason: str
    simulated: float
    wall: float
    kept: bool = False


@dataclass(frozen=True, slots=True)
class ImportReport:
    """How an import ended.

    Attributes:
        outcomes: One a scene, in rising order.
        wall: Time of the whole import [s].
        jobs: Processes used.
    """

    outcomes: tuple[SceneOutcome, ...]
    wall: float
    jobs: int

    @property
    def right(self) -> int:
        """Number of scenes that ended in the after-layout."""
        return sum(outcome.right for outcome in self.outcomes)

    @property
    def kept(self) -> int:
        """Number of demos kept from an earlier run."""
        return sum(outcome.kept for outcome in self.outcomes)

    @property
    def failures(self) -> tuple[SceneOutcome, ...]:
        """The scenes that ended otherwise, with the reason."""
        return tuple(outcome for outcome in self.outcomes if not outcome.right)

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds a second of one process, recording included; 0 when nothing was driven."""
        driven = [outcome for outcome in self.outcomes if not outcome.kept]
        wall = sum(outcome.wall for outcome in driven)
        return sum(outcome.simulated for outcome in driven) / wall if wall > 0.0 else 0.0


@dataclass(frozen=True, slots=True)
class _Job:
    """One scene to drive; crosses to another process."""

    scene: Scene
    move: ShownMove
    utterances: tuple[str, ...]
    command_ids: tuple[int, ...]
    path: Path
    seed: int


def import_release(
    release_dir: str | Path,
    out_dir: str | Path,
    jobs: int = 2,
    only: Iterable[int] | None = None,
    seed: int = 0,
    progress: bool = True,
    extend: bool = False,
) -> ImportReport:
    """Drive the one-block scenes of a release on the twin and record each as a demo with its commands as utterances.

    Demos are called `scene_0001.mcap` and so on, with a truth sidecar each. Whole demos of an earlier run are kept; a
    demo is written under another name and moved into place, so an interrupted import loses nothing and goes on later.

    Args:
        release_dir: Directory with `commands.txt` and `configuration.txt`.
        out_dir: Where the demos go; made if it is not there.
        jobs: Processes to use.
        only: Scene numbers to drive; None drives all one-block scenes.
        seed: Decides the operator's imprecision in every scene, whatever the order and `jobs`.
        progress: Whether to show a progress bar on stderr.
        extend: Whether to drive the extended release instead (thesis 6.2.1), changed as `seed` draws it.

    Raises:
        ReleaseError: A file of the release is missing or malformed.
        InputError: `jobs` or a scene number is wrong, or the directory holds demos of another release.
        ExecutorError: The directory cannot be written, or a worker process died.
    """
    started = time.perf_counter()
    if not 1 <= jobs <= MOST_JOBS:
        raise InputError(f"jobs is {jobs}, allowed 1..{MOST_JOBS}")
    release = load_release(release_dir, extend, seed)
    scenes = _chosen(release, only)
    folder = Path(out_dir)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for left_over in folder.glob(f"scene_*{_PARTIAL}"):
            left_over.unlink()
    except OSError as error:
        raise ExecutorError(f"{folder}: cannot be written: {error.strerror}") from error
    outcomes: dict[int, SceneOutcome] = {}
    todo = []
    commands: dict[int, list[Any]] = {}
    for command in release.commands:
        commands.setdefault(command.scene, []).append(command)
    for scene, move in scenes:
        path = demo_path(folder, scene.number)
        kept = _kept(scene, path)
        if kept is not None:
            outcomes[scene.number] = kept
            continue
        spoken = commands.get(scene.number, [])
        todo.append(
            _Job(scene, move, tuple(each.sentence for each in spoken), tuple(each.id for each in spoken), path, seed)
        )
    with _bar(progress, len(scenes), len(outcomes)) as advance:
        for outcome in _driven(todo, jobs):
            outcomes[outcome.scene] = outcome
            advance(outcome)
    ordered = tuple(outcomes[number] for number in sorted(outcomes))
    return ImportReport(ordered, time.perf_counter() - started, jobs)


def load_release(directory: str | Path, extend: bool, seed: int) -> Release:
    """Read a release as an import drives it.

    Args:
        directory: Directory with `commands.txt` and `configuration.txt`.
        extend: Whether the extended release is meant (thesis 6.2.1).
        seed: Draws what is changed in that.

    Raises:
        ReleaseError: A file is missing or malformed.
    """
    release = Release.load(directory)
    return extended(release, np.random.default_rng(seed)) if extend else release


def demo_path(folder: str | Path, scene: int) -> Path:
    """Where the demo of a scene lies in an import's folder."""
    return Path(folder) / f"scene_{scene:04d}.mcap"


def _chosen(release: Release, only: Iterable[int] | None) -> list[tuple[Scene, ShownMove]]:
    """The scenes to drive and what moves in them, in rising order.

    Raises:
        InputError: One of them is not there or does not move exactly one block.
    """
    if only is None:
        return [(scene, scene.move) for scene in release.one_block_scenes() if scene.move is not None]
    chosen = []
    for number in sorted(set(only)):
        scene = release.scenes.get(number)
        if scene is None:
            raise InputError(f"{release.directory}: has no scene {number}; it has {len(release.scenes)} scenes")
        if scene.move is None:
            raise InputError(
                f"{release.directory}: scene {number} does not move exactly one block, so there is no demo to drive"
            )
        chosen.append((scene, scene.move))
    return chosen


def _driven(todo: list[_Job], jobs: int) -> Iterator[SceneOutcome]:
    """Drive scenes in processes of their own, and give the outcomes as they come.

    On an interrupt the scenes that are being driven are finished and the others given up.
    """
    if not todo:
        return
    if jobs == 1:
        for job in todo:
            yield _drive(job)
        return
    # Spawned, not forked: the progress bar has a thread, and physics must not be shared.
    pool = ProcessPoolExecutor(min(jobs, len(todo)), get_context("spawn"), initializer=_start_worker)
    try:
        waiting = {pool.submit(_drive, job) for job in todo}
        while waiting:
            finished, waiting = wait(waiting, return_when=FIRST_COMPLETED)
            for future in finished:
                yield future.result()
    except BrokenProcessPool as error:
        raise ExecutorError("a worker process died; run the import again, it goes on where it stopped") from error
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def _start_worker() -> None:
    """Leave interrupts to the parent, end with it, and be quiet."""
    end_with_parent()
    load_physics()
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _drive(job: _Job) -> SceneOutcome:
    """Drive one scene; moves the demo into place whether it ended rightly or not."""
    from teleop import ScriptedOperator, Task, record_demo, write_truth
    from twin import World

    scene, move = job.scene, job.move
    started = time.perf_counter()
    partial = job.path.with_suffix(_PARTIAL)
    task = Task(None if move.held_at_start else move.object_id, cell_centre(*move.goal), release=not move.held_at_end)
    operator = ScriptedOperator(task, np.random.default_rng([job.seed, scene.number]))
    try:
        with World.from_scene(scene_spec(scene)) as world:
            demo = record_demo(world, operator, partial, utterances=job.utterances)
            reason = _wrong(scene, move, world.state())
        if reason and operator.note:
            reason = f"{reason} (operator: {operator.note})"
        outcome = SceneOutcome(scene.number, not reason, reason, demo.duration, time.perf_counter() - started)
        write_truth(job.path, _truth(job, outcome))
        os.replace(partial, job.path)
    except ShowtellError as error:
        return SceneOutcome(scene.number, False, str(error), 0.0, time.perf_counter() - started)
    except OSError as error:
        raise ExecutorError(f"{job.path}: cannot be written: {error.strerror}") from error
    return outcome


def _wrong(scene: Scene, move: ShownMove, state: "WorldState") -> str:
    """Say what differs from the after-layout; empty if every block is within half a cell of its place."""
    ends = {each.id: each.pose_object_in_world.position for each in state.objects}
    faults = []
    for index, block in enumerate(scene.before.blocks):
        goal = cell_centre(*(move.goal if index == move.object_id else block.cell))
        off = ends[index] - goal
        if np.abs(off[:2]).max() > CELL / 2 or abs(off[2]) > BLOCK / 2:
            who = "the moved block" if index == move.object_id else f"the {block.colour} {block.shape} at {block.cell}"
            faults.append(f"{who} is off by {', '.join(f'{1000 * value:.0f}' for value in off)} mm")
    if move.held_at_end and state.held != move.object_id:
        faults.append("the moved block is not in the gripper")
    if not move.held_at_end and state.held is not None:
        faults.append("a block is still in the gripper")
    return "; ".join(faults)


def _truth(job: _Job, outcome: SceneOutcome) -> dict[str, Any]:
    """What is true of a driven scene, for scoring."""
    move = job.move
    return {
        "scene": job.scene.number,
        "task": move.kind,
        "moved": {
            "id": move.object_id,
            "colour": job.scene.before.blocks[move.object_id].colour,
            "shape": job.scene.before.blocks[move.object_id].shape,
        },
        "start": list(move.start),
        "goal": list(move.goal),
        "commands": list(job.command_ids),
        "objects": _looks(job.scene),
        "seed": job.seed,
        "right": outcome.right,
        "reason": outcome.reason,
        "simulated": outcome.simulated,
    }


def _looks(scene: Scene) -> dict[str, dict[str, str]]:
    """Colour and shape of each block, by its number."""
    return {
        str(index): {"colour": block.colour, "shape": block.shape} for index, block in enumerate(scene.before.blocks)
    }


def _kept(scene: Scene, path: Path) -> SceneOutcome | None:
    """The outcome of a demo that is already there and whole, or None.

    Raises:
        InputError: It shows blocks that look otherwise: it is of the other release, the public or the extended one.
    """
    from teleop import DemoError, is_whole, read_truth

    if not is_whole(path):
        return None
    try:
        truth = read_truth(path)
        outcome = SceneOutcome(
            scene.number, bool(truth["right"]), str(truth["reason"]), float(truth["simulated"]), 0.0, True
        )
        shown = truth["objects"]
    except (DemoError, KeyError, TypeError, ValueError):
        return None
    if shown != _looks(scene):
        raise InputError(
            f"{path}: shows other blocks than scene {scene.number} has; the public release, the extended one and each "
            "of its seeds need a folder of their own"
        )
    return outcome


@contextmanager
def _bar(shown: bool, total: int, done: int) -> Iterator[Any]:
    """A progress bar on stderr; gives a function that takes each outcome."""
    if not shown:
        yield lambda outcome: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[wrong]} wrong"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True)) as progress:
        bar = progress.add_task("driving scenes", total=total, completed=done, wrong=0)
        wrong = 0

        def advance(outcome: SceneOutcome) -> None:
            nonlocal wrong
            wrong += not outcome.right
            progress.update(bar, advance=1, wrong=wrong)

        yield advance
