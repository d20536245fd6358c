import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.drive_command import MAX_AGE
from teleop.input_age import InputAge

DT = 1.0 / 240.0


def test_age_is_that_of_the_clock_where_the_simulation_is_slower() -> None:
    ages = InputAge(DT)
    assert ages.of(10.0, 10.002) == (pytest.approx(0.002), True)
    assert ages.of(10.0, 10.050) == (pytest.approx(0.050), False)
    assert ages.of(10.060, 10.061) == (pytest.approx(0.001), True)


def test_age_is_simulated_where_the_simulation_is_faster() -> None:
    ages = InputAge(DT)
    found = [ages.of(10.0, 10.0) for _ in range(25)]
    assert [arrived for _, arrived in found] == [True] + [False] * 24
    assert found[24][0] == pytest.approx(24 * DT)
    lost = [ages.is_lost(age) for age, _ in found]
    assert lost == [False] * 24 + [True]  # braking begins when the step at 100 ms begins


def test_a_clock_that_jumps_back_makes_no_input_younger_than_new() -> None:
    ages = InputAge(DT)
    ages.of(10.0, 10.0)
    assert ages.of(10.0, 3.0) == (pytest.approx(DT), False)
    assert ages.is_lost(float("nan"))


@given(st.lists(st.tuples(st.floats(0.0, 0.03), st.booleans()), max_size=60))
def test_whatever_the_clock_does_no_input_is_followed_for_longer_than_allowed(steps: list[tuple[float, bool]]) -> None:
    ages, now, stamp, since = InputAge(DT), 5.0, 5.0, 0
    for passed, news in steps:
        now += passed
        if news:
            stamp = now
        age, arrived = ages.of(stamp, now)
        since = 0 if arrived else since + 1
        if not ages.is_lost(age):
            assert since * DT < MAX_AGE
            assert now - stamp < MAX_AGE
