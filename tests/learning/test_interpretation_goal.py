"""A goal is told in one line."""

import numpy as np

from learning.graphs import ActionGraphlet, GraphletState
from learning.interpretation.interpretation import Goal


def test_a_goal_is_printed_in_one_line_with_where_it_is() -> None:
    action = ActionGraphlet((GraphletState(False, True, 0), GraphletState(True, True, 1)))
    placed, kept = Goal(4, np.array([0.65, -0.14, 0.06]), action), Goal(4, None, action)
    assert str(placed) == f"object 4 to (0.650, -0.140, 0.060) m by {action}"
    assert str(kept) == f"object 4 by {action}"
    for goal in (placed, kept):
        assert len(repr(goal)) < 100 and "\n" not in repr(goal)
