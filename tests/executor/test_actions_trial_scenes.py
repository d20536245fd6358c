"""New scenes to try actions in: reproducible, with a destination that is free."""

import numpy as np
import pytest

from executor.actions.trial_scenes import FARTHER, trial_scene
from twin.scene_spec import overlap_depth


@pytest.mark.parametrize("robot", ["baxter", "mico_segway"])
@pytest.mark.parametrize("seed", range(5))
def test_the_destination_is_elsewhere_and_free(robot: str, seed: int) -> None:
    scene = trial_scene(robot, False, np.random.default_rng(seed))
    again = trial_scene(robot, False, np.random.default_rng(seed))
    assert scene.spec == again.spec and np.array_equal(scene.destination, again.destination)
    assert scene.spec.robot == robot
    thing = next(each for each in scene.spec.objects if each.id == scene.object_id)
    assert np.linalg.norm(scene.destination - thing.position) > FARTHER
    for turn in (0.0, 0.8, 1.6):
        moved = thing.model_copy(update={"position": tuple(scene.destination), "yaw": turn})
        others = [each for each in scene.spec.objects if each.id != thing.id]
        assert all(overlap_depth(moved, other) <= 0.0 for other in others)


def test_the_board_has_scenes_that_start_with_a_block_in_the_hand() -> None:
    rng = np.random.default_rng(1)
    held, free = trial_scene("three_dof", True, rng), trial_scene("three_dof", False, rng)
    assert held.spec.held == held.object_id
    assert free.spec.held is None
