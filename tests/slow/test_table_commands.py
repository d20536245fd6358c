"""Commands that Baxter and the Mico carry out at a table, with all that leads to them."""

from pathlib import Path

import pytest

from executor.tables.exam import TableTrial, answers
from executor.tables.learned import from_table_collection


@pytest.mark.slow
@pytest.mark.parametrize("robot", ["baxter", "mico_segway"])
def test_new_commands_are_carried_out_after_the_scripted_collection(robot: str, tmp_path: Path) -> None:
    learned = from_table_collection(robot, tmp_path, None, 0, 0, lambda: None)
    trials = [TableTrial(robot, str(learned.path), 1, number, "en", learned.heard) for number in range(30)]
    done = answers(trials)
    assert sum(bool(each.right) for each in done) >= 0.85 * len(done), [each.verdict().to_dict() for each in done]
    trusted = [each for each in done if each.report.success]
    assert sum(not each.right for each in trusted) <= 0.1 * len(trusted)
