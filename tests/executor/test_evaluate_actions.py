"""From demos to graphlets to motions: the whole way, and what the command says of wrong input."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from executor.actions.evaluation import ActionsReport
from executor.actions.learned import learn_actions, true_name
from executor.actions.trials import Tried, try_actions
from executor.cli import app
from executor.collection import BoardCollection, record_board
from tests.learning.board_demos import random_demo
from tests.learning.table_demos import ORDERING, table_demo


def test_the_board_s_actions_are_learned_and_done_again() -> None:
    rng = np.random.default_rng(2)
    kinds = ("take", "drop", "move")
    pairs = [(random_demo(rng, kind).observation, true_name({"task": kind}) or "") for _ in range(5) for kind in kinds]
    score, known = learn_actions(pairs, "three_dof", rng)
    assert score.v_measure == 1.0
    assert [each.name for each in known] == ["move", "pick up", "put down"]
    tried = try_actions(known, "three_dof", scenes=1, seed=4, jobs=1)
    assert [(each.action, each.fault) for each in tried] == [("move", ""), ("pick up", ""), ("put down", "")]
    report = ActionsReport({"three_dof": score}, known, tried, {}, 4)
    figures = report.figures()
    assert figures["v_measure"] == figures["replay_success"] == figures["put_down.success"] == 1.0
    assert figures["concepts"] == 3.0


def test_what_a_camera_saw_is_done_again_by_another_robot() -> None:
    """The seven actions of the counter, from tracks as perception gives them; one of them is tried by Baxter."""
    rng = np.random.default_rng(0)
    pairs = [(table_demo(rng, action)[0], action) for _ in range(3) for action in ORDERING]
    score, known = learn_actions(pairs, "mico_segway", rng)
    assert score.graphlets == len(ORDERING)
    lift = [each for each in known if each.name == "lift"]
    (tried,) = try_actions(lift, "baxter", scenes=1, seed=1, jobs=1)
    assert (tried.source, tried.robot, tried.fault) == ("mico_segway", "baxter", "")


def test_failures_are_counted_by_cause() -> None:
    trials = [
        Tried("move", "baxter", "three_dof", 0, "red cube", ""),
        Tried("move", "baxter", "three_dof", 1, "red cube", "out of reach: no posture brings the hand there"),
        Tried("move", "baxter", "three_dof", 2, "red cube", "out of reach: no way"),
        Tried("move", "three_dof", "baxter", 0, "red_apple", ""),
    ]
    report = ActionsReport({}, [], trials, {}, 0)
    assert report.causes() == [("baxter", "three_dof", "move", "out of reach", 2)]
    assert report.success(robot="three_dof") == pytest.approx(1 / 3)
    assert report.figures()["three_dof_to_baxter.move.success"] == 1.0


def test_recorded_demos_are_learned_from_by_the_command(tmp_path: Path) -> None:
    demos = tmp_path / "board"
    demos.mkdir()
    for number in range(2):
        record_board(BoardCollection(demos, seed=5), number)
    arguments = ["evaluate", "actions", str(demos), "--scenes", "0", "--jobs", "1", "--json"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["figures"]["v_measure"] == 1.0
    assert set(told["graphlets"]) == {"three_dof"}
    wrong = CliRunner().invoke(app, [*arguments, "--from", "baxter"])
    assert wrong.exit_code == 2
    assert "no demo was recorded with baxter; the demos are of three_dof" in wrong.output
    wrong = CliRunner().invoke(app, [*arguments, "--action", "juggle"])
    assert wrong.exit_code == 2
    assert "action 'juggle' has no rule of success; choose from pick up, put down" in wrong.output


def test_a_folder_without_demos_is_told(tmp_path: Path) -> None:
    result = CliRunner().invoke(app, ["evaluate", "actions", str(tmp_path)])
    assert result.exit_code == 2
    assert "holds no demo" in result.output
