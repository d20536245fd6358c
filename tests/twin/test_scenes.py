"""Scenes are found by name, path or specification; wrong ones are refused in one line."""

import re
from pathlib import Path

import pytest

from twin import SceneError, SceneSpec, read_scene
from twin.scenes import resolve_scene

GOOD = """
name = "two"
gripper_position = [0.2, 0.2, 0.3]

[[objects]]
id = 1
shape = "cube"
colour = "red"
position = [0.025, 0.025, 0.019]

[[objects]]
id = 7
shape = "prism"
colour = "white"
position = [0.025, 0.025, 0.057]
"""


def test_a_toml_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "two.toml"
    path.write_text(GOOD, encoding="utf-8")
    spec = resolve_scene(path)
    assert [each.id for each in spec.objects] == [1, 7]
    assert spec.gripper_position == (0.2, 0.2, 0.3)
    assert resolve_scene(str(path)) == spec == read_scene(path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('colour = "white"', 'colour = "gold"', "objects[1].colour: unknown colour; use one of blue, "),
        (
            'shape = "prism"',
            'shape = "ball"',
            "objects[1].shape: unknown shape; use one of cube, prism, sphere, cylinder; got 'ball'",
        ),
        ("id = 7", "id = 1", "objects: id 1 is used more than once"),
        ("id = 7", "", "objects[1].id: missing"),
        ('name = "two"', 'nome = "two"', "nome: unknown key; allowed keys here are name, kind, robot,"),
        ('name = "two"', "held = 3", "held: 3 is not the id of an object; the scene's ids: 1, 7"),
        ("[[objects]]", "[[objects", "not valid TOML"),
    ],
)
def test_wrong_files_are_named(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "bad.toml"
    path.write_text(GOOD.replace(old, new), encoding="utf-8")
    with pytest.raises(SceneError, match=f"^{re.escape(str(path))}: {re.escape(message)}") as caught:
        resolve_scene(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("scene", ["kitchen", "", Path("no/such.toml")])
def test_unknown_scenes_are_refused(scene: str | Path) -> None:
    with pytest.raises(
        SceneError,
        match="is unknown: use 'board', 'board-all', 'tabletop', 'ordering' or the path of a scene's TOML file",
    ):
        resolve_scene(scene)


def test_a_specification_is_given_back() -> None:
    spec = SceneSpec(name="mine")
    assert resolve_scene(spec, seed=5) is spec


def test_board_depends_on_the_seed_alone() -> None:
    assert resolve_scene("board", 5) == resolve_scene("board", 5)
    assert resolve_scene("board", 5) != resolve_scene("board", 6)
    assert resolve_scene("board", 5).seed == 5
