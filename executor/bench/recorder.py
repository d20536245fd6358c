"""The recorder: killed processes, full disks, replays, and what recording costs a control loop."""

import json
import mmap
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from executor.bench.recorder_child import PROGRESS, SCENES, Rig, paced
from executor.bench.report import BenchReport
from executor.collection import in_processes
from robots.pose import FloatArray
from robots.workers import worker_count
from teleop import (
    Demo,
    DemoError,
    Recorder,
    ScriptedOperator,
    check_replay,
    load_demo,
    random_task,
)
from teleop.demo_file import read_records
from teleop.demo_reader import demo_of
from teleop.record import record_demo
from twin import World, random_board

ROBOTS = tuple(SCENES)
KILL_WITHIN = (0.0, 4.0)
"""When a process is killed, after its first control step [s]."""
DISK_BYTES = 400_000
"""Size of the disk that is full soon."""
START_TIMEOUT = 120.0
"""How long a process may take to start [s]."""
LONGEST = 20.0
"""A scripted demo that takes longer is ended [s]."""
_CHILD = (sys.executable, "-m", "executor.bench.recorder_child")
_ROOT = Path(__file__).resolve().parent.parent.parent


def run(
    seed: int,
    kills: int = 50,
    demos: int = 100,
    seconds: float = 20.0,
    robots: Sequence[str] = ROBOTS,
    jobs: int = 0,
    on_done: Callable[[], None] = lambda: None,
) -> BenchReport:
    """Measure the recorder.

    Args:
        seed: Decides scenes, motions and moments.
        kills: Recording processes that are killed, over all robots.
        demos: Scripted demos that are recorded and replayed, over all robots.
        seconds: How long each control loop is timed, with and without recording [s].
        robots: Which robots.
        jobs: Processes; 0 takes one a core. Loops are timed one at a time.
        on_done: Called after each robot's timing, each kill and each demo.
    """
    figures: dict[str, float | None] = {}
    notes: list[str] = []
    with tempfile.TemporaryDirectory(prefix="showtell-recorder-") as name:
        folder = Path(name)
        if seconds > 0.0:
            for robot in robots:
                figures |= jitter(robot, seed, seconds, folder)
                on_done()
        figures |= killed(seed, kills, robots, folder, worker_count(jobs), on_done)
        found, told = full_disk(robots[0], seed, folder)
        figures |= found
        notes.append(told)
        figures |= replayed(seed, demos, robots, folder, jobs, on_done)
    settings = {
        "jitter": f"how late each step of a 240 Hz loop in real time begins; {seconds:g} s each, in turns of a second; "
        "pairs: with less without of turns side by side, median over the pairs, which other work hits alike",
        "killed": f"SIGKILL {KILL_WITHIN[0]:g} to {KILL_WITHIN[1]:g} s after the first step of a loop in real time",
        "full disk": f"{DISK_BYTES // 1000} kB",
        "replayed": "scripted demos, simulated afresh from their inputs in a process that did not record them",
    }
    return BenchReport(figures, settings=settings, notes=tuple(notes))


def killed(
    seed: int, kills: int, robots: Sequence[str], folder: Path, jobs: int, on_done: Callable[[], None] = lambda: None
) -> dict[str, float | None]:
    """Kill recording processes at random moments: what each file lost, and whether it opens."""
    if kills == 0:
        return {}
    rng = np.random.default_rng([seed, 1])
    delays = rng.uniform(*KILL_WITHIN, kills)

    def one(number: int) -> tuple[bool, float, float]:
        outcome = _kill_one(robots[number % len(robots)], seed + number, float(delays[number]), folder)
        on_done()
        return outcome

    with ThreadPoolExecutor(jobs) as pool:
        outcomes = list(pool.map(one, range(kills)))
    lost = [max(simulated, wall) for _, simulated, wall in outcomes]
    return {
        "kill.count": float(kills),
        "kill.opened": float(sum(opened for opened, *_ in outcomes)),
        "kill.lost_seconds_max": max(lost),
        "kill.lost_seconds_median": float(np.median(lost)),
    }


def full_disk(robot: str, seed: int, folder: Path) -> tuple[dict[str, float | None], str]:
    """Fill a disk while recording: what is kept, and whether control goes on. Also what was said."""
    disk, copy = folder / "disk", folder / "full.mcap"
    disk.mkdir()
    path = disk / "full.mcap"
    arguments = ["full", robot, str(seed), str(path), str(copy)]
    mount = f"mount -t tmpfs -o size={DISK_BYTES} none {disk} && exec " + '"$@"'
    how = "a file system of its own"
    done = _finished(["unshare", "-rm", "sh", "-c", mount, "sh", *_CHILD, *arguments, "0"])
    if done is None:
        how = "a limit on the file's size, as mounting is not allowed here"
        done = _finished([*_CHILD, *arguments, str(DISK_BYTES)])
    if done is None:
        return {"full_disk.kept_seconds": None}, "the disk could not be filled"
    demo = _quietly(copy)
    steps = int(done["failed_at"])
    figures: dict[str, float | None] = {
        "full_disk.lost_seconds": (steps - len(demo.inputs)) / demo.rate,
        "full_disk.kept_seconds": len(demo.inputs) / demo.rate,
        "full_disk.control_steps_after": float(done["steps"]) - steps,
        "full_disk.latest_step_after_ms": 1e3 * float(done["late"]),
        "full_disk.max_error": check_replay(demo).max_error,
    }
    return figures, f"full disk ({how}): " + str(done["message"]).replace(str(disk), "DISK")


