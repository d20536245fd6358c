"""`showtell devices`, with SDL's virtual joysticks."""

import contextlib
import json
import os
import pty
import select
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from executor.commands import devices
from executor.commands.output import ShowtellGroup
from teleop.devices import open_pads
from tests.teleop.virtual_pads import ARCADE_STICK, VirtualPad

REPOSITORY = Path(__file__).resolve().parent.parent.parent
APP = (
    # A test run in the background of a shell ignores Ctrl-C, and so would what it starts.
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    "import typer; from executor.commands import devices; from executor.commands.output import ShowtellGroup\n"
    "app = typer.Typer(cls=ShowtellGroup)\n@app.callback()\ndef root() -> None: ...\ndevices.add_to(app)\napp()"
)


@pytest.fixture
def app() -> typer.Typer:
    app = typer.Typer(cls=ShowtellGroup)
    app.callback()(lambda: None)
    devices.add_to(app)
    return app


@pytest.fixture
def plugged() -> Iterator[tuple[VirtualPad, VirtualPad]]:
    with open_pads() as pads:
        both = VirtualPad(), VirtualPad(ARCADE_STICK, 2, 3, 1)
        pads.refresh()
        yield both
        for pad in both:
            pad.unplug()
        pads.refresh()


def test_one_snapshot_as_json(app: typer.Typer, plugged: tuple[VirtualPad, VirtualPad]) -> None:
    plugged[0].axis(0, 1.0)
    plugged[0].button(0)
    plugged[1].button(2)
    result = CliRunner().invoke(app, ["devices", "--json", "--robot", "baxter"])
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    known, unknown = said["gamepads"]
    assert (known["name"], known["layout"], known["axes"][0]) == ("Virtual Controller", "known to SDL", 1.0)
    assert known["standard"]["axes"] == [1.0, 0.0, 0.0, 0.0]
    assert known["standard"]["buttons"] == [1.0] + [0.0] * 16
    assert (unknown["standard"], unknown["buttons"], unknown["hats"]) == (None, [0.0, 0.0, 1.0], [[0, 0]])
    assert '[pad."Virtual Arcade Stick"]' in unknown["layout"]
    assert {"action": "choose the left arm", "gamepad": "left bumper", "keys": "1"} in said["mapping"]


def test_one_snapshot_for_people(
    app: typer.Typer, plugged: tuple[VirtualPad, VirtualPad], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    plugged[0].axis(1, -1.0)
    result = CliRunner().invoke(app, ["devices"])
    assert result.exit_code == 0
    for text in ("Virtual Controller", "●········ -1.00", "left_y -1.00", "known to SDL", "Virtual Arcade Stick"):
        assert text in result.stdout


def test_no_gamepad_is_no_failure(app: typer.Typer) -> None:
    result = CliRunner().invoke(app, ["devices", "--seconds", "0"])
    assert result.exit_code == 0
    assert "no gamepad is plugged in" in result.stdout


def test_a_bad_mapping_file_is_told_in_one_line(app: typer.Typer, tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    file.write_text("[keyboard.keys]\nw = 'left_z'\n", encoding="utf-8")
    result = CliRunner().invoke(app, ["devices", "--mapping", str(file)])
    assert result.exit_code == 2
    assert "own.toml: keyboard.keys: key 'w': a gamepad has no 'left_z'" in result.stderr


def test_keys_are_shown_live_until_ctrl_c() -> None:
    person, program = pty.openpty()
    process = subprocess.Popen(
        [sys.executable, "-c", APP, "devices"],
        cwd=REPOSITORY,
        stdin=program,
        stdout=program,
        stderr=program,
        env=os.environ | {"TERM": "xterm", "COLUMNS": "120"},
        start_new_session=True,
    )
    os.close(program)
    try:
        shown = read_until(person, "at rest")
        assert "no gamepad is plugged in" in shown
        os.write(person, b"W")
        assert "shift w" in read_until(person, "left_y -0.40")
        process.send_signal(2)
        assert drained(person, process) == 0
    finally:
        process.kill()
        process.wait()
        os.close(person)


def drained(descriptor: int, process: "subprocess.Popen[bytes]") -> int | None:
    """Exit code of a program whose last words are read, so that a full terminal does not hold it up."""
    end = time.monotonic() + 30.0
    while process.poll() is None and time.monotonic() < end:
        if select.select([descriptor], [], [], 0.1)[0]:
            with contextlib.suppress(OSError):  # the other side is closed
                os.read(descriptor, 65536)
    return process.poll()


def read_until(descriptor: int, text: str) -> str:
    """What a terminal shows until a text comes."""
    shown, end = "", time.monotonic() + 20.0
    while text not in shown and time.monotonic() < end:
        if select.select([descriptor], [], [], 0.1)[0]:
            shown += os.read(descriptor, 65536).decode("utf-8", errors="replace")
    assert text in shown, shown
    return shown
