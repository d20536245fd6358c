import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from learning.graphs import ActionGraphlet, ActionLibrary, GraphletState, Side
from learning.graphs.action_library import PATIENCE
from learning.graphs.action_statistics import ActionStatistics

values = st.lists(st.lists(st.floats(-5, 5), min_size=3, max_size=3), min_size=1, max_size=12)


def measures(*durations: float) -> list[dict[str, np.ndarray]]:
    return [{"duration": np.array([duration])} for duration in durations]


@given(values)
def test_mean_and_covariance_are_those_of_all_demos(rows: list[list[float]]) -> None:
    statistics = ActionStatistics(1)
    for row in rows:
        statistics.update([{"offset": np.array(row)}])
    known = statistics.states[0]["offset"]
    # Each update rounds the mean to a micrometre.
    assert known.mean == pytest.approx(np.mean(rows, axis=0), abs=1e-5)
    assert known.covariance == pytest.approx(np.cov(np.array(rows).T, bias=True), abs=1e-4)
    assert known.count == statistics.demos == len(rows)


@given(values, values)
def test_learning_goes_on_from_a_file_as_if_it_had_never_stopped(
    first: list[list[float]], more: list[list[float]]
) -> None:
    straight, stopped = ActionStatistics(2), ActionStatistics(2)
    for row in first:
        for statistics in (straight, stopped):
            statistics.update([{"force": np.array(row)}, {"duration": np.array(row[:1])}])
    stopped = ActionStatistics.from_json(json.loads(json.dumps(stopped.to_json())))
    for row in more:
        for statistics in (straight, stopped):
            statistics.update([{}, {"approach": np.array(row)}])
    assert stopped.to_json() == straight.to_json()


def test_what_does_not_apply_is_left_out() -> None:
    statistics = ActionStatistics(2)
    statistics.update([{"opening": np.array([0.05])}, {"clearance": np.array([np.nan])}])
    assert statistics.mean(0, "opening") == pytest.approx([0.05])
    assert statistics.spread(0, "opening") == pytest.approx([0.0])
    assert statistics.mean(1, "clearance") is None and statistics.spread(1, "opening") is None


