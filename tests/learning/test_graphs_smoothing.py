import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.graphs.smoothing import constant_runs, lasting, smoothed, without_short_rows

values = st.lists(st.integers(0, 3), min_size=1, max_size=30).map(lambda entries: np.array(entries))


@pytest.mark.parametrize(
    ("noisy", "clean"),
    [
        ("0001000", "0000000"),
        ("0001011", "0000011"),
        ("0011100", "0011100"),
        ("1000111", "0000111"),
        ("0000001", "0000000"),
        ("01", "01"),
    ],
)
def test_what_does_not_last_is_noise(noisy: str, clean: str) -> None:
    assert "".join(map(str, lasting(np.array([int(c) for c in noisy]), 2))) == clean


@given(values, st.integers(1, 4))
def test_runs_cover_everything_and_what_lasts_lasts(entries: np.ndarray, shortest: int) -> None:
    runs = list(constant_runs(entries))
    assert [start for start, _ in runs][1:] == [stop for _, stop in runs][:-1]
    assert (runs[0][0], runs[-1][1]) == (0, len(entries))
    kept = lasting(entries, shortest)
    if any(stop - start >= shortest for start, stop in runs):
        assert all(stop - start >= shortest for start, stop in constant_runs(kept))
    assert np.array_equal(lasting(entries, 1), entries)


def test_short_combinations_in_the_middle_are_dropped() -> None:
    rows = np.array([[0, 0], [1, 0], [1, 1], [1, 1], [0, 1]])
    assert without_short_rows(rows, 2).tolist() == [[0, 0], [1, 1], [1, 1], [0, 1]]


def test_the_median_takes_out_a_spike_and_leaves_a_jump() -> None:
    track = np.array([0.0, 0.0, 9.0, 0.0, 0.0, 5.0, 5.0])[:, None]
    assert smoothed(track)[:, 0].tolist() == [0, 0, 0, 0, 0, 5, 5]
    assert smoothed(track[:2])[:, 0].tolist() == [0, 0]
