from pathlib import Path

import pytest

from teleop import Demo, DemoError, read_truth, truth_path, write_truth


def test_lies_beside_the_demo_and_comes_back(tmp_path: Path) -> None:
    demo = tmp_path / "x.mcap"
    assert truth_path(demo) == tmp_path / "x.truth.json"
    write_truth(demo, {"task": "move", "moved": {"id": 3}})
    assert read_truth(demo) == {"task": "move", "moved": {"id": 3}}
    assert [path.name for path in tmp_path.iterdir()] == ["x.truth.json"]


def test_record_demo_writes_it(small_demo: Demo) -> None:
    assert read_truth(small_demo.path) == {"moved": 0}


def test_problems_name_the_file(tmp_path: Path) -> None:
    with pytest.raises(DemoError, match=r"y\.truth\.json: cannot be read: No such file"):
        read_truth(tmp_path / "y.mcap")
    (tmp_path / "z.truth.json").write_text("{")
    with pytest.raises(DemoError, match=r"z\.truth\.json: not JSON"):
        read_truth(tmp_path / "z.mcap")
    (tmp_path / "z.truth.json").write_text("[]")
    with pytest.raises(DemoError, match="expected a JSON object, got list"):
        read_truth(tmp_path / "z.mcap")
