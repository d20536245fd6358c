from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from teleop import Demo, DemoError, check_replay, load_demo
from teleop.demo_events import Sentence
from teleop.repair import add_utterances, label_demo, repair_demo


def test_a_cut_file_becomes_whole_and_the_damaged_one_is_kept(demo_bytes: bytes, tmp_path: Path) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(demo_bytes[: len(demo_bytes) // 2])
    repair = repair_demo(path)
    assert repair.needed
    assert repair.kept == tmp_path / "cut.mcap.truncated"
    assert repair.kept.read_bytes() == demo_bytes[: len(demo_bytes) // 2]
    demo = load_demo(path)
    assert (demo.complete, demo.repaired, demo.duration) == (True, True, repair.seconds)
    assert check_replay(demo).max_error == 0.0
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count > 0
    assert not repair_demo(path).needed


def test_a_whole_file_is_left_alone(small_demo: Demo, demo_bytes: bytes) -> None:
    assert not repair_demo(small_demo.path).needed
    assert small_demo.path.read_bytes() == demo_bytes


def test_what_cannot_be_repaired_stays_as_it_was(demo_bytes: bytes, tmp_path: Path) -> None:
    path = tmp_path / "stub.mcap"
    path.write_bytes(demo_bytes[:600])
    with pytest.raises(DemoError, match=r"stub\.mcap: not a (usable )?demo"):
        repair_demo(path)
    assert path.read_bytes() == demo_bytes[:600]
    half = demo_bytes[: len(demo_bytes) // 2]
    path.write_bytes(half)
    kept = tmp_path / "stub.mcap.truncated"
    kept.write_text("older")
    with pytest.raises(DemoError, match=r"stub\.mcap\.truncated: is there already, so stub\.mcap was not repaired"):
        repair_demo(path)
    assert (path.read_bytes(), kept.read_text()) == (half, "older")


def test_sentences_and_outcome_can_be_added_afterwards(demo_bytes: bytes, small_demo: Demo, tmp_path: Path) -> None:
    path = tmp_path / "said.mcap"
    path.write_bytes(demo_bytes)
    add_utterances(path, ["put it there", "noch ein größerer Satz"])
    label_demo(path, "failure", "it leans")
    demo = load_demo(path)
    last = len(small_demo.inputs)
    assert demo.utterances == (*small_demo.utterances, "put it there", "noch ein größerer Satz")
    assert demo.sentences[-1] == Sentence("noch ein größerer Satz", last, "after")
    assert demo.outcome is not None and (demo.outcome.outcome, demo.outcome.note) == ("failure", "it leans")
    np.testing.assert_array_equal(demo.states.q, small_demo.states.q)
    assert check_replay(demo).max_error == 0.0
    assert [each.name for each in tmp_path.iterdir()] == ["said.mcap"]


def test_a_demo_that_ends_early_is_repaired_first(demo_bytes: bytes, tmp_path: Path) -> None:
    path = tmp_path / "cut.mcap"
    path.write_bytes(demo_bytes[: len(demo_bytes) // 2])
    with pytest.raises(DemoError, match=r"cut\.mcap: ends early; repair it first \(showtell demos .*--repair\)"):
        add_utterances(path, ["more"])
    with pytest.raises(DemoError, match="cannot be 'fine'"):
        label_demo(path, "fine")  # type: ignore[arg-type]


def test_a_file_of_the_first_version_is_read_and_can_be_added_to(tmp_path: Path) -> None:
    """`data/version_1.mcap` was written by the recorder as it was before it kept events, outcomes and wall clocks."""
    old = Path(__file__).parent / "data" / "version_1.mcap"
    demo = load_demo(old)
    assert demo.complete
    assert demo.utterances == ("take the red cube", "nimm den roten Würfel")
    assert (len(demo.inputs), demo.duration) == (96, 0.4)
    assert demo.states.q[-1].tolist() == [-4.46438263481683e-17, -1.1454816006031205, 1.895481262328745]
    assert demo.commands.executed[50, 0] == 0.09359127147201445
    assert (demo.outcome, demo.events, demo.wall_ns, demo.drive, demo.code) == (None, (), None, None, "")
    path = tmp_path / "new.mcap"
    path.write_bytes(old.read_bytes())
    label_demo(path, "success")
    assert load_demo(path).utterances == demo.utterances
    report = check_replay(path)
    assert report.states == len(demo.times)
    assert "recorded by a version of Showtell that did not keep its code version" in report.warnings
