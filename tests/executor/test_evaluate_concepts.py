import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from executor.cli import app
from learning.train_robots.synthetic import write_synthetic_release


@pytest.fixture(scope="module")
def release(tmp_path_factory: pytest.TempPathFactory) -> Path:
    directory = tmp_path_factory.mktemp("release")
    write_synthetic_release(directory, np.random.default_rng(0))
    return directory


def test_one_json_object_has_the_names_that_others_rely_on(release: Path) -> None:
    arguments = ["evaluate", "concepts", "--train-robots", str(release), "--count", "10", "--no-pure", "--json"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    for space in ("colour", "shape", "location", "direction", "action"):
        for name in ("v_measure", "concepts", "true_concepts"):
            assert isinstance(told["figures"][f"{name}.{space}"], float)
        assert f"svm.{space}" in told["baselines"]
        assert isinstance(told["baselines"][f"thesis.{space}"], float)
    assert told["memory"][-1]["demos"] == 10


def test_the_curve_is_drawn(release: Path, tmp_path: Path) -> None:
    picture = tmp_path / "curve.png"
    arguments = ["evaluate", "concepts", "--train-robots", str(release), "--count", "6", "--no-pure"]
    result = CliRunner().invoke(app, [*arguments, "--labels", "2", "--plot", str(picture)])
    assert result.exit_code == 0, result.output
    assert picture.exists()
    assert "With one object named in each of 2 demos" in result.stdout
    assert "thesis table 6.3" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ([], "give either a folder of demos or --train-robots"),
        (["--robot", "baxter", "--train-robots", "x"], "--train-robots shows the board of three_dof, not baxter"),
        (["nowhere"], "no such demo or folder"),
        (["--train-robots", "x", "--plot", "curve.txt"], "a picture's name ends in"),
    ],
)
def test_wrong_input_is_told_in_one_line(arguments: list[str], message: str) -> None:
    result = CliRunner().invoke(app, ["evaluate", "concepts", *arguments])
    assert result.exit_code == 2
    assert message in result.stderr
