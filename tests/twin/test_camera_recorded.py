"""Recorded states rendered in other processes: in order, the same, and stopped when nobody wants more."""

import multiprocessing
import os
import signal
import time
from collections.abc import Iterator

import numpy as np
import pytest

from twin import TwinError
from twin.camera import render_states
from twin.camera.recorded import LOOK_AHEAD, State

from .camera_scenes import AT_TABLE, CAMERA, table_poses, table_scene

SMALL = CAMERA.resized(80, 60)


def states(count: int) -> Iterator[State]:
    for number in range(count):
        yield table_poses(0.01 * number), AT_TABLE


@pytest.mark.parametrize("kind", ["auto", "tiny"])
def test_other_processes_give_the_same_frames_in_order(kind: str) -> None:
    count = 2 * LOOK_AHEAD + 7
    here = list(render_states(table_scene(), SMALL, states(count), processes=0, kind=kind))
    there = list(render_states(table_scene(), SMALL, states(count), processes=2, kind=kind))
    assert len(here) == len(there) == count
    for mine, theirs in zip(here, there, strict=True):
        for name in ("colour", "depth", "mask"):
            np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name))
    assert any((here[0].mask != frame.mask).any() for frame in here), "the frames differ, so that order shows"


def test_states_are_taken_as_needed_and_leaving_early_ends_the_processes() -> None:
    taken = []

    def endless() -> Iterator[State]:
        for number in range(10**9):
            taken.append(number)
            yield table_poses(0.001 * number), AT_TABLE

    frames = render_states(table_scene(), SMALL, endless(), processes=1)
    for _ in range(3):
        next(frames)
    assert len(taken) <= LOOK_AHEAD + 4
    assert multiprocessing.active_children()
    frames.close()  # type: ignore[attr-defined]
    assert not multiprocessing.active_children()


def test_an_error_in_a_process_is_raised_here() -> None:
    def broken() -> Iterator[State]:
        yield from states(2)
        yield table_poses()[:1], AT_TABLE

    frames = render_states(table_scene(), SMALL, broken(), processes=1)
    with pytest.raises(TwinError, match=r"poses must be \(3, 4, 4\)"):
        list(frames)
    assert not multiprocessing.active_children()


def test_a_killed_process_is_told() -> None:
    frames = render_states(table_scene(), SMALL, states(10_000), processes=1)
    next(frames)
    for child in multiprocessing.active_children():
        os.kill(child.pid or 0, signal.SIGKILL)
    began = time.monotonic()
    with pytest.raises(TwinError, match="rendering process ended early"):
        list(frames)
    assert time.monotonic() - began < 10


def test_no_states_give_no_frames_and_fewer_than_no_processes_are_refused() -> None:
    assert list(render_states(table_scene(), SMALL, iter(()), processes=1)) == []
    with pytest.raises(TwinError, match="at least 0, got -1"):
        render_states(table_scene(), SMALL, states(1), processes=-1)
