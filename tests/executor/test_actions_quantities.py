"""What demos measured becomes the amounts of a motion."""

import numpy as np
import pytest

from executor.actions.quantities import FORCE, LOWEST_RISE, RISE, Quantities, least_travel, quantities_of
from learning.graphs import ActionGraphlet, GraphletState, Side
from learning.graphs.action_statistics import ActionStatistics
from robots.pose import FloatArray


def values(**measures: float | list[float]) -> dict[str, FloatArray]:
    return {name: np.atleast_1d(np.array(value, dtype=float)) for name, value in measures.items()}


PRESS = ActionGraphlet(
    (
        GraphletState(True, False, 0),
        GraphletState(True, True, 0, side=Side.ABOVE),
        GraphletState(True, False, 0),
    )
)
LIFT = ActionGraphlet((GraphletState(True, True, 0), GraphletState(True, True, 1, raised=True)))
PUSH = ActionGraphlet(
    (
        GraphletState(True, False, 0),
        GraphletState(True, True, 0, side=Side.BESIDE),
        GraphletState(True, True, 1, side=Side.BESIDE),
    )
)


def test_means_over_demos_are_taken() -> None:
    statistics = ActionStatistics(3)
    for force, seconds in ((4.0, 1.0), (6.0, 2.0)):
        rest = values(duration=0.5, force=[0.0, 0.0, -8.0])
        statistics.update([rest, values(duration=seconds, force=[0.0, 0.0, -8.0 + force]), rest])
    found = quantities_of(PRESS, statistics)
    assert found.force_from(Side.ABOVE) == pytest.approx(5.0)
    assert found.duration_of(1) == pytest.approx(1.5)


def test_heights_and_ways_are_those_shown() -> None:
    lifted, pushed = ActionStatistics(2), ActionStatistics(3)
    lifted.update([values(duration=1.0), values(clearance=0.13)])
    assert quantities_of(LIFT, lifted).rise == pytest.approx(0.13)
    pushed.update([{}, {}, values(travel=0.065)])
    assert quantities_of(PUSH, pushed).shift == pytest.approx(0.065)


def test_a_lift_that_ended_by_lowering_was_higher_before() -> None:
    """The end of such a state shows the object nearly down again: it tells how far it was raised at least."""
    carry = ActionGraphlet((*LIFT.states, GraphletState(True, True, 2)))
    statistics = ActionStatistics(3)
    statistics.update([{}, values(clearance=0.02), {}])
    assert quantities_of(carry, statistics).rise == RISE


def test_what_nobody_showed_is_usual() -> None:
    assert quantities_of(LIFT, None) == Quantities()
    assert Quantities().force_from(Side.ABOVE) == FORCE
    low = ActionStatistics(2)
    low.update([{}, values(clearance=0.001)])
    assert quantities_of(LIFT, low).rise == LOWEST_RISE


def test_things_are_brought_as_far_as_they_seldom_are_less() -> None:
    statistics = ActionStatistics(3)
    rest = values(duration=0.5)
    for way in (0.2, 0.2, 0.3, 0.3):
        statistics.update([rest, values(travel=0.05), values(travel=way)])
    assert least_travel(statistics) == pytest.approx(0.25 - 1.5 * 0.05, abs=0.005)  # of the state that came last
    wide = ActionStatistics(3)
    for way in (0.02, 0.5):
        wide.update([rest, rest, values(travel=way)])
    assert least_travel(wide) == 0.0
    assert least_travel(None) == least_travel(ActionStatistics(2)) == 0.0