def replayed(
    seed: int,
    demos: int,
    robots: Sequence[str],
    folder: Path,
    jobs: int = 0,
    on_done: Callable[[], None] = lambda: None,
) -> dict[str, float | None]:
    """Record scripted demos and replay each in another process: the largest error of each robot."""
    if demos == 0:
        return {}
    work = [(robots[number % len(robots)], seed + number) for number in range(demos)]
    record = partial(_record_one, folder)
    list(in_processes(record, work, jobs, lambda: None))
    # Backwards and in new processes: what a process did before must not matter.
    again = work[::-1]
    errors = dict(in_processes(partial(_replay_one, folder), again, jobs, on_done))
    figures: dict[str, float | None] = {}
    for robot in robots:
        mine = [error for index, error in errors.items() if again[index][0] == robot]
        if mine:
            figures[f"replay.{robot}.demos"] = float(len(mine))
            figures[f"replay.{robot}.max_error"] = max(error for error, _ in mine)
            figures[f"replay.{robot}.seconds"] = sum(duration for _, duration in mine)
    return figures


def jitter(robot: str, seed: int, seconds: float, folder: Path) -> dict[str, float | None]:
    """How late the steps of a loop in real time begin, with and without recording, in turns of a second.

    The turns go without, with, with, without, so that other work on the machine hits both alike, also while it grows.
    """
    turns: dict[bool, list[FloatArray]] = {False: [], True: []}
    rig = Rig.of(robot, seed, reaches=1000)
    recorder = rig.record_to(folder / f"jitter_{robot}.mcap")
    turn = round(1.0 / World.DT)
    try:
        for block in range(2 * round(max(seconds, 1.0))):
            recording = block % 4 in (1, 2)
            ends = rig.steps + turn
            late = paced(partial(_go, rig, recorder if recording else None, ends))[1:]
            turns[recording].append(1e6 * np.array(late))
    finally:
        recorder.close()
        rig.world.close()
    figures: dict[str, float | None] = {}
    for recording, name in ((False, "without"), (True, "with")):
        values = np.percentile(np.concatenate(turns[recording]), [50, 99, 100])
        for label, value in zip(("median", "p99", "max"), values, strict=True):
            figures[f"jitter.{robot}.{name}.{label}_us"] = float(value)
    each = {key: np.array([np.percentile(turn, [50, 99]) for turn in values]) for key, values in turns.items()}
    for label, value in zip(("median", "p99"), np.median(each[True] - each[False], axis=0), strict=True):
        figures[f"jitter.{robot}.pairs.{label}_us"] = float(value)
    return figures


def _go(rig: Rig, recorder: Recorder | None, ends: int) -> bool:
    rig.step(recorder)
    return rig.steps < ends


def _kill_one(robot: str, seed: int, delay: float, folder: Path) -> tuple[bool, float, float]:
    """Whether the file opens, and what it lost, in simulated and in wall-clock time [s]."""
    path, progress = folder / f"kill_{seed}.mcap", folder / f"kill_{seed}.progress"
    progress.write_bytes(bytes(PROGRESS.size))
    with (
        subprocess.Popen(
            [*_CHILD, "kill", robot, str(seed), str(path), str(progress)],
            cwd=_ROOT,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as child,
        progress.open("rb") as file,
        mmap.mmap(file.fileno(), PROGRESS.size, access=mmap.ACCESS_READ) as shared,
    ):
        give_up = time.monotonic() + START_TIMEOUT
        while not PROGRESS.unpack_from(shared)[0]:
            if child.poll() is not None or time.monotonic() > give_up:
                child.kill()
                raise DemoError(f"the process that records {robot} did not start")
            time.sleep(0.005)
        time.sleep(delay)
        child.send_signal(signal.SIGKILL)
        child.wait()
        steps, wall = PROGRESS.unpack_from(shared)
    try:
        demo = _quietly(path)
    except DemoError:
        return False, steps * World.DT, 0.0
    finally:
        path.unlink(missing_ok=True)
    there = len(demo.inputs)
    since = 0.0 if demo.wall_ns is None else (wall - int(demo.wall_ns[-1])) / 1e9
    return True, max(steps - there, 0) / demo.rate, max(since, 0.0)


def _finished(command: Sequence[str]) -> dict[str, float | str] | None:
    """What a child printed as JSON, or None if it could not do its work."""
    if shutil.which(command[0]) is None:
        return None
    done = subprocess.run(command, cwd=_ROOT, capture_output=True, text=True, timeout=2 * START_TIMEOUT, check=False)
    if done.returncode != 0:
        return None
    told: dict[str, float | str] = json.loads(done.stdout[done.stdout.index("{") :])
    return told


def _record_one(folder: Path, job: tuple[str, int]) -> None:
    """Record one scripted demo: the board arm's operator does a task, other robots are driven about."""
    robot, seed = job
    path = folder / f"{robot}_{seed}.mcap"
    if robot == "three_dof" and seed % 2 == 0:
        rng = np.random.default_rng([seed, 2])
        asked = random_task(random_board(rng, seed=seed), rng)
        with World.from_scene(asked.scene) as world:
            record_demo(world, ScriptedOperator(asked.task, rng), path, utterances=[asked.sentence])
        return
    rig = Rig.of(robot, seed)
    with rig.world, rig.record_to(path) as recorder:
        while not rig.driver.done and rig.world.time < LONGEST:
            rig.step(recorder)


def _replay_one(folder: Path, job: tuple[str, int]) -> tuple[float, float]:
    """Largest error and length [s] of a demo."""
    robot, seed = job
    report = check_replay(load_demo(folder / f"{robot}_{seed}.mcap"))
    return report.max_error, report.simulated


def _quietly(path: Path) -> Demo:
    """Read a demo, whole or not, without a warning."""
    return demo_of(path, read_records(path))
