"""Two hundred picks of every robot over all its objects, by friction alone."""

import pytest

from executor.bench import grasp

PICKS = 200
LEAST = 0.97


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["three_dof", "baxter", "mico_segway"])
def test_two_hundred_objects_are_picked_carried_and_placed(robot: str) -> None:
    report = grasp.run(0, PICKS, [robot], jobs=1)
    assert report.figures[f"{robot}.picks"] == PICKS
    assert report.figures[f"{robot}.objects"] == len(grasp.objects_of(robot))
    success = report.figures[f"{robot}.success"]
    assert success is not None and success >= LEAST, report.notes
