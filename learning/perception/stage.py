"""The perception stage: many demos, in parallel, with what was perceived kept on disk.

Each demo is perceived once for its content, seed and settings: a pass that was interrupted goes on where it was, and a
second one finds everything there. One machine works through joblib's own processes. Several do through Dask: start
`dask scheduler` on one machine and `dask worker ADDRESS --nthreads 1` on each, with this package installed and demos
and cache on a disk that all share, and give the scheduler's address as `cluster` (`showtell perceive --cluster`).
"""

import hashlib
import os
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from learning.errors import PerceptionError
from learning.perception.camera_observation import Perceived
from learning.perception.observation_file import load_observation, save_observation
from learning.perception.observe_camera import USUAL, Eyesight
from robots.workers import end_with_parent, worker_count

PERCEPTION_VERSION = 3
"""Raised when perception would give other observations for the same demo."""
ROUND = 4
"""Demos for each worker of a cluster that are asked for at a time: between rounds progress is told."""


@dataclass(frozen=True, slots=True)
class PerceivedDemo:
    """What came of one demo.

    Attributes:
        demo: The recording.
        file: Its observation, for `load_observation`; None where it could not be perceived.
        frames: Frames perceived now; 0 where the observation was there already.
        seconds: Time of one processor that it took, rendering included [s].
        notes: What happened that the tracks do not say.
        error: Why it could not be perceived; empty where it could.
    """

    demo: Path
    file: Path | None
    frames: int = 0
    seconds: float = 0.0
    notes: tuple[str, ...] = ()
    error: str = ""

    @property
    def cached(self) -> bool:
        """Whether the observation was there already."""
        return self.file is not None and self.frames == 0

    def observation(self) -> Perceived:
        """Read the observation.

        Raises:
            PerceptionError: The demo could not be perceived, or the file is damaged.
        """
        if self.file is None:
            raise PerceptionError(f"{self.demo}: {self.error}")
        return load_observation(self.file)


def perceive_demos(
    demos: Sequence[str | Path],
    cache: str | Path,
    *,
    seed: int = 0,
    eyesight: Eyesight = USUAL,
    jobs: int = 0,
    cluster: str | None = None,
    on_done: Callable[[PerceivedDemo], None] = lambda done: None,
) -> list[PerceivedDemo]:
    """Perceive demos, board and table alike; what cannot be perceived is passed over and says why.

    Args:
        demos: Files of demos.
        cache: Folder of observations; made where it is missing.
        seed: Seed of all noise. A demo's noise depends on it and on the demo, not on the others.
        eyesight: Camera and size of pictures, for demos at a table.
        jobs: Processes; 0 takes one a core, 1 works in this one.
        cluster: Address of a Dask scheduler that does the work instead.
        on_done: Called for every demo as it is done.

    Returns:
        One outcome for each demo, in their order.

    Raises:
        PerceptionError: The cluster cannot be reached.
    """
    tasks = [(number, str(Path(demo)), str(cache), seed, eyesight) for number, demo in enumerate(demos)]
    done: dict[int, PerceivedDemo] = {}
    for number, demo, *_ in tasks:  # here, not in processes, which take seconds to load what perception needs
        if (kept := _kept(Path(demo), Path(cache), seed, eyesight)) is not None:
            done[number] = kept
            on_done(kept)
    left = [task for task in tasks if task[0] not in done]
    for number, outcome in _in_parallel(left, worker_count(jobs), cluster):
        done[number] = outcome
        on_done(outcome)
    return [done[number] for number in range(len(tasks))]


def perceive_one(demo: Path, cache: Path, seed: int, eyesight: Eyesight = USUAL) -> PerceivedDemo:
    """Perceive one demo, unless its observation is in the cache already.

    Nothing that is wrong with a demo is raised: it is told in the outcome, so that a pass goes on.
    """
    if (kept := _kept(demo, cache, seed, eyesight)) is not None:
        return kept
    begun = time.process_time()
    try:
        file = observation_path(demo, cache, seed, eyesight)
        perceived = _perceived(demo, seed, eyesight)
        save_observation(file, perceived)
    except Exception as error:  # one demo, whatever is wrong with it, must not end the pass
        reason = " ".join(str(error).split()) or type(error).__name__
        return PerceivedDemo(demo, None, seconds=time.process_time() - begun, error=reason)
    frames = len(perceived.observation.times)
    return PerceivedDemo(demo, file, frames, time.process_time() - begun, perceived.notes)


