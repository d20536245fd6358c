from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.errors import LearningError
from learning.train_robots import (
    Release,
    Scene,
    implied_key_frames,
    key_frames,
    observe_before,
    write_synthetic_release,
)
from learning.train_robots.layout import Block, Layout
from twin.board import cell_centre


def layout(image: int, gripper: tuple[int, int, int], closed: bool, *cells: tuple[int, int, int]) -> Layout:
    colours = ("red", "green", "blue")
    return Layout(1, image, gripper, closed, tuple(Block(c, colours[i], "cube") for i, c in enumerate(cells)))


def steps(scene: Scene, moved: int) -> list[tuple[tuple[int, int, int], bool, tuple[int, int, int]]]:
    """Key frames in cells: gripper, closed, moved block."""
    cells = {tuple(cell_centre(x, y, z)): (x, y, z) for x in range(8) for y in range(8) for z in range(10)}
    return [
        (cells[tuple(f.gripper_location)], f.gripper_closed, cells[tuple(f.object_location[moved])])
        for f in implied_key_frames(scene)
    ]


def test_a_move_goes_up_across_and_down() -> None:
    scene = Scene(
        1, layout(1, (0, 0, 5), False, (1, 1, 0), (2, 2, 0)), layout(2, (7, 7, 5), False, (1, 1, 0), (1, 1, 1))
    )
    start, goal = (2, 2, 0), (1, 1, 1)
    assert steps(scene, 1) == [
        ((0, 0, 5), False, start),
        ((2, 2, 3), False, start),
        (start, False, start),
        (start, True, start),
        ((2, 2, 3), True, (2, 2, 3)),
        ((1, 1, 3), True, (1, 1, 3)),
        (goal, True, goal),
        (goal, False, goal),
        ((1, 1, 3), False, goal),
    ]


def test_a_lone_take_ends_straight_above_in_the_gripper() -> None:
    scene = Scene(1, layout(1, (0, 0, 5), False, (1, 1, 0)), layout(2, (1, 1, 4), True, (1, 1, 4)))
    assert steps(scene, 0)[-2:] == [((1, 1, 0), True, (1, 1, 0)), ((1, 1, 4), True, (1, 1, 4))]


def test_a_lone_drop_starts_in_the_gripper_and_goes_straight_down() -> None:
    scene = Scene(2, layout(2, (1, 1, 4), True, (1, 1, 4)), layout(1, (0, 0, 5), False, (1, 1, 0)))
    assert steps(scene, 0) == [
        ((1, 1, 4), True, (1, 1, 4)),
        ((1, 1, 0), True, (1, 1, 0)),
        ((1, 1, 0), False, (1, 1, 0)),
        ((1, 1, 6), False, (1, 1, 0)),
    ]


def test_a_scene_that_moves_nothing_implies_no_key_frames() -> None:
    still = layout(1, (0, 0, 5), False, (1, 1, 0))
    with pytest.raises(LearningError, match="scene 4 does not move exactly one block"):
        implied_key_frames(Scene(4, still, still))


@given(seed=st.integers(0, 2**32 - 1))
def test_only_the_moved_block_moves_and_it_ends_at_its_goal(
    seed: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    directory = tmp_path_factory.mktemp("release")
    write_synthetic_release(directory, np.random.default_rng(seed), scenes=8)
    for scene in Release.load(directory).scenes.values():
        move = scene.move
        assert move is not None
        location = np.array([frame.object_location for frame in implied_key_frames(scene)])
        others = np.delete(location, move.object_id, axis=1)
        assert np.array_equal(others, np.broadcast_to(others[0], others.shape))
        assert np.array_equal(location[0, move.object_id], cell_centre(*move.start))
        assert np.array_equal(location[-1, move.object_id], cell_centre(*move.goal))


def test_observations_see_the_key_frames_through_noise(synthetic_release_directory: Path) -> None:
    scene = Release.load(synthetic_release_directory).scenes[1]
    assert scene.move is not None
    rng = np.random.default_rng(3)
    seen = key_frames(scene, rng)
    assert list(seen.object_ids) == list(range(len(scene.before.blocks)))
    error = seen.location[-1] - [cell_centre(*block.cell) for block in scene.after.blocks]
    # 3 mm of noise a coordinate (design section 7): five standard deviations
    assert 0 < np.abs(error).max() < 0.015
    before = observe_before(scene, rng)
    assert np.ptp(before.location, axis=0).max() < 0.03  # nothing moves: ten deviations from least to greatest
    again = key_frames(scene, np.random.default_rng(3))
    assert np.array_equal(seen.location, again.location)
    assert np.array_equal(seen.colour, again.colour)


def test_every_real_scene_has_key_frames(real_release_directory: Path) -> None:
    lengths = {"move": 9, "take": 5, "drop": 4}
    for scene in Release.load(real_release_directory).one_block_scenes():
        assert scene.move is not None
        assert len(implied_key_frames(scene)) == lengths[scene.move.kind]
