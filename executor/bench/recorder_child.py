"""A process that records in real time until it is killed, or until its disk is full (see `executor.bench.recorder`)."""

import json
import mmap
import resource
import shutil
import struct
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.bench.scripted_drive import LOOK_EVERY, ScriptedDriver
from teleop import GamepadMapping, GamepadState, Recorder
from teleop.drive_command import DriveCommand
from teleop.drive_session import DriveSession
from teleop.record import STATE_EVERY
from twin import World

PROGRESS = struct.Struct("<qq")
"""What the parent can still read of a killed process: control steps done, and when the last was [ns]."""
SCENES = {"three_dof": "board", "baxter": "tabletop", "mico_segway": "ordering"}
"""The scene in which each robot is measured."""
GOES_ON = 1.0
"""How long control is watched after the disk was full [s]."""


@dataclass
class Rig:
    """A robot that is driven, and recorded if there is a recorder."""

    world: World
    session: DriveSession
    driver: ScriptedDriver
    command: DriveCommand
    steps: int = 0

    @classmethod
    def of(cls, robot: str, seed: int, reaches: int = 1) -> "Rig":
        """Set a robot into its scene."""
        world = World.from_scene(SCENES[robot], robot=robot, seed=seed)
        rng = np.random.default_rng([seed, 4])
        driver = ScriptedDriver(world.robot, world.spec, rng, reaches)
        return cls(world, DriveSession(world), driver, DriveCommand())

    def record_to(self, path: Path) -> Recorder:
        """Open a recorder; the file can be read from here on."""
        rate = round(1.0 / World.DT)
        return Recorder(path, self.world.spec, GamepadMapping(), rate, robot=self.world.robot)

    def step(self, recorder: Recorder | None) -> None:
        """One control step."""
        if self.steps % LOOK_EVERY == 0:
            state = self.world.state()
            self.command = self.driver.act(state)
            if recorder is not None and self.steps % STATE_EVERY == 0:
                recorder.state(self.steps, state)
        result = self.session.step(self.command)
        if recorder is not None:
            recorder.drive(self.steps, GamepadState(), self.command, result)
        self.steps += 1


def paced(step: Callable[[], bool]) -> list[float]:
    """Take steps in real time while they return True; returns how late each began [s]."""
    late = []
    due = time.perf_counter()
    going = True
    while going:
        if (wait := due - time.perf_counter()) > 0.0:
            time.sleep(wait)
        lateness = time.perf_counter() - due
        late.append(lateness)
        going = step()
        # A step that cannot be made good for is not: the next ones would all count as late.
        due = max(due + World.DT, time.perf_counter() - World.DT)
    return late


def until_killed(robot: str, seed: int, path: Path, progress: Path) -> None:
    """Record in real time for ever, and say how far it is in memory that outlives the process."""
    rig = Rig.of(robot, seed, reaches=1000)
    with progress.open("r+b") as file, mmap.mmap(file.fileno(), PROGRESS.size) as shared:
        recorder = rig.record_to(path)

        def step() -> bool:
            rig.step(recorder)
            PROGRESS.pack_into(shared, 0, rig.steps, time.time_ns())
            return True

        rig.step(recorder)
        recorder.sync()
        paced(step)


def until_full(robot: str, seed: int, path: Path, copy: Path, limit: int) -> None:
    """Record until the disk is full, drive on without it, and print what happened as JSON."""
    if limit:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    rig = Rig.of(robot, seed, reaches=1000)
    recorder = rig.record_to(path)
    failed_at = 0

    def step() -> bool:
        nonlocal failed_at
        rig.step(recorder)
        if recorder.failed and not failed_at:
            failed_at = rig.steps
        return not failed_at or rig.steps < failed_at + GOES_ON / World.DT

    late = paced(step)
    message = recorder.failed
    recorder.abandon()
    if limit:
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    shutil.copyfile(path, copy)
    after = late[failed_at:]
    json.dump({"message": message, "failed_at": failed_at, "steps": rig.steps, "late": max(after)}, sys.stdout)


if __name__ == "__main__":
    what, name, number, *rest = sys.argv[1:]
    if what == "kill":
        until_killed(name, int(number), Path(rest[0]), Path(rest[1]))
    else:
        until_full(name, int(number), Path(rest[0]), Path(rest[1]), int(rest[2]))
