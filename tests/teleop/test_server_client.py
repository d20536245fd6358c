import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.server_client import DRIFT, Allowance, Lateness


def test_an_allowance_runs_out_and_fills_with_time() -> None:
    allowance = Allowance(rate=100.0, burst=50.0)
    start = allowance._at
    assert sum(allowance.take(start) for _ in range(80)) == 50
    assert not allowance.take(start + 0.005)
    assert sum(allowance.take(start + 0.105) for _ in range(80)) == 10
    assert sum(allowance.take(start + 100.0) for _ in range(80)) == 50  # no more than the burst, however long the pause


def test_lateness_is_what_a_message_took_longer_than_the_fastest() -> None:
    lateness = Lateness()
    assert lateness.of(1_000_000.0, 5.003) == 0.0  # clocks of different origin
    assert lateness.of(1_000_000.1, 5.100) == 0.0
    # Held back for 0.3 s by a frozen page or a stalled network; within how far the estimate may drift in 0.4 s.
    assert lateness.of(1_000_000.2, 5.500) == pytest.approx(0.3, abs=DRIFT)
    assert lateness.of(1_000_000.5, 5.502) == pytest.approx(0.002, abs=DRIFT)


@given(st.lists(st.tuples(st.floats(0.0, 0.2), st.floats(0.001, 0.1)), min_size=1, max_size=50), st.floats(-1e9, 1e9))
def test_lateness_is_never_negative_and_never_more_than_the_delay(
    steps: list[tuple[float, float]], offset: float
) -> None:
    lateness, now = Lateness(), 100.0
    for delay, gap in steps:
        now += gap
        assert 0.0 <= lateness.of(now + offset, now + delay) <= delay + 1e-6  # the clocks are told as floats near 1e9
