import dataclasses

import numpy as np
import pytest

from learning.evaluation.tracking import TrackingReport, score_tracking
from learning.perception.observation import Observation

TIMES = np.arange(6) / 10
TRUE = np.tile(np.array([[0.4, 0.0, 0.02], [0.4, 0.2, 0.02]]), (6, 1, 1))


def seen(location: np.ndarray, visible: np.ndarray | None = None) -> Observation:
    frames, number = location.shape[:2]
    return Observation(
        times=TIMES, gripper_location=np.zeros((frames, 3)), gripper_closed=np.zeros(frames, dtype=bool),
        object_ids=np.arange(number), location=location, colour=np.zeros((frames, number, 3)),
        shape=np.zeros((frames, number, 33)), visible=visible,
    )  # fmt: skip


def test_a_constant_offset_is_the_error_and_no_switch() -> None:
    score = score_tracking(seen(TRUE + [0.003, 0.0, 0.004]), TIMES, TRUE)
    assert score.errors == pytest.approx(np.full(12, 0.005))
    assert (score.switches, score.found, score.extra, score.occluded) == (0, 2, 0, False)


def test_tracks_that_change_places_are_two_switches() -> None:
    swapped = TRUE.copy()
    swapped[3:] = swapped[3:, ::-1]
    assert score_tracking(seen(swapped), TIMES, TRUE).switches == 2


def test_what_is_not_seen_is_counted_apart() -> None:
    location, visible = TRUE.copy(), np.ones((6, 2), dtype=bool)
    location[2:4, 0, 0] += 0.3
    visible[2:4, 0] = False
    score = score_tracking(seen(location, visible), TIMES, TRUE)
    assert score.errors.max() == 0.0
    assert score.hidden_errors == pytest.approx([0.3, 0.3])
    assert score.occluded and score.switches == 0


def test_lost_objects_and_tracks_of_nothing_are_counted() -> None:
    location = TRUE.copy()
    location[:, 1] = 5.0
    score = score_tracking(seen(location), TIMES, TRUE)
    assert (score.found, score.extra) == (1, 1)
    empty = score_tracking(seen(np.zeros((6, 0, 3))), TIMES, TRUE)
    assert (empty.found, empty.extra, len(empty.errors)) == (0, 0, 0)


def test_a_report_over_demos() -> None:
    good = score_tracking(seen(TRUE + [0.0, 0.0, 0.002]), TIMES, TRUE)
    bad = dataclasses.replace(good, switches=3, occluded=True)
    figures = TrackingReport([good, bad], [("x.mcap", "broken")], 0).figures()
    assert figures["median_error_mm"] == pytest.approx(2.0)
    assert (figures["without_switch"], figures["occluded.without_switch"]) == (0.5, 0.0)
    assert TrackingReport([], [], 0).figures()["median_error_mm"] is None
