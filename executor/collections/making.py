"""Making a collection: each demo is tried until it shows what it shall, over several processes; it can go on later."""

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Protocol

from executor.collection import PARTIAL, demo_path, in_processes
from executor.collections.attempt import Attempt
from robots.errors import ShowtellError
from teleop.demo_reader import is_whole
from teleop.truth import truth_path, write_truth

MOST_TRIES = 24
"""A demo is driven so often at most,"""
MOST_DRAWN = 200
"""and so many scenes are drawn for it at most."""


class ScriptedCollection(Protocol):
    """A collection whose demos are known by number; the same values give the same demos."""

    @property
    def name(self) -> str:
        """What it is called, in file names too."""

    @property
    def folder(self) -> Path:
        """Where the demos go."""

    @property
    def seed(self) -> int:
        """Seed of everything."""

    def attempt(self, number: int, attempt: int, path: Path) -> Attempt:
        """Try to record demo `number` at `path`; the same numbers give the same demo."""


@dataclass(frozen=True, slots=True)
class Made:
    """How making one demo went.

    Attributes:
        path: The demo.
        kind: The action it shows.
        failures: Why tries that were driven failed, in order; the one that was kept is not among them.
        drawn: Scenes that were drawn, with those in which the arm could not do it.
        done: Whether there is a demo.
        kept: Whether it was there from an earlier run.
        simulated: Simulated time of all tries [s].
        wall: Wall-clock time [s].
    """

    path: Path
    kind: str
    failures: tuple[str, ...] = ()
    drawn: int = 0
    done: bool = True
    kept: bool = False
    simulated: float = 0.0
    wall: float = 0.0


def make_demo(collection: ScriptedCollection, number: int) -> Made:
    """Try until demo `number` shows what it shall; a demo that is there already is kept."""
    begun = perf_counter()
    path = demo_path(collection.folder, collection.name, collection.seed, number)
    if is_whole(path) and truth_path(path).exists():
        return Made(path, "kept", kept=True)
    partial_path = path.with_suffix(PARTIAL)
    failures: list[str] = []
    simulated, kind = 0.0, ""
    for drawn in range(1, MOST_DRAWN + 1):
        if len(failures) == MOST_TRIES:
            break
        try:
            tried = collection.attempt(number, drawn, partial_path)
        except ShowtellError as error:  # such as a disk that is full: the others may still be made
            failures.append(str(error))
            continue
        kind, simulated = tried.kind, simulated + tried.simulated
        if tried.truth is not None:
            write_truth(path, {**tried.truth, "failed_tries": failures})
            os.replace(partial_path, path)
            return Made(path, kind, tuple(failures), drawn, simulated=simulated, wall=perf_counter() - begun)
        if tried.simulated > 0.0:
            failures.append(tried.reason)
    return Made(path, kind, tuple(failures), drawn, False, simulated=simulated, wall=perf_counter() - begun)


def make_collection(
    collection: ScriptedCollection, numbers: Sequence[int], *, jobs: int = 0, on_demo: Callable[[], None] = lambda: None
) -> list[Made]:
    """Make demos of a collection; those that are there are kept. Returns how each went, in order.

    Args:
        collection: What it is made of.
        numbers: Which demos.
        jobs: Processes; 0 takes one a core.
        on_demo: Called after every demo.
    """
    work = partial(make_demo, collection)
    return [made for _, made in sorted(in_processes(work, numbers, jobs, on_demo), key=lambda pair: pair[0])]
