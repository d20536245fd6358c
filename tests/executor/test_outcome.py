import numpy as np
import pytest

from executor.outcome import judge
from executor.sight import Sight
from learning.perception.observation import Observation
from twin import board

PLACES = np.array([board.cell_centre(1, 1, 0), board.cell_centre(4, 4, 0)])
GOAL = board.cell_centre(6, 2, 0)


def sight(*places: np.ndarray, tool: tuple[float, float, float] = (0, 0, 0.5), closed: bool = False) -> Sight:
    frames = 6
    return Sight.of(
        Observation(
            times=np.arange(frames) / 10,
            gripper_location=np.tile(tool, (frames, 1)),
            gripper_closed=np.full(frames, closed),
            object_ids=np.array([7, 9]),
            location=np.tile(np.array(places), (frames, 1, 1)),
            colour=np.zeros((frames, 2, 3)),
            shape=np.zeros((frames, 2, 33)),
        )
    )


BEFORE = sight(*PLACES)


def test_half_a_cell_is_the_limit() -> None:
    for offset, reached in ((0.024, True), (0.026, False)):
        outcome = judge(7, GOAL, BEFORE, sight(GOAL + [offset, 0, 0], PLACES[1]))
        assert outcome.reached is reached
        assert outcome.error == pytest.approx(offset)


def test_the_wrong_level_is_the_wrong_place() -> None:
    outcome = judge(7, GOAL, BEFORE, sight(GOAL + [0, 0, board.BLOCK], PLACES[1]))
    assert not outcome.reached and "38 mm from where it should be" in outcome.explanation


def test_another_block_that_moved_spoils_it() -> None:
    moved = judge(7, GOAL, BEFORE, sight(GOAL, PLACES[1] + [0.03, 0, 0]))
    assert moved.reached and moved.disturbed == (9,) and not moved.right
    assert "1 other block moved as well" in moved.explanation
    nudged = judge(7, GOAL, BEFORE, sight(GOAL, PLACES[1] + [0.012, 0, 0]))
    assert nudged.right and "pushed by 12 mm" in nudged.explanation


def test_held_is_seen_at_the_closed_gripper() -> None:
    up = np.array([0.1, 0.1, 0.3])
    held = sight(up, PLACES[1], tool=tuple(up), closed=True)
    assert held.held == 7
    assert judge(7, None, BEFORE, held).right
    assert not judge(7, up, BEFORE, held).reached  # at the place, but not let go
    assert sight(up, PLACES[1], tool=tuple(up), closed=False).held is None
    assert not judge(7, None, BEFORE, sight(up, PLACES[1])).reached


def test_an_unknown_track_is_a_key_error() -> None:
    with pytest.raises(KeyError, match="3"):
        BEFORE.where(3)
