import os
from collections.abc import Iterator
from pathlib import Path
from threading import Event

import numpy as np
import pytest

from teleop import GamepadMapping, GamepadState, Recorder, TeleopError, check_replay, disk_writer, load_demo
from teleop.recording import Recording
from teleop.session import Session
from tests.teleop.test_disk_writer import files_at_most
from twin import SceneSpec, World


class Table:
    """What a control loop does: a session that is made anew when a recording starts."""

    def __init__(self, scene: SceneSpec) -> None:
        self.scene = scene
        self.world = World.from_scene(scene)
        self.session = Session(self.world)
        self.step = 0

    def begin(self, path: Path) -> Recorder:
        self.world.close()
        self.world = World.from_scene(self.scene)
        self.session, self.step = Session(self.world), 0
        return Recorder(path, self.scene, GamepadMapping(), 240, robot=self.world.robot, exclusive=True)

    def drive(self, recording: Recording, steps: int) -> None:
        gamepad = GamepadState.from_controls(left_y=-0.5)
        for _ in range(steps):
            recorder = recording.recorder
            if recorder and self.step % 8 == 0:
                recorder.state(self.step, self.world.state())
            result = self.session.step(gamepad)
            if recorder:
                recorder.control(self.step, gamepad, result, self.session.opening)
            self.step += 1


@pytest.fixture
def table(small_scene: SceneSpec) -> Iterator[Table]:
    table = Table(small_scene)
    yield table
    table.world.close()


def test_a_demo_is_recorded_described_and_kept(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path / "new", table.begin)
    table.drive(recording, 10)  # before: this is not in the demo
    recording.say("watch this")
    path = recording.start()
    table.drive(recording, 100)
    recording.say(" look:  ")
    table.drive(recording, 20)
    assert recording.stop() == path
    recording.say("pushed")
    assert recording.keep("success") == path
    demo = load_demo(path)
    assert (recording.state, path.name) == ("idle", "demo_0001.mcap")
    assert [(each.text, each.when) for each in demo.sentences] == [
        ("watch this", "before"),
        ("look:", "during"),
        ("pushed", "after"),
    ]
    assert demo.outcome is not None and demo.outcome.outcome == "success"
    assert len(demo.inputs) == 120
    assert check_replay(demo).max_error == 0.0


def test_names_are_numbered_and_nothing_is_overwritten(table: Table, tmp_path: Path) -> None:
    (tmp_path / "demo_0007.mcap").write_text("precious")
    (tmp_path / "demo_notes.txt").write_text("")
    recording = Recording(tmp_path, table.begin)
    for number in (8, 9):
        recording.start()
        table.drive(recording, 9)
        assert recording.keep().name == f"demo_{number:04d}.mcap"
    assert (tmp_path / "demo_0007.mcap").read_text() == "precious"


def test_a_demo_is_discarded_and_had_back(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path, table.begin)
    with pytest.raises(TeleopError, match="nothing was discarded in"):
        recording.restore()
    recording.start()
    table.drive(recording, 9)
    recording.discard()
    assert list(tmp_path.glob("*.mcap")) == []
    assert len(load_demo(recording.restore()).inputs) == 9


def test_redo_starts_again_from_the_scene(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path, table.begin)
    recording.say("push")
    recording.start()
    table.drive(recording, 60)
    recording.redo()
    assert table.world.time == 0.0
    table.drive(recording, 30)
    demo = load_demo(recording.keep("failure", "too short"))
    assert (len(demo.inputs), demo.utterances) == (30, ("push",))
    assert check_replay(demo).max_error == 0.0
    assert [path.name for path in tmp_path.glob("*.mcap")] == ["demo_0001.mcap"]


def test_two_marks_make_a_trimmed_copy(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path, table.begin)
    recording.start()
    table.drive(recording, 60)
    assert recording.mark() == pytest.approx(59 / 240)  # the last step's start
    table.drive(recording, 60)
    recording.mark()
    table.drive(recording, 60)
    path = recording.keep()
    assert load_demo(path).duration == pytest.approx(0.73, abs=0.01)
    piece = load_demo(tmp_path / "demo_0001_trimmed.mcap")
    assert piece.duration == pytest.approx(0.25, abs=1 / 30)
    assert recording.start().name == "demo_0002.mcap"
    recording.close()


