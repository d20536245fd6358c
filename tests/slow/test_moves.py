"""A thousand random moves of every robot: no limit is left, nothing is touched, the twin is where the plan is."""

import pytest

from executor.bench import moves

COUNT = 1000


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["three_dof", "baxter", "mico_segway"])
def test_a_thousand_moves_stay_inside_every_limit_and_touch_nothing(robot: str) -> None:
    # One process: the tests themselves are spread over the cores.
    figures = moves.run(0, COUNT, [robot], jobs=1).figures
    assert figures[f"{robot}.moves"] == COUNT
    for name in ("violations", "touches"):
        assert figures[f"{robot}.{name}"] == 0, figures
    off = figures[f"{robot}.farthest_from_trajectory_mrad"]
    assert off is not None and off < 5  # measured in a hundred: 0.04, of the Mico's light wrist 1.8
    part = figures[f"{robot}.largest_part_of_a_limit"]
    assert part is not None and part <= 1 + moves.ROUNDING
    if robot == "mico_segway":
        base = figures[f"{robot}.base_worst_off_mm"]
        assert base is not None and base < 10
