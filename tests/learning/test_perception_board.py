import colorsys
from types import SimpleNamespace

import numpy as np
import pytest

from learning.errors import PerceptionError
from learning.perception import KeyFrame, observe_demo, observe_key_frames, observe_world
from learning.perception.board_noise import BOARD_NOISE, BoardNoise, hsl
from learning.perception.descriptors import board_descriptors
from tests.learning.board_demos import blocks
from twin import SceneSpec, World
from twin.board import COLOURS_RGB, cell_centre

OBJECTS = blocks(((1, 2, 0), "red", "cube"), ((1, 2, 1), "green", "prism"), ((6, 6, 0), "gray", "cube"))
TRUE = np.array([thing.position for thing in OBJECTS])
STILL = KeyFrame(cell_centre(3, 3, 6), True, TRUE)
SILENT = BoardNoise(location=0.0, colour=0.0, lighting=0.0, shape=0.0)


def test_without_noise_the_truth_is_seen() -> None:
    seen = observe_key_frames([STILL, STILL], OBJECTS, np.random.default_rng(0), SILENT)
    assert seen.object_ids.tolist() == [10, 11, 12]
    assert np.allclose(np.diff(seen.times), 0.1)
    assert np.array_equal(seen.location, np.broadcast_to(TRUE, (8, 3, 3)))
    assert np.array_equal(seen.gripper_location, np.tile(cell_centre(3, 3, 6), (8, 1)))
    assert seen.gripper_closed.all()
    assert np.allclose(seen.colour[0], [hsl(COLOURS_RGB[thing.colour]) for thing in OBJECTS])
    assert np.array_equal(seen.shape[3], [board_descriptors()[thing.shape] for thing in OBJECTS])


def test_noise_has_the_stated_deviations() -> None:
    seen = observe_key_frames([STILL] * 500, OBJECTS, np.random.default_rng(1))
    # 2,000 frames: a deviation is estimated to 1.6% (one deviation); 7% is more than four of them.
    assert (seen.location - TRUE).std(axis=0) == pytest.approx(np.full((3, 3), 0.003), rel=0.07)
    assert (seen.gripper_location - cell_centre(3, 3, 6)).std(axis=0) == pytest.approx(np.full(3, 0.003), rel=0.07)
    assert seen.colour[:, 1].std(axis=0) == pytest.approx(np.full(3, 0.03), rel=0.07)  # green: far from every bound
    bins = board_descriptors()["cube"]
    assert seen.shape[:, 0, bins > 0].std(axis=0) / bins[bins > 0] == pytest.approx(0.05, rel=0.1)
    assert not seen.shape[:, 0, bins == 0].any()
    assert seen.colour.min() >= 0.0 and seen.colour.max() <= 1.0
    assert np.ptp(seen.colour[:, 0, 0]) > 0.9  # red lies on both sides of the wrap


def test_lighting_is_shared_by_a_demo_and_differs_between_demos() -> None:
    rng = np.random.default_rng(2)
    truth = np.array(hsl(COLOURS_RGB["green"]))
    shifts = np.array(
        [observe_key_frames([STILL], OBJECTS, rng, BoardNoise(colour=0.0)).colour[:, 1] - truth for _ in range(300)]
    )
    assert np.allclose(shifts, shifts[:, :1])
    assert shifts[:, 0].std(axis=0) == pytest.approx(np.full(3, BOARD_NOISE.lighting), rel=0.17)  # four of 4.1%


def test_the_same_seed_sees_the_same() -> None:
    first, second = (observe_key_frames([STILL], OBJECTS, np.random.default_rng(3)) for _ in range(2))
    assert np.array_equal(first.colour, second.colour)
    assert np.array_equal(first.location, second.location)


@pytest.mark.parametrize("colour", COLOURS_RGB)
def test_hsl_agrees_with_its_inverse(colour: str) -> None:
    hue, saturation, lightness = hsl(COLOURS_RGB[colour])
    assert colorsys.hls_to_rgb(hue, lightness, saturation) == pytest.approx(COLOURS_RGB[colour], abs=1e-12)


def test_without_key_frames_there_is_nothing_to_see() -> None:
    with pytest.raises(PerceptionError, match="no key frames to observe"):
        observe_key_frames([], OBJECTS, np.random.default_rng(4))


def test_a_world_is_seen_as_it_stands() -> None:
    spec = SceneSpec(objects=OBJECTS, gripper_position=(0.2, 0.2, 0.3))
    with World.from_scene(spec) as world:
        state = world.state()
        seen = observe_world(state, world.spec, np.random.default_rng(5))
    assert seen.object_ids.tolist() == [10, 11, 12]
    true = np.array([thing.pose_object_in_world.position for thing in state.objects])
    # Ten frames average 3 mm to 0.95 mm; four of them.
    assert np.allclose(seen.location.mean(axis=0), true, atol=0.0038)
    assert not seen.gripper_closed.any()


def test_a_recorded_demo_is_seen_ten_times_a_second_and_to_its_end() -> None:
    for frames in (2, 3, 139, 140):
        times = np.arange(frames) / 30.0
        positions = np.tile(TRUE, (frames, 1, 1)) + 0.001 * np.arange(frames)[:, None, None]
        states = SimpleNamespace(
            times=times,
            tool=np.zeros((frames, 7)),
            gripper_closed=np.arange(frames) == frames - 1,
            object_ids=np.array([12, 10, 11]),  # in another order than the scene's
            object_positions=positions,
        )
        demo = SimpleNamespace(times=times, states=states, scene=SceneSpec(objects=OBJECTS))
        seen = observe_demo(demo, np.random.default_rng(6), SILENT)  # type: ignore[arg-type]
        assert seen.object_ids.tolist() == [12, 10, 11]
        assert seen.times[0] == times[0]
        assert seen.times[-1] == times[-1]
        assert seen.gripper_closed[-1]
        assert np.array_equal(seen.location[-1], positions[-1])
        assert np.allclose(seen.colour[0, 1], hsl(COLOURS_RGB["red"]))
        assert np.all(np.diff(seen.times)[:-1] > 0.06)
        assert np.all(np.diff(seen.times) < 0.14)