def test_each_button_says_when_it_makes_no_sense(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path, table.begin)
    for name in ("stop", "keep", "discard", "mark", "redo"):
        with pytest.raises(TeleopError, match="a recording now: nothing is recorded"):
            getattr(recording, name)()
    recording.start()
    with pytest.raises(TeleopError, match="cannot start a recording now: a recording is on: stop it first"):
        recording.start()
    with pytest.raises(TeleopError, match="there is nothing to add"):
        recording.say("  ")
    table.drive(recording, 9)
    recording.stop()
    with pytest.raises(TeleopError, match="cannot start a recording now: a demo waits to be kept or discarded"):
        recording.start()
    recording.close()
    assert load_demo(tmp_path / "demo_0001.mcap").complete


def test_nothing_that_is_said_after_the_end_waits_for_the_disk(
    table: Table, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The control loop calls all of this: while the disk hangs, every call returns, and the next demo can begin."""
    real, answers = os.write, Event()

    def hangs(file: int, data: bytes) -> int:
        answers.wait()
        return real(file, data)

    recording = Recording(tmp_path, table.begin)
    path = recording.start()
    table.drive(recording, 50)
    monkeypatch.setattr(disk_writer.os, "write", hangs)
    recording.stop()
    recording.say("pushed")
    recording.label("failure")
    recording.label("success", "after all")
    recording.keep(wait=False)
    table.drive(recording, 50)
    assert (recording.state, recording.poll()) == ("idle", "")
    answers.set()
    recording.settle()
    assert recording.poll() == ""
    demo = load_demo(path)
    assert demo.complete
    assert [(each.text, each.when, each.step) for each in demo.sentences] == [("pushed", "after", 49)]
    assert demo.outcome is not None
    assert (demo.outcome.outcome, demo.outcome.note) == ("success", "after all")
    assert [(each.kind, each.text) for each in demo.events] == [("record", "ended")]


def test_a_disk_that_fills_up_after_the_end_is_told(table: Table, tmp_path: Path) -> None:
    for kept in (False, True):
        recording = Recording(tmp_path, table.begin)
        path = recording.start()
        table.drive(recording, 20)
        recorder = recording.recorder
        assert recorder is not None
        recording.stop()
        recorder.sync()
        with files_at_most(path.stat().st_size):
            recording.say("x" * 400)
            if kept:
                recording.keep(wait=False)
            told = ""
            while not told:
                told = recording.poll()
        assert f"{path.name}: cannot be written on: File too large" in told
        assert recording.state == "idle"
        with pytest.warns(UserWarning, match="ends early"):
            assert len(load_demo(path).inputs) == 20


def test_a_full_disk_ends_the_recording_and_not_the_control(table: Table, tmp_path: Path) -> None:
    recording = Recording(tmp_path, table.begin)
    with files_at_most(60_000):
        path = recording.start()
        told, steps = "", 0
        while not told and steps < 2400:
            table.drive(recording, 8)
            if recording.recorder is not None:
                recording.recorder.sync()  # faster than real time
            told, steps = recording.poll(), steps + 8
        before = table.world.joint_positions.copy()
        table.drive(recording, 24)
    assert "demo_0001.mcap: cannot be written on: File too large; what was recorded until about" in told
    assert recording.state == "idle"
    assert np.abs(table.world.joint_positions - before).max() > 0.0
    with pytest.warns(UserWarning, match="ends early"):
        demo = load_demo(path)
    assert len(demo.inputs) >= steps - 240
    kept = float(told.split("until about ")[1].split(" s")[0])
    assert kept == pytest.approx(len(demo.inputs) / 240, abs=0.051)  # told to a tenth
    assert check_replay(demo).max_error == 0.0
