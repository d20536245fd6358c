"""The command line: what it prints, where, and with which exit code."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from executor.cli import app
from learning.train_robots import write_synthetic_release

COMMANDS = ("demo", "record", "import", "replay", "demos", "learn", "inspect", "do", "evaluate", "robots")


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, [str(each) for each in arguments])


def complains(result: Result, *needles: str) -> None:
    """Bad input: exit code 2, nothing but one line on stderr."""
    assert result.exit_code == 2
    lines = result.stderr.strip().splitlines()
    assert len(lines) == 1 and lines[0].startswith("showtell: error: ")
    for needle in needles:
        assert needle in lines[0]


@pytest.fixture(scope="module")
def demos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("demos")
    result = run("record", "--count", "2", "-o", folder, "--seed", "3", "--jobs", "1", "--json")
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert [Path(each).exists() for each in said["demos"]] == [True, True]
    assert said["real_time_factor"] > 0
    return folder


@pytest.fixture(scope="module")
def truncated(demos: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    whole = sorted(demos.glob("*.mcap"))[0].read_bytes()
    path = tmp_path_factory.mktemp("truncated") / "cut.mcap"
    path.write_bytes(whole[: len(whole) // 2])
    return path


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help_with_an_example(command: str) -> None:
    words = {"import": ["import", "train-robots"], "evaluate": ["evaluate", "train-robots"]}.get(command, [command])
    result = run(*words, "--help")
    assert result.exit_code == 0
    assert f"Example: showtell {' '.join(words)}" in result.stdout
    assert "--seed" in result.stdout and "--json" in result.stdout


def test_help_imports_nothing_heavy() -> None:
    """In a process of its own: what is not imported cannot be slow."""
    code = (
        "import sys; from executor.cli import app; "
        "heavy = {'pybullet', 'pinocchio', 'ruckig', 'sklearn', 'pulp', 'open3d', 'scipy', 'pydantic', 'PIL'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_a_process_of_its_own_gives_exit_code_and_one_line() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "executor.cli", "do", "nowhere.json", "take it", "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert len(done.stderr.strip().splitlines()) == 1 and "nowhere.json" in done.stderr
    assert "Traceback" not in done.stderr
    assert "nowhere.json" in json.loads(done.stdout)["error"]


def test_unknown_command_and_option_are_usage_errors() -> None:
    for words in (["dance"], ["robots", "--loud"]):
        result = run(*words)
        assert result.exit_code == 2
        assert "Traceback" not in result.stderr


def test_robots() -> None:
    result = run("robots", "--json")
    assert result.exit_code == 0
    assert "three_dof" in json.loads(result.stdout)["robots"]
    one = json.loads(run("robots", "three_dof", "--json").stdout)
    assert one["joints"] == ["base_yaw", "shoulder", "elbow"]
    assert all(low < high for low, high in zip(one["lower"], one["upper"], strict=True))
    complains(run("robots", "r2d2"), "'r2d2' is unknown", "three_dof")


def test_record_never_writes_over_a_demo(demos: Path) -> None:
    before = {path: path.read_bytes() for path in demos.iterdir()}
    complains(run("record", "-o", demos, "--seed", "3"), "is there already")
    assert {path: path.read_bytes() for path in demos.iterdir()} == before


def test_record_complains_before_it_works(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.touch()
    complains(run("record", "-o", file), "is a file; name a folder")
    complains(run("record", "-o", tmp_path / "d", "--robot", "r2d2"), "'r2d2' is unknown")


def test_demos_are_listed_and_checked(demos: Path, truncated: Path) -> None:
    result = run("demos", demos, "--check", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["broken"] == 0
    result = run("demos", truncated, "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["demos"][0]["problem"] == "ends early"
    complains(run("demos", truncated.parent / "none"), "no such demo")


def test_replay_reaches_the_recorded_states(demos: Path, truncated: Path, tmp_path: Path) -> None:
    demo = sorted(demos.glob("*.mcap"))[0]
    film = tmp_path / "film.gif"
    result = run("replay", demo, "--check", "--picture", film, "--json")
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["success"] and said["max_error"] <= 1e-6 and said["states"] > 30
    assert film.stat().st_size > 1000
    complains(run("replay", truncated, "--check"), f"{truncated}: the demo ends early")
    both = run("replay", truncated, "--check", "--json")
    assert both.exit_code == 2
    assert both.stdout.count("\n") <= 1  # one object, not the figures and then the error
    complains(run("replay", demo, "--picture", tmp_path / "none" / "x.gif"), "does not exist")
    complains(run("replay", demo, "--picture", tmp_path / "x.txt"), "x.txt")
    complains(run("replay", tmp_path / "none.mcap"), "none.mcap", "no such demo")


def test_learn_inspect_and_resume(demos: Path, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    result = run("learn", demos, "-o", path, "--json")
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["demos"] == 2 and said["sentences"] >= 2 and said["median_seconds_last"] > 0
    more = json.loads(run("learn", demos, "-o", path, "--resume", path, "--json").stdout)
    assert more["demos_before"] == 2
    shown = json.loads(run("inspect", path, "--json").stdout)
    assert shown["demos"] == 4 and shown["actions"] and shown["bytes"]["concepts.spaces"] > 0
    assert any(name.startswith("colour_") for name in shown["concepts"])


def test_a_failed_learn_leaves_the_old_knowledge(demos: Path, truncated: Path, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    path.write_text("precious")
    complains(run("learn", truncated, "-o", path), "cut.mcap", "ends early")
    skipped = run("learn", truncated, "-o", path, "--skip-broken")
    assert skipped.exit_code == 2 and "every demo is broken; nothing was learned" in skipped.stderr
    complains(run("learn", "-o", path), "give either a folder of demos or --train-robots")
    complains(run("learn", demos, "-o", tmp_path / "no" / "k.json"), "does not exist")
    assert path.read_text() == "precious"


def test_knowledge_of_another_version_is_refused(knowledge_file: str, tmp_path: Path) -> None:
    data = json.loads(Path(knowledge_file).read_text())
    other = tmp_path / "old.json"
    other.write_text(json.dumps(data | {"version": 999}))
    complains(run("inspect", other), "old.json", "999")
    complains(run("do", other, "take the red cube"), "old.json", "999")
    other.write_text("{")
    complains(run("inspect", other), "old.json", "JSON")


def test_inspect_draws_the_tree_of_a_sentence(knowledge_file: str) -> None:
    result = run("inspect", knowledge_file, "take the", "--json")
    assert result.exit_code == 1  # not understood: explained, no traceback
    assert json.loads(result.stdout)["understood"] is False
    complains(run("inspect", knowledge_file, " "), "the sentence is empty")


SCENE = """
[[objects]]
id = 0
shape = "cube"
colour = "red"
position = [0.125, 0.125, 0.019]

