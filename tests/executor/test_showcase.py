"""The whole loop in small: a few demos, one command. Whether a few demos are enough to learn from is not asked here."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from executor.cli import app
from executor.collection import demo_path, in_processes
from executor.trial import Trial, fault_of, new_task, run_trial
from learning import Knowledge
from teleop import load_demos
from twin import World, board


def test_the_demo_command_shows_learns_and_does(tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ["demo", "-o", str(out), "--demos", "3", "--commands", "1", "--jobs", "1", "--json"]
    result = CliRunner().invoke(app, words)
    assert result.exit_code in (0, 1)  # three demos are hardly enough
    said = json.loads(result.stdout)
    assert said["demos"] == 3 and said["commands"] == 1
    assert result.exit_code == (0 if said["right"] == 1 else 1)
    assert len(list(load_demos(out / "demos"))) == 3
    learned = Knowledge.load(out / "knowledge.json")
    assert learned.demos == 3
    assert learned.phrasings.by_script, "it was not learned how the language is spoken, so nothing can be described"
    assert (out / "command.png").stat().st_size > 1000
    assert not list(out.glob("*.partial"))


def test_trials_are_judged_by_the_truth(knowledge: Knowledge, knowledge_file: str) -> None:
    """Knowledge made by hand knows few words: of the plain sentences it does those, and is right about each."""
    verdicts = [run_trial(Trial(5, number, Path(knowledge_file), None, 0.0, None)) for number in range(16)]
    assert all(verdict.right for verdict in verdicts if verdict.report.success)
    assert all(verdict.fault for verdict in verdicts if not verdict.right)
    assert any(verdict.right for verdict in verdicts)


def test_a_state_that_is_not_what_was_asked_has_a_fault() -> None:
    asked = new_task(1, next(n for n in range(20) if new_task(1, n, 0.0).kind == "move"), 0.0)
    with World.from_scene(asked.scene) as world:
        nothing_done = fault_of(asked, world.state(), world.state())
    start = next(np.array(each.position) for each in asked.scene.objects if each.id == asked.object_id)
    off = 1000 * np.linalg.norm(np.asarray(asked.task.goal) - start)
    assert off > 1000 * board.CELL / 2
    assert int(nothing_done.split()[3]) == pytest.approx(off, abs=2)  # "the block is N mm ..."; blocks settle a little


def test_new_tasks_are_equal_for_equal_seeds_only() -> None:
    first, again, other = new_task(3, 1, 0.25), new_task(3, 1, 0.25), new_task(4, 1, 0.25)
    assert (first.sentence, first.scene) == (again.sentence, again.scene)
    assert first.scene != other.scene


@pytest.mark.parametrize("processes", [1, 2])
def test_jobs_come_back_with_their_index(processes: int) -> None:
    done: list[int] = []
    outcomes = dict(in_processes(abs, [-1, -2, -3], processes, lambda: done.append(1)))
    assert outcomes == {0: 1, 1: 2, 2: 3}
    assert len(done) == 3


def test_demo_names_tell_collection_seed_and_number(tmp_path: Path) -> None:
    assert demo_path(tmp_path, "board", 3, 12).name == "board_3_0012.mcap"
