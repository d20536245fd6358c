"""Robots are found by name or by path."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from robots import RobotError, RobotModel, list_robots, load_robot


def test_the_board_arm_is_listed() -> None:
    assert "three_dof" in list_robots()


def test_every_listed_robot_loads() -> None:
    for name in list_robots():
        assert load_robot(name).name == name


def test_a_path_loads_the_same_robot(arm: RobotModel) -> None:
    for path in (arm.folder, arm.folder / "robot.toml"):
        other = load_robot(path)
        assert other.joint_names == arm.joint_names
        np.testing.assert_array_equal(
            other.forward_kinematics(arm.home).position, arm.forward_kinematics(arm.home).position
        )


@pytest.mark.parametrize("name", ["four_dof", "", Path("no/such/folder")])
def test_unknown_robots_are_refused_with_the_known_names(name: str | Path) -> None:
    with pytest.raises(RobotError, match=r"is unknown: use one of .*three_dof.*robot\.toml"):
        load_robot(name)


def test_importing_robots_stays_light() -> None:
    code = "import sys, robots, robots.catalogue; print([m for m in ('pinocchio', 'pydantic') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