[[objects]]
id = 1
shape = "cube"
colour = "blue"
position = [0.275, 0.175, 0.019]
"""


@pytest.fixture()
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def test_do_carries_out_a_command(knowledge_file: str, scene: Path, tmp_path: Path) -> None:
    picture = tmp_path / "done.png"
    result = run(
        "do", knowledge_file, "put the red cube on the blue cube", "--scene", scene, "--picture", picture, "--json"
    )
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["success"] and said["goal"]["object_id"] == 0
    assert said["goal"]["position"] == pytest.approx([0.275, 0.175, 0.057], abs=0.01)
    assert picture.stat().st_size > 1000


def test_do_plan_only_prints_the_plan(knowledge_file: str, scene: Path) -> None:
    result = run("do", knowledge_file, "put the red cube on the blue cube", "--scene", scene, "--plan-only")
    assert result.exit_code == 0
    for word in ("approach to", "descend to", "close the gripper", "carry to", "lower to", "open the gripper"):
        assert word in result.stdout


def test_do_refuses_with_exit_code_1(knowledge_file: str, scene: Path) -> None:
    result = run("do", knowledge_file, "take the magenta cube", "--scene", scene)
    assert result.exit_code == 1
    assert "magenta" in result.stdout and "Traceback" not in result.stderr
    assert run("do", knowledge_file, "hebe ihn hoch", "--scene", scene).exit_code == 1


def test_do_complains_about_its_arguments(knowledge_file: str, scene: Path, tmp_path: Path) -> None:
    complains(run("do", knowledge_file, "  "), "the command is empty")
    complains(run("do", tmp_path / "k.json", "take it"), "k.json", "no such knowledge file")
    complains(run("do", knowledge_file, "take it", "--scene", "moon"), "moon")
    complains(run("do", knowledge_file, "take it", "--robot", "r2d2"), "r2d2")
    complains(run("do", knowledge_file, "take it", "--scene", scene, "--picture", tmp_path / "x.bmp"), "x.bmp")
    scene.write_text(SCENE.replace('"cube"', '"ball"', 1))
    complains(run("do", knowledge_file, "take it", "--scene", scene), "scene.toml", "shape")


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("release")
    write_synthetic_release(folder, np.random.default_rng(0), scenes=16)
    return folder


def test_learning_and_evaluating_a_release(release: Path, tmp_path: Path) -> None:
    path = tmp_path / "k.json"
    learned = run("learn", "--train-robots", release, "-o", path, "--json")
    assert learned.exit_code == 0
    assert json.loads(learned.stdout)["demos"] == 16
    asked = run("evaluate", "train-robots", release, "--knowledge", path, "--json")
    assert asked.exit_code == 0
    said = json.loads(asked.stdout)
    assert set(said) >= {"figures", "baselines", "machine", "seed", "failures"}
    assert {"commands", "execution_accuracy", "rcl_exact", "subtree_score"} <= set(said["figures"])
    assert said["figures"]["commands"] == 32
    complains(run("evaluate", "train-robots", release, "--knowledge", path, "--folds", "4"), "not both")
    complains(run("evaluate", "train-robots", release, "--folds", "99"), "99 folds")


def test_importing_a_scene_of_a_release(release: Path, tmp_path: Path) -> None:
    result = run("import", "train-robots", release, "-o", tmp_path / "d", "--only", "1", "--jobs", "1", "--json")
    assert result.exit_code == 0
    said = json.loads(result.stdout)
    assert said["scenes"] == 1 and said["right"] == 1
    assert (tmp_path / "d" / "scene_0001.mcap").exists()


def test_a_malformed_release_is_named_by_file_and_line(release: Path, tmp_path: Path) -> None:
    broken = tmp_path / "broken"
    broken.mkdir()
    for name in ("commands.txt", "configuration.txt"):
        (broken / name).write_bytes((release / name).read_bytes())
    (broken / "commands.txt").write_text("1\tone\tput it there\r\n")
    for words in (("evaluate", "train-robots", broken), ("learn", "--train-robots", broken, "-o", tmp_path / "k.json")):
        complains(run(*words), "commands.txt", "1")
    complains(run("evaluate", "train-robots", tmp_path / "none"), "none")


def test_a_release_with_nothing_in_it_teaches_nothing(release: Path, tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    for name in ("commands.txt", "configuration.txt"):
        (empty / name).touch()
    for words in (
        ("learn", "--train-robots", empty, "-o", tmp_path / "k.json"),
        ("import", "train-robots", empty, "-o", tmp_path / "d"),
        ("evaluate", "train-robots", empty),
    ):
        complains(run(*words), "configuration.txt", "holds no layout")
    still = "".join(f"1\t{image}\r\n0\t0\t7\tO\r\n1\t1\t0\tR\t1\r\n\r\n" for image in range(1, 6))
    (empty / "configuration.txt").write_text(still)
    complains(run("learn", "--train-robots", empty, "-o", tmp_path / "k.json"), "exactly one block move")
    complains(run("evaluate", "train-robots", empty), "commands.txt", "holds no command")
    assert run("evaluate", "train-robots", release, "--folds", "0").exit_code == 2
