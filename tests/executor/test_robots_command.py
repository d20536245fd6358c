"""`showtell robots`: the list, one robot's numbers, a user's folder, and a picture."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner, Result

from executor.cli import app
from executor.portrait import portrait
from robots import list_robots, load_robot


def run(*words: str | Path) -> Result:
    return CliRunner().invoke(app, ["robots", *[str(each) for each in words]])


def complains(result: Result, *needles: str) -> None:
    """Bad input: exit code 2, nothing but one line on stderr."""
    assert result.exit_code == 2
    lines = result.stderr.strip().splitlines()
    assert len(lines) == 1 and lines[0].startswith("showtell: error: ")
    for needle in needles:
        assert needle in lines[0]


def test_the_three_robots_are_listed() -> None:
    assert json.loads(run("--json").stdout)["robots"] == ["baxter", "mico_segway", "three_dof"]
    told = " ".join(run().stdout.split())
    for name in list_robots():
        assert name in told


@pytest.mark.parametrize(
    ("name", "arms", "cameras"), [("baxter", ["left", "right"], ["chest"]), ("mico_segway", None, ["base"])]
)
def test_one_robot_tells_joints_limits_grippers_and_cameras(
    name: str, arms: list[str] | None, cameras: list[str]
) -> None:
    said = json.loads(run(name, "--json").stdout)
    robot = load_robot(name)
    assert said["name"] == name and said["joints"] == list(robot.joint_names)
    assert said["cameras"] == cameras and said["picture"] is None
    assert list(said["arms"]) == (arms or list(robot.arms))
    for arm, told in said["arms"].items():
        assert told["max_opening"] == robot.arms[arm].gripper.max_opening > told["min_opening"] >= 0
    np.testing.assert_allclose(said["velocity"], robot.velocity)
    # A joint that turns for ever has no limit, which JSON cannot say with a number.
    for low, true in zip(said["lower"], robot.lower, strict=True):
        assert low == (pytest.approx(true) if np.isfinite(true) else None)
    text = run(name).stdout
    assert ("wheels:" in text) == (robot.drive is not None)
    assert f"cameras: {cameras[0]}" in text


@pytest.mark.parametrize("suffix", ["png", "jpg"])
def test_a_picture_shows_the_robot(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"mico.{suffix}"
    assert run("mico_segway", "--picture", path).exit_code == 0
    drawn = np.asarray(Image.open(path))
    assert drawn.shape == (600, 800, 3)
    assert len(np.unique(drawn.reshape(-1, 3), axis=0)) > 500
    assert [each.name for each in tmp_path.iterdir()] == [path.name]


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_a_portrait_has_the_whole_robot_in_it(name: str) -> None:
    """Its edges are background and floor alone: nothing of the robot is cut off."""
    drawn = portrait(load_robot(name), 240, 180).astype(int)
    assert (drawn.std(axis=(0, 1)) > 10).all()
    middle, border = drawn[60:120, 80:160], np.concatenate((drawn[:2].reshape(-1, 3), drawn[-2:].reshape(-1, 3)))
    assert middle.std() > 2 * border.std()
    np.testing.assert_array_equal(portrait(load_robot(name), 240, 180), drawn)


def test_pictures_that_cannot_be_made_are_refused_before_anything_is_drawn(tmp_path: Path) -> None:
    complains(run("baxter", "--picture", tmp_path / "x.bmp"), "x.bmp", ".png")
    complains(run("--picture", tmp_path / "x.png"), "--picture draws one robot", "baxter, mico_segway, three_dof")
    complains(run("r2d2", "--picture", tmp_path / "x.png"), "'r2d2' is unknown", "three_dof")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_ones_own_is_a_robot(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(Path(load_robot("three_dof").folder), folder)
    text = (folder / "robot.toml").read_text(encoding="utf-8")
    (folder / "robot.toml").write_text(text.replace('name = "three_dof"', 'name = "mine"'), encoding="utf-8")
    said = json.loads(run(folder, "--json").stdout)
    assert said["name"] == "mine" and len(said["joints"]) == 3
    assert run(folder, "--picture", tmp_path / "mine.png").exit_code == 0
    assert len(np.unique(np.asarray(Image.open(tmp_path / "mine.png")).reshape(-1, 3), axis=0)) > 500
    (folder / "robot.toml").write_text(text.replace("elbow", "elbowe"), encoding="utf-8")
    complains(run(folder), "robot.toml", "elbowe")
    complains(run(tmp_path / "none"), "none")