def test_wrong_measures_are_refused() -> None:
    with pytest.raises(ValueError, match="measures of 1 states for a graphlet of 2"):
        ActionStatistics(2).update([{}])
    with pytest.raises(ValueError, match="measure 'weight' of shape"):
        ActionStatistics(1).update([{"weight": np.zeros(1)}])


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ([1.0, 0.5], "must have 3 numbers, got 2"),
        ([0.0, 0.5, 0.0], "count of measure 'duration' is 0.0, expected 1 or more"),
        ([1.0, 0.5, -1.0], "variances must not be negative"),
        ([1.0, float("nan"), 0.0], "is nan, expected a finite number"),
    ],
)
def test_damaged_files_are_refused(numbers: list[float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        ActionStatistics.from_json({"demos": 1, "states": [{"duration": numbers}]})
    with pytest.raises(ValueError, match="unknown measure 'weight'; known are duration"):
        ActionStatistics.from_json({"demos": 1, "states": [{"weight": [1.0]}]})


PUSH = ActionGraphlet(
    (
        GraphletState(True, False, 0),
        GraphletState(True, True, 0, side=Side.BESIDE),
        GraphletState(True, True, 1, side=Side.BESIDE),
        GraphletState(True, False, 1),
    )
)
LOST = ActionGraphlet(PUSH.states[:1] + (GraphletState(False, False, 0),) + PUSH.states[1:])
HOLD = ActionGraphlet((GraphletState(True, True, 0, raised=True),))
LOWER = ActionGraphlet((*HOLD.states, GraphletState(True, True, 1)))
MOVE = ActionGraphlet(tuple(GraphletState(c, t, at) for c, t, at in [(0, 0, 0), (1, 1, 0), (1, 1, 1), (0, 0, 1)]))


def test_a_short_state_too_many_makes_a_variant_and_the_frequent_one_speaks() -> None:
    library = ActionLibrary()
    assert library.match_or_add(LOST, measures(1, 0.2, 1, 1, 1)) == 1
    assert library[1] == LOST
    for _ in range(2):
        assert library.match_or_add(PUSH, measures(1, 1, 1, 1)) == 1
    assert library[1] == PUSH and library.variants(1) == {LOST: 1, PUSH: 2} and len(library) == 1
    assert library.find(LOST) == 1
    statistics = library.statistics(1)
    assert statistics is not None and statistics.mean(3, "duration") == pytest.approx([1.0])


def test_a_state_that_lasts_makes_another_action() -> None:
    library = ActionLibrary()
    assert library.match_or_add(PUSH, measures(1, 1, 1, 1)) == 1
    assert library.match_or_add(LOST, measures(1, 2.0, 1, 1, 1)) == 2


def test_how_a_demo_begins_and_ends_is_no_flicker() -> None:
    library = ActionLibrary()
    assert library.match_or_add(LOWER, measures(1, 0.2)) == 1
    assert library.match_or_add(HOLD, measures(3)) == 2
    assert library.match_or_add(LOWER, measures(0.2, 1)) == 1


def test_what_stays_rare_becomes_a_variant_of_what_it_is_like() -> None:
    library = ActionLibrary()
    seen_badly = ActionGraphlet((*LOWER.states, GraphletState(True, False, 1)))
    for _ in range(3):
        library.match_or_add(LOWER, measures(1, 1))
    assert library.match_or_add(seen_badly, measures(1, 1, 2)) == 2
    assert library.match_or_add(PUSH, measures(1, 1, 1, 1)) == 3  # like none of them: it stays, however rare
    for _ in range(PATIENCE - 2):
        library.match_or_add(LOWER, measures(1, 1))
    assert len(library) == 3
    library.match_or_add(LOWER, measures(1, 1))
    assert (len(library), library.resolve(2), list(library.numbered)) == (2, 1, [1, 3])
    assert library.find(seen_badly, measures(1, 1, 2)) == 1
    assert library[1] == library[2] == LOWER
    again = ActionLibrary.from_json(json.loads(json.dumps(library.to_json())))
    assert again.to_json() == library.to_json() and again.resolve(2) == 1


def test_what_is_only_looked_at_is_taken_for_the_action_it_is_most_like() -> None:
    library = ActionLibrary()
    seen_badly = ActionGraphlet((*LOWER.states, GraphletState(True, False, 1)))
    for _ in range(2):
        library.match_or_add(LOWER, measures(1, 1))
    before = library.to_json()
    assert library.find(seen_badly, measures(1, 1, 2)) is None
    assert library.find_like(seen_badly, measures(1, 1, 2)) == 1
    assert library.find_like(PUSH, measures(1, 1, 1, 1)) is None  # it has nothing in common with lowering
    assert library.to_json() == before


def test_what_is_shown_again_and_again_stays_an_action_of_its_own() -> None:
    library = ActionLibrary()
    longer = ActionGraphlet((*LOWER.states, GraphletState(True, False, 1)))
    for number in range(4 * PATIENCE):
        library.match_or_add(LOWER if number % (PATIENCE // 2) else longer, measures(1, 1, *[2] * (number % 30 == 0)))
    assert len(library) == 2


def test_without_measures_graphlets_must_match() -> None:
    library = ActionLibrary([PUSH])
    assert library.find(LOST) is None and library.find(PUSH) == 1
    assert library.statistics(1) is None


def test_the_library_is_saved_with_its_statistics() -> None:
    library = ActionLibrary([MOVE])
    library.match_or_add(LOST, measures(1, 0.2, 1, 1, 1))
    library.match_or_add(PUSH, measures(1, 1, 1, 1))
    again = ActionLibrary.from_json(json.loads(json.dumps(library.to_json())))
    assert again.to_json() == library.to_json()
    assert again.numbered == library.numbered and again.variants(2) == library.variants(2)
    assert library.to_json()["known"][0] == MOVE.to_json()  # as before there were statistics


def test_a_library_of_before_statistics_loads() -> None:
    assert ActionLibrary.from_json([[[0, 0, 0], [1, 1, 0]]]).numbered[1].states[1] == GraphletState(True, True, 0)


@pytest.mark.parametrize("data", [{"variants": []}, {"variants": [{"graphlet": [[1, 1, 0]]}]}, {}])
def test_damaged_libraries_are_refused(data: dict[str, object]) -> None:
    with pytest.raises((ValueError, KeyError)):
        ActionLibrary.from_json([data])
