"""A person at a terminal drives, records and keeps a demo with keys alone, which replays exactly."""

import os
import pty
import subprocess
import sys
import time
from pathlib import Path

import pytest

from teleop import check_replay, load_demo

LIMIT = 60.0
"""A session ends long before this [s], also on a busy machine."""


def run_at_a_terminal(arguments: list[str], keys: list[tuple[float, bytes]]) -> tuple[int, str]:
    """Run `showtell` on a pseudo-terminal and press keys, each at its time [s] after the controls are shown."""
    master, slave = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-m", "executor.cli", *arguments],
        stdin=slave,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    os.close(slave)
    assert process.stdout is not None
    said = ""
    while "Ctrl-C ends" not in said and (line := process.stdout.readline()):
        said += line
    begun = time.monotonic()
    for moment, key in keys:
        time.sleep(max(0.0, begun + moment - time.monotonic()))
        os.write(master, key)
    said += process.communicate(timeout=LIMIT)[0]
    os.close(master)
    return process.returncode, said


def test_keys_record_a_demo_that_replays_exactly(tmp_path: Path) -> None:
    drive = [(1.5 + 0.05 * number, b"w") for number in range(20)]  # a held key repeats
    keys = [(0.8, b"\r"), *drive, (3.2, b"\r"), (4.0, b"y"), (4.6, b"\r")]
    arguments = ["record", "--device", "keyboard", "--scene", "board", "--seed", "3", "--seconds", "6"]
    code, said = run_at_a_terminal([*arguments, "--say", "go away", "-o", str(tmp_path)], keys)
    assert code == 0, said
    (path,) = tmp_path.glob("*.mcap")
    demo = load_demo(path)
    assert demo.utterances == ("go away",)
    start, end = demo.states.tool[0, :3], demo.states.tool[-1, :3]
    assert end[0] - start[0] > 0.02  # away from the robot
    assert check_replay(path).max_error == 0.0


def test_without_a_terminal_it_says_so(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "executor.cli", "record", "--device", "keyboard", "-o", str(tmp_path)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "the keyboard needs a terminal" in done.stderr


def test_a_gamepad_that_is_not_there_is_told_at_once(tmp_path: Path) -> None:
    arguments = ["record", "--device", "gamepad", "--pad", "no such gamepad", "--seconds", "0.2", "-o", str(tmp_path)]
    done = subprocess.run(
        [sys.executable, "-m", "executor.cli", *arguments], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0
    assert "plugged in" in done.stderr and "the robot waits for it" in done.stderr


def test_a_window_needs_a_display(monkeypatch: pytest.MonkeyPatch) -> None:
    from twin import SceneSpec, TwinError, World

    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(TwinError, match="a window needs a display, and DISPLAY is not set"):
        World(SceneSpec(), window=True)
