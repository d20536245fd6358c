"""The plan follows the graphlet: another graphlet gives another plan."""

import numpy as np
import pytest

from executor.errors import RefusalError
from executor.motion_plan import MotionPlan, MoveGripper, MoveTool
from executor.planner import CLEARANCE, plan_motion
from executor.sight import Sight
from learning.graphs import ActionGraphlet, GraphletState
from twin import board

State = GraphletState
APART, TOUCH, GRIP, CARRIED = State(False, False, 0), State(False, True, 0), State(True, True, 0), State(True, True, 1)
PUT, LEFT = State(False, True, 1), State(False, False, 1)
TAKE = ActionGraphlet((APART, TOUCH, GRIP, CARRIED))
DROP = ActionGraphlet((GRIP, CARRIED, PUT, LEFT))
MOVE = ActionGraphlet((APART, TOUCH, GRIP, CARRIED, PUT, LEFT))
GOAL = board.cell_centre(5, 2, 0)


def sight(held: bool = False, tower: int = 0) -> Sight:
    """Block 0 in cell (2, 2), or in the gripper, and a tower of blocks 1.. in cell (4, 2) on the way to the goal."""
    tool = np.array([0.1, 0.3, 0.3])
    first = tool if held else board.cell_centre(2, 2, 0)
    blocks = np.array([first, *(board.cell_centre(4, 2, level) for level in range(tower))])
    return Sight(np.arange(len(blocks)), blocks, tool, held, 0 if held else None)


def plan(action: ActionGraphlet, goal: np.ndarray | None = GOAL, held: bool = False, tower: int = 0) -> MotionPlan:
    return plan_motion(0, goal, action, sight(held, tower), board.BLOCK)


def words(made: MotionPlan) -> list[str]:
    """Purposes without repetition, gripper moves as open and close."""
    found: list[str] = []
    for step in made.steps:
        word = step.purpose if isinstance(step, MoveTool) else "close" if step.closed else "open"
        if not found or found[-1] != word:
            found.append(word)
    return found


def test_take_closes_and_never_lets_go() -> None:
    made = plan(TAKE, goal=None)
    assert words(made) == ["approach", "descend", "close", "lift"]
    assert made.ends_closed is True


def test_drop_starts_with_what_is_held() -> None:
    assert words(plan(DROP, held=True)) in (
        ["lift", "carry", "lower", "open", "retreat"],
        ["carry", "lower", "open", "retreat"],
    )


def test_move_does_both() -> None:
    made = plan(MOVE)
    assert words(made) == ["approach", "descend", "close", "lift", "carry", "lower", "open", "retreat"]
    assert made.ends_closed is False


def test_move_of_what_is_held_already_leaves_out_the_approach() -> None:
    assert words(plan(MOVE, held=True)) == words(plan(DROP, held=True))


def test_another_graphlet_gives_another_plan() -> None:
    """Lift and put back: a graphlet that no demo on the board shows."""
    lift_and_return = ActionGraphlet((APART, TOUCH, GRIP, CARRIED, GRIP, TOUCH, APART))
    made = plan(lift_and_return, goal=None)
    assert words(made) == ["approach", "descend", "close", "lift", "lower", "open", "retreat"]
    lowered = next(s for s in made.steps if isinstance(s, MoveTool) and s.purpose == "lower")
    np.testing.assert_allclose(lowered.position, board.cell_centre(2, 2, 0), atol=0.002)


def test_grip_is_at_the_block_and_release_at_the_goal() -> None:
    made = plan(MOVE)
    by_purpose = {step.purpose: step.position for step in made.steps if isinstance(step, MoveTool)}
    np.testing.assert_allclose(by_purpose["descend"], board.cell_centre(2, 2, 0), atol=1e-9)
    np.testing.assert_allclose(by_purpose["lower"][:2], GOAL[:2], atol=1e-9)
    assert 0 <= by_purpose["lower"][2] - GOAL[2] <= 0.002  # let go just above the board, never pressed into it


@pytest.mark.parametrize("tower", [1, 4, 8])
def test_a_carried_block_passes_over_the_tower_on_the_way(tower: int) -> None:
    made = plan(MOVE, tower=tower)
    top = tower * board.BLOCK
    carried = [s.position[2] for s in made.steps if isinstance(s, MoveTool) and s.purpose == "carry"]
    assert min(carried) - board.BLOCK / 2 >= top + CLEARANCE - 1e-9


def test_every_crossing_is_level() -> None:
    """The tool changes its height straight up and down only, so that fingers do not sweep sideways past towers."""
    made = plan(MOVE, tower=3)
    here = sight().tool
    for step in made.steps:
        if isinstance(step, MoveTool):
            way = np.abs(step.position - here)
            assert way[2] < 1e-9 or way[:2].max() < 1e-9
            here = step.position


def test_steps_tell_which_state_asked_for_them() -> None:
    made = plan(MOVE)
    states = [step.state for step in made.steps]
    assert states == sorted(states)
    assert [step.state for step in made.steps if isinstance(step, MoveGripper)] == [2, 4]


@pytest.mark.parametrize(
    ("action", "goal", "held", "reason"),
    [
        (DROP, GOAL, False, "the robot holds nothing"),
        (MOVE, None, False, "no place for it was understood"),
        (ActionGraphlet((APART, TOUCH, State(False, True, 1))), GOAL, False, "without holding it"),
        (ActionGraphlet((APART, GRIP, CARRIED)), GOAL, False, "with a closed gripper"),
    ],
)
def test_what_the_arm_cannot_do_is_refused(
    action: ActionGraphlet, goal: np.ndarray | None, held: bool, reason: str
) -> None:
    with pytest.raises(RefusalError, match=reason):
        plan(action, goal, held)


def test_another_block_in_the_gripper_is_refused() -> None:
    seen = sight(tower=1)
    full = Sight(seen.object_ids, seen.location, seen.tool, True, 1)
    with pytest.raises(RefusalError, match="holds another block"):
        plan_motion(0, GOAL, MOVE, full, board.BLOCK)