def _kept(demo: Path, cache: Path, seed: int, eyesight: Eyesight) -> PerceivedDemo | None:
    """What is in the cache of a demo; None where it must be perceived, also because the file is damaged."""
    try:
        file = observation_path(demo, cache, seed, eyesight)
        return PerceivedDemo(demo, file, notes=load_observation(file).notes) if file.exists() else None
    except (OSError, PerceptionError):  # whatever is wrong with the demo is told when it is perceived
        return None


def observation_path(demo: Path, cache: Path, seed: int, eyesight: Eyesight = USUAL) -> Path:
    """Where the observation of a demo is kept: named after the demo, its content, the seed and the settings.

    Raises:
        OSError: The demo cannot be read.
    """
    with demo.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256")
    digest.update(repr((PERCEPTION_VERSION, seed, sorted(asdict(eyesight).items()))).encode())
    return cache / f"{demo.stem}_{digest.hexdigest()[:16]}.npz"


def _perceived(demo: Path, seed: int, eyesight: Eyesight) -> Perceived:
    """Load and perceive a demo."""
    from learning.perception.observe import perceive_any
    from teleop import load_demo

    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        recorded = load_demo(demo)
    with demo.open("rb") as file:
        content = int.from_bytes(hashlib.file_digest(file, "sha256").digest()[:8], "little")
    perceived = perceive_any(recorded, np.random.default_rng([seed, content]), eyesight)
    early = () if recorded.complete else tuple(str(each.message) for each in told)
    return Perceived(perceived.observation, early + perceived.notes)


_Task = tuple[int, str, str, int, Eyesight]


def _work(task: _Task) -> tuple[int, PerceivedDemo]:
    """What a process does with one demo."""
    from threadpoolctl import threadpool_limits

    end_with_parent()
    number, demo, cache, seed, eyesight = task
    # The processes fill the processors already; Mesa reads this when a context is made.
    os.environ["LP_NUM_THREADS"] = "1"
    with threadpool_limits(1):
        return number, perceive_one(Path(demo), Path(cache), seed, eyesight)


def _in_parallel(tasks: Sequence[_Task], jobs: int, cluster: str | None) -> Iterator[tuple[int, PerceivedDemo]]:
    """Do all tasks; yields each outcome as it comes."""
    if cluster is None and (jobs == 1 or len(tasks) <= 1):
        before = os.environ.get("LP_NUM_THREADS")
        try:
            yield from map(_work, tasks)
        finally:
            if before is None:
                os.environ.pop("LP_NUM_THREADS", None)
            else:
                os.environ["LP_NUM_THREADS"] = before
        return
    from joblib import Parallel, delayed, parallel_config

    calls = [delayed(_work)(task) for task in tasks]
    if cluster is None:
        with parallel_config(backend="loky", inner_max_num_threads=1):
            yield from Parallel(n_jobs=min(jobs, len(tasks)), return_as="generator_unordered")(calls)
        return
    with ExitStack() as stack:
        client = stack.enter_context(_client(cluster))
        stack.enter_context(parallel_config(backend="dask"))
        workers = max(len(client.scheduler_info()["workers"]), 1)
        for first in range(0, len(calls), ROUND * workers):
            # joblib's Dask backend gives results of a call all at once
            yield from Parallel()(calls[first : first + ROUND * workers])


def _client(address: str) -> Any:
    """A client of a Dask scheduler.

    Raises:
        PerceptionError: Dask is not installed, or there is no scheduler.
    """
    try:
        import distributed
    except ImportError as error:
        raise PerceptionError("a cluster needs Dask: pip install 'showtell[cluster]'") from error
    try:
        make: Any = distributed.Client  # it has annotations, though not all
        return make(address, timeout=10)
    except (OSError, ValueError) as error:
        raise PerceptionError(f"no Dask scheduler answers at {address!r}; start one with `dask scheduler`") from error
