"""A robot folder that a test may spoil."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from robots import RobotModel, load_robot


@pytest.fixture(scope="session")
def arm() -> RobotModel:
    return load_robot("three_dof")


@pytest.fixture
def spoiled(arm: RobotModel, tmp_path: Path) -> Callable[..., Path]:
    """Copy the board arm's folder and replace a piece of text in one of its files, which must be there."""

    def spoil(old: str, new: str, file: str = "robot.toml") -> Path:
        folder = tmp_path / "bot"
        shutil.copytree(arm.folder, folder)
        text = (folder / file).read_text(encoding="utf-8")
        assert old in text
        (folder / file).write_text(text.replace(old, new), encoding="utf-8")
        return folder

    return spoil
