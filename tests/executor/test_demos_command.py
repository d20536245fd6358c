"""`showtell demos` and `showtell replay`: trimming, repairing, describing, and what they print."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from executor.cli import app
from teleop import Demo, load_demo


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(each) for each in arguments])


def told(*arguments: str | Path, code: int = 0) -> dict[str, object]:
    result = run(*arguments, "--json")
    assert result.exit_code == code, result.output
    values = json.loads(result.stdout)
    assert isinstance(values, dict)
    return values


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    folder = tmp_path_factory.mktemp("recorded")
    assert run("record", "-o", folder, "--seed", "3", "--jobs", "1").exit_code == 0
    return next(folder.glob("*.mcap")).read_bytes()


@pytest.fixture
def folder(recorded: bytes, tmp_path: Path) -> Path:
    (tmp_path / "a.mcap").write_bytes(recorded)
    return tmp_path


def demo(folder: Path, name: str = "a.mcap") -> Demo:
    return load_demo(folder / name)


def test_a_list_says_what_each_demo_holds(folder: Path) -> None:
    (row,) = told("demos", folder, "--check")["demos"]  # type: ignore[misc]
    assert row["demo"] == "a.mcap"
    assert (row["complete"], row["replayable"], row["max_error"]) == (True, True, 0.0)
    assert (row["outcome"], row["safety_events"], row["problem"]) == ("success", 0, None)
    assert row["utterances"] and row["warnings"] == []


def test_a_piece_is_trimmed_and_replays(folder: Path) -> None:
    before = (folder / "a.mcap").read_bytes()
    piece = folder / "piece.mcap"
    said = told("demos", folder, "--trim", "a.mcap", "--from", "0.5", "--to", "1.5", "-o", piece)
    assert said["seconds"] == pytest.approx(1.0, abs=1 / 30)
    assert said["trimmed_from"] == "a.mcap"
    assert (folder / "a.mcap").read_bytes() == before
    result = run("replay", piece, "--check")
    assert result.exit_code == 0
    assert "cut from a.mcap: it starts in the middle of a motion, so the 0.50 s before it were played" in result.stdout
    assert "largest difference" in result.stdout
    assert told("replay", piece, "--check")["prelude_seconds"] == 0.5


def test_the_end_of_a_piece_may_be_left_out(folder: Path) -> None:
    told("demos", folder / "a.mcap", "-o", folder / "rest.mcap", "--from", "1")
    assert demo(folder, "rest.mcap").duration == pytest.approx(demo(folder).duration - 1.0, abs=1 / 30)


def test_trimming_names_what_it_lacks(folder: Path) -> None:
    for arguments, why in (
        (("--trim", "a.mcap"), "--trim makes a copy: name the new demo with --output"),
        (("-o", "x.mcap"), "--output is for a trimmed demo: say which of"),
        (("--trim", "b.mcap", "-o", folder / "x.mcap"), "b.mcap: no such demo"),
        (("--trim", "a.mcap", "-o", folder / "a.mcap"), "is there already; choose another name"),
        (("--trim", "a.mcap", "--from", "90", "-o", folder / "x.mcap"), "cannot keep 90 s to"),
    ):
        result = run("demos", folder, *arguments)
        assert result.exit_code == 2
        assert why in result.stderr
        assert len(result.stderr.strip().splitlines()) == 1


def test_a_truncated_demo_is_listed_and_repaired(folder: Path, recorded: bytes) -> None:
    (folder / "cut.mcap").write_bytes(recorded[: len(recorded) // 2])
    values = told("demos", folder, code=1)
    assert values["broken"] == 1
    values = told("demos", folder, "--repair", "--check")
    assert (values["broken"], values["repaired"]) == (0, ["cut.mcap"])
    assert demo(folder, "cut.mcap").repaired
    assert (folder / "cut.mcap.truncated").read_bytes() == recorded[: len(recorded) // 2]


def test_sentences_and_an_outcome_are_added_to_one_demo(folder: Path) -> None:
    path = folder / "a.mcap"
    assert run("demos", path, "--say", "one more", "--label", "failure", "--note", "it fell").exit_code == 0
    changed = demo(folder)
    assert changed.utterances[-1] == "one more"
    assert changed.outcome is not None
    assert (changed.outcome.outcome, changed.outcome.note) == ("failure", "it fell")
    result = run("demos", folder, "--say", "too much")
    assert result.exit_code == 2
    assert "--say and --label are for one demo" in result.stderr
