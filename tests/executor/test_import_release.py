import warnings
from pathlib import Path

import numpy as np
import pytest

from executor.compare_graphlets import compare_graphlets
from executor.errors import InputError
from executor.import_release import import_release
from learning.errors import ReleaseError
from learning.train_robots import Release, extended
from teleop import IncompleteDemoWarning, check_replay, load_demo, load_demos, read_truth
from twin.board import BLOCK, CELL, cell_centre


@pytest.fixture(scope="module")
def scenes(synthetic_release_directory: Path) -> list[int]:
    """A move, a take and a drop."""
    chosen = {}
    for scene in Release.load(synthetic_release_directory).one_block_scenes():
        assert scene.move is not None
        chosen.setdefault(scene.move.kind, scene.number)
    assert set(chosen) == {"move", "take", "drop"}
    return sorted(chosen.values())


@pytest.fixture(scope="module")
def imported(synthetic_release_directory: Path, scenes: list[int], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("imported")
    report = import_release(synthetic_release_directory, folder, jobs=1, only=scenes, progress=False)
    assert (len(report.outcomes), report.right, report.kept, report.failures) == (3, 3, 0, ())
    assert report.real_time_factor > 0.0
    return folder


def test_demos_end_in_the_after_layout(imported: Path, synthetic_release_directory: Path, scenes: list[int]) -> None:
    release = Release.load(synthetic_release_directory)
    demos = list(load_demos(imported))
    assert [demo.path.name for demo in demos] == [f"scene_{number:04d}.mcap" for number in scenes]
    for demo, number in zip(demos, scenes, strict=True):
        scene = release.scenes[number]
        move = scene.move
        assert move is not None
        assert demo.complete
        assert demo.utterances == tuple(command.sentence for command in release.commands_of(number))
        for index, block in enumerate(scene.before.blocks):
            goal = cell_centre(*(move.goal if index == move.object_id else block.cell))
            off = demo.states.object_positions[-1, index] - goal
            assert np.abs(off[:2]).max() < CELL / 2
            assert abs(off[2]) < BLOCK / 2
        # A held block starts in the closed gripper; a lone take ends with it there.
        assert (demo.states.held[0] == move.object_id) == demo.states.gripper_closed[0] == move.held_at_start
        assert (demo.states.held[-1] == move.object_id) == demo.states.gripper_closed[-1] == move.held_at_end


def test_imported_demos_replay_exactly(imported: Path) -> None:
    for path in sorted(imported.glob("*.mcap")):
        assert check_replay(path).max_error == 0.0


def test_driven_demos_show_the_actions_that_layouts_imply(imported: Path, synthetic_release_directory: Path) -> None:
    pairs = compare_graphlets(Release.load(synthetic_release_directory), imported, 50, np.random.default_rng(0))
    assert len(pairs) == len(list(imported.glob("*.mcap")))
    assert all(pair.same for pair in pairs), [(p.scene, str(p.driven), str(p.implied)) for p in pairs if not p.same]


def test_truth_lies_beside_the_demo(imported: Path, scenes: list[int]) -> None:
    truth = read_truth(imported / f"scene_{scenes[0]:04d}.mcap")
    assert truth["scene"] == scenes[0]
    assert truth["right"] is True
    assert truth["task"] in ("move", "take", "drop")


def test_goes_on_where_it_stopped(
    imported: Path, synthetic_release_directory: Path, scenes: list[int], tmp_path: Path
) -> None:
    """One demo whole, one cut, one missing, and what an interrupted process left: only the last three are made."""
    names = [f"scene_{number:04d}" for number in scenes]
    for name in names[:2]:
        for suffix in (".mcap", ".truth.json"):
            (tmp_path / f"{name}{suffix}").write_bytes((imported / f"{name}{suffix}").read_bytes())
    whole = (tmp_path / f"{names[0]}.mcap").read_bytes()
    cut = tmp_path / f"{names[1]}.mcap"
    cut.write_bytes(cut.read_bytes()[:-20])
    (tmp_path / f"{names[2]}.partial").write_bytes(b"half")
    report = import_release(synthetic_release_directory, tmp_path, jobs=1, only=scenes, progress=False)
    assert (report.right, report.kept) == (3, 1)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        f"{name}{suffix}" for name in names for suffix in (".mcap", ".truth.json")
    )
    assert (tmp_path / f"{names[0]}.mcap").read_bytes() == whole
    with warnings.catch_warnings():
        warnings.simplefilter("error", IncompleteDemoWarning)
        for name in names:
            # The seed decides a scene's demo, whatever was driven before it.
            again, first = load_demo(tmp_path / f"{name}.mcap"), load_demo(imported / f"{name}.mcap")
            np.testing.assert_array_equal(again.inputs.axes, first.inputs.axes)


def test_processes_share_the_work_and_a_bar_goes_to_stderr(
    imported: Path,
    synthetic_release_directory: Path,
    scenes: list[int],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    report = import_release(synthetic_release_directory, tmp_path, jobs=2, only=scenes)
    assert (report.right, report.jobs) == (3, 2)
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "3/3" in captured.err
    name = f"scene_{scenes[0]:04d}.mcap"
    np.testing.assert_array_equal(load_demo(tmp_path / name).states.q, load_demo(imported / name).states.q)


def test_bad_input_is_one_line(synthetic_release_directory: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"jobs is 0, allowed 1\.\.64"):
        import_release(synthetic_release_directory, tmp_path, jobs=0, progress=False)
    with pytest.raises(InputError, match="has no scene 9999"):
        import_release(synthetic_release_directory, tmp_path, only=[9999], progress=False)
    with pytest.raises(ReleaseError, match="nowhere"):
        import_release(tmp_path / "nowhere", tmp_path, progress=False)


def test_a_scene_that_moves_two_blocks_is_refused(real_release_directory: Path, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="scene 461 does not move exactly one block"):
        import_release(real_release_directory, tmp_path, only=[461], progress=False)


def test_real_scenes_of_every_kind(real_release_directory: Path, tmp_path: Path) -> None:
    report = import_release(real_release_directory, tmp_path, jobs=1, only=[377, 558, 630], progress=False)
    assert [outcome.reason for outcome in report.outcomes] == ["", "", ""]


def test_the_extended_release_is_driven_with_its_own_shapes_and_words(
    synthetic_release_directory: Path, tmp_path: Path
) -> None:
    extended_release = extended(Release.load(synthetic_release_directory), np.random.default_rng(5))
    chosen = [
        number
        for number, changes in sorted(extended_release.changes.items())
        if len(changes) == 3 and extended_release.scenes[number].move is not None
    ][:2]
    report = import_release(
        synthetic_release_directory, tmp_path, jobs=1, only=chosen, seed=5, progress=False, extend=True
    )
    assert [outcome.right for outcome in report.outcomes] == [True, True]
    for number, demo in zip(chosen, load_demos(tmp_path), strict=True):
        said = tuple(command.sentence for command in extended_release.commands_of(number))
        assert demo.utterances == said
        shown = {thing.shape for thing in demo.scene.objects}
        assert shown == {block.shape for block in extended_release.scenes[number].before.blocks}
    assert len(compare_graphlets(extended_release, tmp_path, 50, np.random.default_rng(0))) == 2
    with pytest.raises(InputError, match="a folder of their own"):
        import_release(synthetic_release_directory, tmp_path, jobs=1, only=chosen, progress=False)
