import json
import warnings
from pathlib import Path

import numpy as np
import pytest

from teleop import Demo, DemoError, check_replay, load_demo
from teleop.trim import trim_demo


def test_a_piece_is_a_copy_that_starts_at_zero(small_demo: Demo, tmp_path: Path) -> None:
    original = small_demo.path.read_bytes()
    piece = trim_demo(small_demo.path, 1.2, 2.5, tmp_path / "piece.mcap")
    assert small_demo.path.read_bytes() == original
    assert piece.complete
    assert piece.times[0] == 0.0
    assert piece.duration == pytest.approx(1.3, abs=1 / 30)  # the ends move to recorded states
    assert piece.trim is not None
    first, last = piece.trim.first, piece.trim.last
    assert (piece.trim.origin, len(piece.inputs)) == (small_demo.path.name, last - first)
    np.testing.assert_array_equal(piece.inputs.axes, small_demo.inputs.axes[first:last])
    np.testing.assert_array_equal(piece.commands.executed, small_demo.commands.executed[first:last])
    rows = (small_demo.states.steps >= first) & (small_demo.states.steps <= last)
    np.testing.assert_array_equal(piece.states.steps, small_demo.states.steps[rows] - first)
    np.testing.assert_array_equal(piece.states.q, small_demo.states.q[rows])
    np.testing.assert_allclose(piece.times, small_demo.times[rows] - first / 240, atol=1e-12)  # one subtraction
    assert piece.utterances == small_demo.utterances
    assert piece.wall_ns is not None and small_demo.wall_ns is not None
    np.testing.assert_array_equal(piece.wall_ns, small_demo.wall_ns[first:last])


def test_a_piece_keeps_the_certificate_of_its_demo(small_demo: Demo, tmp_path: Path) -> None:
    piece = trim_demo(small_demo.path, 1.2, 2.5, tmp_path / "piece.mcap")
    report = check_replay(piece)
    # Compared times lose their last bit in a subtraction; all else is exact.
    assert report.max_error < 1e-12
    assert report.prelude == pytest.approx(1.2, abs=1 / 60)
    assert report.states == len(piece.times)


def test_a_piece_of_a_piece_is_still_a_piece_of_the_first(small_demo: Demo, tmp_path: Path) -> None:
    trim_demo(small_demo.path, 0.5, 2.5, tmp_path / "one.mcap")
    two = trim_demo(tmp_path / "one.mcap", 0.5, 1.5, tmp_path / "two.mcap")
    assert two.trim is not None
    assert two.trim.origin == small_demo.path.name
    assert two.trim.first == pytest.approx(240, abs=8)
    assert check_replay(two).max_error < 1e-12


def test_a_file_of_the_first_version_can_be_cut(tmp_path: Path) -> None:
    old = Path(__file__).parent / "data" / "version_1.mcap"
    piece = trim_demo(old, 0.1, 0.3, tmp_path / "piece.mcap")
    assert len(piece.inputs) == 48
    assert piece.wall_ns is None


def test_what_cannot_be_cut_is_said(small_demo: Demo, tmp_path: Path) -> None:
    new = tmp_path / "piece.mcap"
    with pytest.raises(DemoError, match=r"cannot keep 2 s to 1 s: the demo goes from 0 s to \d\.\d+ s"):
        trim_demo(small_demo.path, 2.0, 1.0, new)
    with pytest.raises(DemoError, match="cannot keep 1 s to 99 s"):
        trim_demo(small_demo.path, 1.0, 99.0, new)
    with pytest.raises(DemoError, match="holds no two recorded states"):
        trim_demo(small_demo.path, 1.0, 1.001, new)
    new.write_text("precious")
    with pytest.raises(DemoError, match=r"piece\.mcap: is there already; choose another name"):
        trim_demo(small_demo.path, 1.0, 2.0, new)
    assert new.read_text() == "precious"
    assert [path.name for path in tmp_path.iterdir()] == ["piece.mcap"]


def test_a_trimmed_demo_without_its_prelude_is_refused(small_demo: Demo, tmp_path: Path) -> None:
    from teleop.demo_file import read_records, write_records

    piece = trim_demo(small_demo.path, 1.2, 2.5, tmp_path / "piece.mcap")
    found = read_records(piece.path)
    kept = [each for each in found.records if not each.topic.startswith("/prelude")]
    write_records(tmp_path / "less.mcap", found.metadata or {}, kept)
    with pytest.raises(DemoError, match=r"steps into small\.mcap, whose inputs before that are not all here"):
        check_replay(load_demo(tmp_path / "less.mcap"))


def test_a_demo_cut_short_can_be_trimmed(demo_bytes: bytes, tmp_path: Path) -> None:
    (tmp_path / "half.mcap").write_bytes(demo_bytes[: len(demo_bytes) // 2])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        piece = trim_demo(tmp_path / "half.mcap", 0.2, 0.8, tmp_path / "piece.mcap")
    assert piece.complete
    assert json.loads(piece.metadata["trim"])["origin"] == "half.mcap"
