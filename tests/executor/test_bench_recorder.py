"""A small sample of `showtell bench recorder`."""

from pathlib import Path

import pytest

from executor.bench import recorder


def test_killed_processes_lose_less_than_a_second_and_their_files_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorder, "KILL_WITHIN", (0.0, 1.5))
    figures = recorder.killed(0, 2, ["three_dof"], tmp_path, jobs=2)
    assert figures["kill.opened"] == figures["kill.count"] == 2
    lost = figures["kill.lost_seconds_max"]
    assert lost is not None and lost < 1.0


def test_a_full_disk_stops_the_recording_and_not_the_control(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recorder, "DISK_BYTES", 120_000)
    figures, told = recorder.full_disk("three_dof", 0, tmp_path)
    assert "cannot be written on" in told
    assert figures["full_disk.control_steps_after"] == 240.0
    assert figures["full_disk.max_error"] == 0.0
    kept, lost = figures["full_disk.kept_seconds"], figures["full_disk.lost_seconds"]
    assert kept is not None and kept > 0.3
    assert lost is not None and lost < 1.1  # the last chunk, and how long the disk's answer took


@pytest.mark.parametrize("robot", ["mico_segway", "baxter"])
def test_demos_of_other_robots_are_reached_again_exactly(
    robot: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(recorder, "LONGEST", 1.0)
    figures = recorder.replayed(1, 1, [robot], tmp_path, jobs=1)
    assert figures[f"replay.{robot}.max_error"] == 0.0


def test_a_loop_is_timed_with_and_without_recording(tmp_path: Path) -> None:
    figures = recorder.jitter("three_dof", 0, 1.0, tmp_path)
    for turn in ("with", "without"):
        median, latest = (figures[f"jitter.three_dof.{turn}.{which}_us"] for which in ("median", "max"))
        assert median is not None and latest is not None
        assert 0.0 <= median <= latest
    for which in ("median", "p99"):
        assert figures[f"jitter.three_dof.pairs.{which}_us"] is not None
