"""Fixtures that several folders' tests share."""

import os
from pathlib import Path

import numpy as np
import pytest

from learning.train_robots import write_synthetic_release

REPOSITORY = Path(__file__).resolve().parent.parent
REAL_RELEASE = REPOSITORY.parent / "shared" / "data" / "train-robots"


@pytest.fixture(scope="session")
def real_release_directory() -> Path:
    """The public Train-Robots release, where there is one; else the test says so and is skipped."""
    directory = Path(os.environ.get("SHOWTELL_TRAIN_ROBOTS", REAL_RELEASE))
    if not (directory / "commands.txt").exists():
        pytest.skip(f"no Train-Robots release at {directory}; name one with SHOWTELL_TRAIN_ROBOTS")
    return directory


@pytest.fixture(scope="session")
def synthetic_release_directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small release of our own in the public format; tests must not change it."""
    directory = tmp_path_factory.mktemp("release")
    write_synthetic_release(directory, np.random.default_rng(11), scenes=48)
    return directory
