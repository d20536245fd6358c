"""`showtell evaluate train-robots`: what is learned anew with its flags."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from executor.cli import app
from learning.train_robots import write_synthetic_release


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("release")
    write_synthetic_release(folder, np.random.default_rng(0), scenes=16)
    return folder


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(app, ["evaluate", "train-robots", *map(str, arguments)])


def test_curve_costs_extension_and_sensitivity_are_told(release: Path, tmp_path: Path) -> None:
    picture = tmp_path / "curve.png"
    flags = ("--folds", "2", "--jobs", "1", "--extended", "--epsilon", "0.02", "--epsilon", "0.2", "--plot", picture)
    result = run(release, *flags, "--json")
    assert result.exit_code == 0, result.output
    figures = json.loads(result.stdout)["figures"]
    assert {"learn_seconds", "median_ms", "p99_ms", "learn_cpu_ms_per_command.quarter_4"} <= set(figures)
    assert {"extended.execution_accuracy", "epsilon.0.2.execution_accuracy", "commands_to_80"} <= set(figures)
    assert picture.stat().st_size > 5_000  # a picture, not an empty page


def test_what_does_not_go_together_is_refused(release: Path, tmp_path: Path) -> None:
    for flags in (("--extended",), ("--epsilon", "0.1"), ("--plot", tmp_path / "a.png")):
        result = run(release, "--knowledge", tmp_path / "k.json", *flags)
        assert result.exit_code == 2
        assert "not both" in result.output.replace("\n", " ")
    assert "above 0 and below 1" in run(release, "--epsilon", "1.5").output.replace("\n", " ")
