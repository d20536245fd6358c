"""What tracks and the hand's own sense say of the hand and each object, with noise as a camera's."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.errors import PerceptionError
from learning.perception.gaps import box_size, face_distances, gap_offsets
from learning.perception.handling import (
    OUTLIERS,
    above_evidence,
    bounded,
    felt,
    force_evidence,
    holding_evidence,
    raised_evidence,
    touch_evidence,
)
from learning.perception.held_object import with_held_object
from learning.perception.observation import Observation
from learning.perception.track_noise import LEAST_NOISE, track_noise
from learning.perception.tracks import at_rest, moved_distance, moved_object, rest_radius
from tests.learning.table_demos import ORDERING, TABLETOP, Noise, table_demo

NO_NOISE = Noise(0.0, 0.0, 0.0, 0.0)
BOX = np.array([0.04, 0.06, 0.1])


def one_box(tools: list[list[float]], frames: int = 1, **more: Any) -> Observation:
    """A box of 40 x 60 x 100 mm whose centre is at (0.5, 0, 0.05), and a hand."""
    tool = np.repeat(np.array(tools, dtype=float), frames, axis=0)
    count = len(tool)
    observation = Observation(
        times=0.1 * np.arange(count),
        gripper_location=tool,
        gripper_closed=np.zeros(count, dtype=bool),
        object_ids=np.array([0]),
        location=np.tile([0.5, 0.0, 0.05], (count, 1, 1)),
        colour=np.zeros((count, 1, 3)),
        shape=np.zeros((count, 1, 33)),
        extent=np.tile(BOX, (count, 1, 1)),
    )
    return replace(observation, **more)


def test_gaps_are_from_the_nearest_face() -> None:
    observation = one_box([[0.5, 0.0, 0.2], [0.5, 0.0, 0.06], [0.4, 0.0, 0.05], [0.5, 0.105, 0.14]])
    gaps = gap_offsets(observation)[:, 0]
    assert gaps[0] == pytest.approx([0, 0, -0.1])  # from 200 mm down to the top at 100 mm
    assert gaps[1] == pytest.approx([0, 0, 0])  # inside
    assert gaps[2] == pytest.approx([0.075, 0, 0])  # the outline is a circle of 25 mm
    assert gaps[3] == pytest.approx([0, -0.08, -0.04])
    above, outside = face_distances(observation)
    assert above[:, 0] == pytest.approx([0.1, -0.04, -0.05, 0.04])
    assert outside[:, 0] == pytest.approx([-0.025, -0.025, 0.075, 0.08])


def test_on_the_board_gaps_lead_to_the_centre() -> None:
    observation = replace(one_box([[0.5, 0.0, 0.2]]), extent=None)
    assert gap_offsets(observation)[0, 0] == pytest.approx([0, 0, -0.15])
    with pytest.raises(ValueError, match="no extents: only boxes have faces"):
        face_distances(observation)


def test_a_box_is_as_large_as_it_looks_without_the_hand() -> None:
    extent = np.tile(BOX, (20, 1, 1))
    extent[10:] *= 0.5  # half hidden by the hand
    observation = one_box([[0.5, 0.0, 0.4], [0.5, 0.0, 0.06]], frames=10, extent=extent)
    radius, half_height = box_size(observation)
    assert radius == pytest.approx([0.025]) and half_height == pytest.approx([0.05])


@given(st.floats(-1e6, 1e6))
def test_no_frame_says_more_than_outliers_allow(ratio: float) -> None:
    value = float(bounded(np.array(ratio)))
    assert abs(value) <= np.log((1 - OUTLIERS) / OUTLIERS) + 1e-9
    assert value * ratio >= 0.0
    assert float(bounded(np.array(-ratio))) == pytest.approx(-value)


@given(st.floats(0.0, 0.4), st.floats(0.001, 0.4))
def test_the_nearer_the_hand_the_more_it_touches(height: float, more: float) -> None:
    near, far = touch_evidence(one_box([[0.5, 0.0, 0.1 + height], [0.5, 0.0, 0.1 + height + more]]))[:, 0]
    assert near >= far


def test_a_hand_in_the_box_touches_and_one_far_off_does_not() -> None:
    inside, far = touch_evidence(one_box([[0.5, 0.0, 0.06], [0.5, 0.0, 0.3]]))[:, 0]
    assert inside > 1.5 and far < -2.5


def test_fingers_feel_what_is_between_them_once_they_have_stopped() -> None:
    opening = np.array([0.1, 0.05, 0.03, 0.03, 0.03, 0.0005, 0.0005, 0.03])
    closed = np.array([0, 1, 1, 1, 1, 1, 1, 0], dtype=bool)
    observation = one_box([[0.5, 0.0, 0.06]], frames=8, gripper_opening=opening, gripper_closed=closed)
    assert np.sign(holding_evidence(observation)).tolist() == [0, 0, 0, 1, 1, 0, -1, 0]
    assert np.flatnonzero(felt(observation)).tolist() == [3, 4]
    assert not np.any(holding_evidence(replace(observation, gripper_opening=None)))


def test_a_hand_on_top_is_above_and_one_at_the_side_beside() -> None:
    top, side = above_evidence(one_box([[0.51, 0.0, 0.105], [0.46, 0.0, 0.05]]))[:, 0]
    assert top > 2.0 and side < -2.0


def test_an_object_that_rests_on_another_is_not_in_the_air() -> None:
    location = np.array([[[0.5, 0.0, 0.05], [0.5, 0.0, 0.15], [0.8, 0.0, 0.2]]] * 6)
    holding = one_box(
        [[0.8, 0.0, 0.2]],
        frames=6,
        location=location,
        extent=np.tile(BOX, (6, 3, 1)),
        object_ids=np.arange(3),
        gripper_closed=np.ones(6, dtype=bool),
        gripper_opening=np.full(6, 0.04),
    )
    raised = raised_evidence(holding)
    assert np.all(raised[:, :2] < -1.0)
    assert np.all(raised[:, 2] > 2.0)


def test_what_no_hand_holds_rests_however_high_it_seems() -> None:
    location = np.tile([0.5, 0.0, 0.12], (6, 1, 1))
    assert np.all(raised_evidence(one_box([[0.5, 0.3, 0.5]], frames=6, location=location)) < -1.0)


def test_forces_are_felt_by_a_hand_that_is_closed_on_nothing() -> None:
    force = np.zeros((30, 3))
    force[:, 2] = -8.0
    force[10:15, 2] = 0.0
    pressing = one_box(
        [[0.5, 0.0, 0.1]],
        frames=30,
        wrist_force=force,
        gripper_opening=np.zeros(30),
        gripper_closed=np.ones(30, dtype=bool),
    )
    evidence = force_evidence(pressing)
    assert np.all(evidence[10:15] > 2.5) and not np.any(np.delete(evidence, range(10, 15)))
    assert not np.any(force_evidence(replace(pressing, gripper_opening=np.full(30, 0.04))))  # holding is no pushing


@pytest.mark.parametrize("place", [0.004, 0.008, 0.012])
def test_noise_is_told_from_tracks_that_move_and_flicker(place: float) -> None:
    noises = [
        float(track_noise(table_demo(np.random.default_rng([s, 3]), "move", 1, Noise(place, 0.0, 0.02, 1.0))[0])[0])
        for s in range(10)
    ]
    assert np.mean(noises) == pytest.approx(place, rel=0.15)  # ten demos of about 150 frames, changes of speed


def test_noisier_tracks_must_move_further() -> None:
    calm, _ = table_demo(np.random.default_rng(1), "hold", noise=NO_NOISE)
    wild, _ = table_demo(np.random.default_rng(1), "hold", noise=Noise(0.02, 0.0, 0.0, 0.0))
    assert track_noise(calm) == pytest.approx([LEAST_NOISE])
    assert moved_distance(calm) == pytest.approx([0.018]) and moved_distance(wild)[0] > 0.03
    assert rest_radius(wild)[0] > rest_radius(calm)[0]
    assert np.mean(at_rest(wild)) > 0.7


@pytest.mark.parametrize("action", ORDERING | TABLETOP)
def test_the_handled_object_is_found_among_others(action: str) -> None:
    for seed in range(8):
        observation, handled = table_demo(np.random.default_rng([seed, 4]), action, things=4)
        assert moved_object(observation) == handled


def test_nothing_handled_is_said() -> None:
    with pytest.raises(PerceptionError, match="no object was handled: .* less than 6 counts as none"):
        moved_object(one_box([[0.5, 0.0, 0.5]], frames=10))


def test_a_held_object_goes_where_the_hand_goes() -> None:
    errors, before = [], []
    for seed in range(5):
        noisy, handled = table_demo(np.random.default_rng([seed, 5]), "move", 1)
        held = felt(noisy)
        in_hand = noisy.location[held, handled] - noisy.gripper_location[held]
        before.append(np.std(in_hand, axis=0).max())
        tied = with_held_object(noisy, handled)
        errors.append(np.std(tied.location[held, handled] - tied.gripper_location[held], axis=0).max())
        assert tied.visible is not None and np.all(tied.visible[held, handled])
        assert np.array_equal(tied.location[~held], noisy.location[~held])
    assert np.mean(errors) < 0.5 * np.mean(before)  # medians of eleven frames, of white noise that is a third


def test_what_was_never_seen_in_the_hand_stays_where_it_was_believed_to_be() -> None:
    noisy, handled = table_demo(np.random.default_rng(6), "move", 1)
    hidden = replace(noisy, visible=np.zeros_like(noisy.location[..., 0], dtype=bool))
    assert with_held_object(hidden, handled) is hidden


def test_what_the_fingers_hide_from_the_moment_they_close_rises_with_them() -> None:
    noisy, handled = table_demo(np.random.default_rng(6), "pick up", 1)
    closing = int(np.flatnonzero(felt(noisy))[0])
    visible = np.ones(noisy.location.shape[:2], dtype=bool)
    visible[closing:, handled] = False
    location = noisy.location.copy()
    location[closing:, handled] = location[closing - 1, handled]  # believed to be where it was last seen
    tied = with_held_object(replace(noisy, visible=visible, location=location), handled)
    rise = noisy.gripper_location[-1, 2] - noisy.gripper_location[closing, 2]
    assert rise > 0.05
    assert tied.location[-1, handled, 2] - tied.location[closing, handled, 2] == pytest.approx(rise, abs=1e-9)
    assert np.median(raised_evidence(tied)[-3:, handled]) > 2.0


def test_a_fall_of_two_centimetres_when_the_fingers_open_is_told_from_none() -> None:
    frames = 20
    closed = np.arange(frames) < 8
    for fall, raised in ((0.022, True), (0.008, False)):  # of looks that are 4 mm noisy each
        height = np.where(closed, 0.05 + fall, 0.05)
        location = np.stack([np.full(frames, 0.5), np.zeros(frames), height], axis=1)[:, None]
        dropped = one_box(
            [[0.5, 0.0, 0.08]],
            frames=frames,
            location=location,
            gripper_closed=closed,
            gripper_opening=np.where(closed, 0.04, 0.08),
        )
        assert np.all((raised_evidence(dropped)[:8, 0] > 0.0) == raised)


@pytest.mark.parametrize("together", [True, False])
def test_closed_fingers_that_feel_no_gap_hold_what_rises_with_them(together: bool) -> None:
    frames, rise = 20, np.linspace(0.0, 0.12, 20)
    tool = np.array([0.5, 0.0, 0.05]) + rise[:, None] * (0.0, 0.0, 1.0)
    track = np.tile([0.5, 0.0, 0.05], (frames, 1, 1))
    if together:
        track[:, 0, 2] += rise
    knife = one_box(
        tool.tolist(), gripper_closed=np.ones(frames, dtype=bool), gripper_opening=np.zeros(frames), location=track
    )
    evidence = holding_evidence(knife)
    assert np.all(evidence > 0.0) if together else np.all(evidence < 0.0)
