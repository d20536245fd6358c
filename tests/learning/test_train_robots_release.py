import shutil
from collections import Counter
from pathlib import Path

import pytest

from learning.errors import ReleaseError
from learning.train_robots import Block, Release, scene_spec
from learning.train_robots.scene import images_of_scene
from twin.board import cell_centre


@pytest.fixture
def release_copy(tmp_path: Path, synthetic_release_directory: Path) -> Path:
    shutil.copytree(synthetic_release_directory, tmp_path / "copy")
    return tmp_path / "copy"


def edit(path: Path, line: int, text: str | None) -> None:
    """Replace line `line` (from 1) of a release file, or delete it."""
    lines = path.read_bytes().split(b"\r\n")
    lines[line - 1 : line] = [] if text is None else [text.encode()]
    path.write_bytes(b"\r\n".join(lines))


def test_scene_numbers_follow_the_rule_of_the_release() -> None:
    assert [images_of_scene(n) for n in (1, 2, 3, 8, 9, 1000)] == [
        (1, 1, 2),
        (1, 2, 1),
        (1, 1, 3),
        (1, 5, 1),
        (2, 1, 2),
        (125, 5, 1),
    ]


def test_a_synthetic_release_loads_and_every_scene_moves_one_block(synthetic_release_directory: Path) -> None:
    release = Release.load(synthetic_release_directory)
    assert len(release.scenes) == 48
    assert len(release.commands) == 96
    kinds = Counter(scene.move.kind for scene in release.scenes.values() if scene.move)
    assert kinds == {"move": 36, "take": 6, "drop": 6}
    assert [command.id for command in release.commands_of(3)] == [5, 6]


def test_line_ends_do_not_matter(release_copy: Path) -> None:
    expected = Release.load(release_copy)
    for name, end in (("commands.txt", b"\n"), ("configuration.txt", b"\r\r\n")):
        path = release_copy / name
        path.write_bytes(path.read_bytes().replace(b"\r\n", end))
    changed = Release.load(release_copy)
    assert changed.commands == expected.commands
    assert changed.scenes == expected.scenes


def test_the_release_is_read_without_its_annotation(release_copy: Path) -> None:
    expected = Release.load(release_copy)
    (release_copy / "annotation.txt").unlink()
    assert Release.load(release_copy) == expected


@pytest.mark.parametrize(
    ("name", "line", "text", "message"),
    [
        ("commands.txt", 2, "2\tput it down", r"commands\.txt, line 2: 2 columns where 3 were expected"),
        ("commands.txt", 2, "two\t1\tgo", r"commands\.txt, line 2: command id 'two' is not a number"),
        ("commands.txt", 2, "1\t1\tgo", r"commands\.txt, line 2: command id 1 stands twice"),
        ("commands.txt", 3, "3\t49\tgo", r"line 3: scene 49 needs .* group 7, .*allowed scenes: 1\.\.48"),
        ("configuration.txt", 1, "1\t6", r"configuration\.txt, line 1: image 6 is out of range; .*1\.\.5"),
        ("configuration.txt", 2, "1\t2\t3\tX", r"line 2: unknown gripper code 'X'; allowed: O, C"),
        ("configuration.txt", 3, "1\t2\t0\tQ\t1", r"line 3: unknown colour code 'Q'; allowed: B, C, R, Y, G, M, X, W"),
        ("configuration.txt", 3, "1\t2\t0\tB\t3", r"line 3: unknown shape code '3'; allowed: 1, 2"),
        ("configuration.txt", 3, "1\t8\t0\tB\t1", r"line 3: cell y 8 is out of range; expected .*0\.\.7"),
        ("configuration.txt", 3, "1\t-1\t0\tB\t1", r"line 3: cell y '-1' is not a number"),
        ("configuration.txt", 3, "1\t1\t0\tB", r"line 3: 4 columns where 5 were expected"),
        ("configuration.txt", 2, None, r"line 2: 5 columns where 4 were expected"),
    ],
)
def test_a_malformed_line_is_named(release_copy: Path, name: str, line: int, text: str | None, message: str) -> None:
    edit(release_copy / name, line, text)
    with pytest.raises(ReleaseError, match=message):
        Release.load(release_copy)


def test_two_blocks_in_one_cell_are_refused(release_copy: Path) -> None:
    third = (release_copy / "configuration.txt").read_text().splitlines()[2]
    edit(release_copy / "configuration.txt", 4, third)
    with pytest.raises(ReleaseError, match=r"line 4: cell \(\d, \d, 0\) of group 1 image 1 holds two blocks"):
        Release.load(release_copy)


def test_a_missing_layout_is_named(release_copy: Path) -> None:
    path = release_copy / "configuration.txt"
    records = path.read_bytes().split(b"\r\n\r\n")
    path.write_bytes(b"\r\n\r\n".join(records[:2] + records[3:]))
    with pytest.raises(ReleaseError, match=r"configuration\.txt: group 1 has no layout of image 3; .*1\.\.5"):
        Release.load(release_copy)


@pytest.mark.parametrize("name", ["commands.txt", "configuration.txt"])
def test_a_missing_file_is_named(release_copy: Path, name: str) -> None:
    (release_copy / name).unlink()
    with pytest.raises(ReleaseError, match=f"{name} is missing"):
        Release.load(release_copy)


def test_a_missing_directory_is_named(tmp_path: Path) -> None:
    with pytest.raises(ReleaseError, match="'.*nowhere' is not a directory"):
        Release.load(tmp_path / "nowhere")


def test_bytes_that_are_not_text_are_named(release_copy: Path) -> None:
    path = release_copy / "commands.txt"
    path.write_bytes(path.read_bytes().replace(b"\r\n", b"\r\n\xff", 1))
    with pytest.raises(ReleaseError, match=r"commands\.txt, line 2: byte 0xff is not UTF-8"):
        Release.load(release_copy)


def test_the_scene_spec_starts_as_the_before_layout(synthetic_release_directory: Path) -> None:
    release = Release.load(synthetic_release_directory)
    for scene in release.scenes.values():
        spec = scene_spec(scene)
        assert [thing.id for thing in spec.objects] == list(range(len(scene.before.blocks)))
        for thing, block in zip(spec.objects, scene.before.blocks, strict=True):
            assert (thing.colour, thing.shape) == (block.colour, block.shape)
            assert thing.position == tuple(cell_centre(*block.cell))
        assert spec.gripper_position == tuple(cell_centre(*scene.before.gripper))
        assert (spec.held is None) == (not spec.gripper_closed)
        if scene.move and scene.move.held_at_start:
            assert spec.held == scene.move.object_id


def test_the_real_release_is_as_its_readme_says(real_release_directory: Path) -> None:
    release = Release.load(real_release_directory)
    assert len(release.commands) == 2500
    assert list(release.scenes) == list(range(1, 1001))
    assert len(release.one_block_scenes()) == 994
    assert sorted({n for n, scene in release.scenes.items() if not scene.one_block}) == [461, 462, 889, 890, 891, 892]
    first = release.scenes[1]
    assert first.before.blocks[3] == Block((6, 5, 1), "green", "prism")
    assert (first.before.gripper, first.before.closed) == ((6, 5, 4), False)
    assert first.move is not None
    assert (first.move.object_id, first.move.goal, first.move.kind) == (3, (0, 7, 0), "move")
    for scene in release.one_block_scenes():
        move = scene.move
        assert move is not None
        if move.kind != "move":  # up or straight down
            assert move.start[:2] == move.goal[:2]
