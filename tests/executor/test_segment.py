import numpy as np
import pytest

from executor.errors import ExecutorError
from executor.segment import Segment, ToolLimits

LIMITS = ToolLimits(velocity=0.4, acceleration=1.5, jerk=15.0)
START, END = np.array([0.1, -0.2, 0.05]), np.array([0.3, 0.2, 0.25])


def test_starts_and_ends_at_rest_on_the_points() -> None:
    segment = Segment(START, END, LIMITS)
    for time, point in ((0.0, START), (segment.duration, END)):
        position, velocity, acceleration = segment.at(time)
        np.testing.assert_allclose(position, point, atol=1e-12)
        np.testing.assert_allclose(velocity, 0, atol=1e-9)
        np.testing.assert_allclose(acceleration, 0, atol=1e-9)


def test_stays_on_the_line_and_within_limits() -> None:
    segment = Segment(START, END, LIMITS)
    times = np.linspace(0, segment.duration, 2001)
    samples = [segment.at(float(t)) for t in times]
    along = (END - START) / np.linalg.norm(END - START)
    position = np.array([s[0] for s in samples]) - START
    np.testing.assert_allclose(position, np.outer(position @ along, along), atol=1e-12)
    assert np.linalg.norm([s[1] for s in samples], axis=1).max() <= LIMITS.velocity + 1e-9
    acceleration = np.array([s[2] for s in samples])
    assert np.linalg.norm(acceleration, axis=1).max() <= LIMITS.acceleration + 1e-9
    jerk = np.diff(acceleration, axis=0) / (times[1] - times[0])
    assert np.linalg.norm(jerk, axis=1).max() <= LIMITS.jerk * (1 + 1e-6)


def test_reaches_full_speed_when_there_is_room() -> None:
    segment = Segment(np.zeros(3), np.array([1.0, 0, 0]), LIMITS)
    assert np.linalg.norm(segment.at(segment.duration / 2)[1]) == pytest.approx(LIMITS.velocity)


def test_a_slower_segment_takes_as_many_times_as_long() -> None:
    fast, slow = Segment(START, END, LIMITS), Segment(START, END, LIMITS.scaled(2.0))
    assert slow.duration == pytest.approx(2 * fast.duration)


def test_no_way_at_all_takes_no_time() -> None:
    segment = Segment(START, START, LIMITS)
    assert segment.duration == pytest.approx(0.0)
    np.testing.assert_array_equal(segment.at(1.0)[0], START)


def test_refuses_what_is_not_a_number() -> None:
    with pytest.raises(ExecutorError, match="no motion from"):
        Segment(START, np.array([np.nan, 0, 0]), LIMITS)
