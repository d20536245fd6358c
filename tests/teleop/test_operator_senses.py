import numpy as np
import pytest

from robots.pose import Pose
from teleop.clearance import BELOW_TOOL, ROOM, carry_height
from teleop.gamepad_mapping import GamepadMapping
from teleop.operator_eyes import LAG, Eyes
from teleop.operator_hand import Hand
from twin import ObjectState, WorldState
from twin.board import BLOCK, cell_centre

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
FRAME = 1 / 60


def state_at(time: float, tool: np.ndarray, *objects: np.ndarray) -> WorldState:
    things = tuple(ObjectState(number, Pose(where, LEVEL)) for number, where in enumerate(objects))
    return WorldState(time, np.zeros(3), np.zeros(3), 0.048, False, Pose(tool, LEVEL), things, None)


def test_a_jump_is_seen_a_reaction_time_later() -> None:
    eyes, block = Eyes(np.random.default_rng(0)), np.array([0.2, 0.2, 0.02])
    eyes.look(state_at(0.0, np.zeros(3), block))
    eyes.watch(0)
    frames = 0
    while abs(eyes.block()[0] - 0.3) > 0.01:
        frames += 1
        eyes.look(state_at(frames * FRAME, np.zeros(3), block + [0.1, 0.0, 0.0]))
    assert LAG <= frames * FRAME <= LAG + 2 * FRAME


def test_knowing_ones_own_motion_bridges_the_lag() -> None:
    eyes, velocity = Eyes(np.random.default_rng(0)), np.array([0.3, 0.0, 0.0])
    for frame in range(60):
        if frame:
            eyes.moved(velocity * FRAME)
        eyes.look(state_at(frame * FRAME, velocity * frame * FRAME))
    # Late eyes alone would be 36 mm behind; what is left is noise, filtered from 1 mm.
    assert abs(eyes.tool[0] - velocity[0] * 59 * FRAME) < 0.0015


def test_what_is_seen_corrects_what_was_expected() -> None:
    eyes = Eyes(np.random.default_rng(0))
    for frame in range(90):
        if 0 < frame < 30:
            eyes.moved(np.array([0.0, 0.0, -0.05 * FRAME]))
        eyes.look(state_at(frame * FRAME, np.zeros(3)))  # blocked: the tool stands still
        if frame == 29:
            assert eyes.tool[2] < -0.003
        assert abs(eyes.seen_tool[2]) < 0.005  # five standard deviations of a look
    assert abs(eyes.tool[2]) < 0.0015


def test_thumbs_are_smooth_imprecise_and_lie_still_at_rest() -> None:
    mapping, wish = GamepadMapping(), np.array([0.2, -0.1, 0.15])
    hand = Hand(mapping, np.random.default_rng(0))
    pads = [hand.act(np.zeros(3), FRAME)]
    assert pads[0].axes == (0.0,) * 4
    pads += [hand.act(wish, FRAME) for _ in range(120)]
    got = np.array([mapping.command(pad).twist[:3] for pad in pads])
    assert not any(pad.fault() for pad in pads)
    assert np.abs(got[1]).max() < 0.5 * np.abs(wish).max()  # a thumb needs time
    np.testing.assert_allclose(got[30:].mean(axis=0), wish, rtol=0.15)  # right on average
    assert (got[30:].std(axis=0) > 0.01 * np.abs(wish)).all()  # but never quite


def test_diagonal_wishes_stay_in_the_sticks_round_gate() -> None:
    hand = Hand(GamepadMapping(), np.random.default_rng(0))
    for _ in range(60):
        pad = hand.act(np.array([0.3, 0.3, 0.0]), FRAME)
        assert np.hypot(*pad.axes[:2]) <= 1.0 + 1e-12


@pytest.mark.parametrize(
    ("cell", "counts"),
    [((3, 3, 4), True), ((3, 4, 4), True), ((3, 6, 4), False), ((7, 7, 4), False)],
)
def test_carry_height_clears_what_is_on_or_beside_the_way(cell: tuple[int, int, int], counts: bool) -> None:
    start, end = cell_centre(1, 3, 0), cell_centre(5, 3, 0)
    state = state_at(0.0, start, start, cell_centre(*cell))
    expected = cell_centre(*cell)[2] + BLOCK / 2 if counts else 0.0
    assert carry_height(state, start, end, moved=0) == pytest.approx(expected + BELOW_TOOL + ROOM)
