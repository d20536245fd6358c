"""Knowledge of tables is for tables, knowledge of the board for the board; commands say so, or choose the scene."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from executor import Executor
from executor.cli import app
from executor.errors import InputError
from executor.knowledge_fit import usual_scene
from learning import Knowledge
from learning.concepts.space_set import BOARD, COUNTER, TABLE
from twin import World


@pytest.fixture(scope="module")
def of_tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("known") / "tables.json"
    Knowledge("table").save(path)
    return path


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(each) for each in arguments])


def test_the_usual_scene_is_what_the_knowledge_is_of() -> None:
    assert [usual_scene(Knowledge(each)) for each in (BOARD, TABLE, COUNTER)] == ["board", "tabletop", "tabletop"]


@pytest.mark.parametrize(("things", "scene"), [(1, "ordering"), (5, "tabletop")])
def test_what_stood_on_the_table_tells_the_counter_from_the_tabletop(things: int, scene: str) -> None:
    known = Knowledge(COUNTER)
    for _ in range(10):
        known.demos += 1
        for _ in range(things):
            known.table_language.resting.add(np.array([0.6, 0.1, 0.05]))
    assert usual_scene(known) == scene


@pytest.mark.parametrize(
    "asked",
    [
        ("do", "{}", "pick up the apple", "--scene", "board"),
        ("do", "{}", "--scene", "board"),
        ("inspect", "{}", "pick up the apple", "--scene", "board"),
        ("describe", "{}", "--scene", "board"),
        ("evaluate", "execution", "--knowledge", "{}", "--commands", "1"),
    ],
    ids=lambda asked: " ".join(asked),
)
def test_knowledge_of_tables_is_refused_on_the_board_in_one_line(of_tables: Path, asked: tuple[str, ...]) -> None:
    result = run(*(str(of_tables) if each == "{}" else each for each in asked))
    assert result.exit_code == 2
    (line,) = result.stderr.strip().splitlines()
    assert str(of_tables) in line and "learned on tables" in line and "--scene tabletop" in line


@pytest.mark.parametrize("scene", ["tabletop", "ordering"])
def test_knowledge_of_the_board_is_refused_at_tables_in_one_line(knowledge_file: str, scene: str) -> None:
    result = run("do", knowledge_file, "take the red cube", "--scene", scene)
    assert result.exit_code == 2
    (line,) = result.stderr.strip().splitlines()
    assert knowledge_file in line and "learned on the board" in line and "--scene board" in line


def test_the_scene_is_chosen_by_the_knowledge(of_tables: Path) -> None:
    result = run("do", of_tables, "pick up the apple", "--json")
    told = json.loads(result.stdout)
    assert told["scene"] == "tabletop" and told["answer"] == "unknown-word"


def test_an_executor_refuses_what_was_learned_elsewhere() -> None:
    with (
        World.from_scene("board", seed=1) as world,
        pytest.raises(InputError, match="this knowledge was learned on tables, but this scene is the board"),
    ):
        Executor(world, Knowledge("table"))
