"""How a thing is put somewhere else by what was learned."""

import pytest

from executor.actions.carrying import carrying_action
from executor.errors import RefusalError
from learning import Knowledge
from learning.graphs import ActionGraphlet, GraphletState
from tests.executor.graphlets import APART, CARRIED, GRIP, LEFT, MOVE, PICK_UP, PUT, TOUCH

RAISED = GraphletState(True, True, 0, raised=True)
TAKE, LET_GO = ActionGraphlet((APART, TOUCH, GRIP)), ActionGraphlet((GRIP, TOUCH, APART))
LIFT = ActionGraphlet((GRIP, GraphletState(True, True, 1, raised=True)))
SET_DOWN = ActionGraphlet((RAISED, CARRIED, PUT, LEFT))
DROP = ActionGraphlet((RAISED, GraphletState(False, True, 0, raised=True), PUT, LEFT))
PUSH = ActionGraphlet((GraphletState(True, False, 0), GraphletState(True, False, 1)))


def knowing(*actions: ActionGraphlet) -> Knowledge:
    knowledge = Knowledge("table")
    for each in actions:
        knowledge.spaces.actions.match_or_add(each)
    return knowledge


def test_one_action_that_was_learned_is_taken_before_two() -> None:
    knowledge = knowing(TAKE, LET_GO, MOVE)
    number, action = carrying_action(knowledge)
    assert action == MOVE == knowledge.spaces.actions[number]


@pytest.mark.parametrize(
    ("actions", "taking", "expected"),
    [
        ((LET_GO, TAKE), TAKE, MOVE),  # let go of on the ground: carried elsewhere in between
        ((SET_DOWN, PICK_UP), PICK_UP, PICK_UP.followed_by(SET_DOWN)),
        ((DROP, PUSH, LIFT, LET_GO, TAKE), TAKE, MOVE),  # what is dropped is not put anywhere
    ],
)
def test_taking_and_putting_down_make_one_up(
    actions: tuple[ActionGraphlet, ...], taking: ActionGraphlet, expected: ActionGraphlet
) -> None:
    knowledge = knowing(*actions)
    number, action = carrying_action(knowledge)
    assert action == expected
    assert knowledge.spaces.actions[number] == taking


@pytest.mark.parametrize("actions", [(), (TAKE,), (LET_GO, PUSH), (PICK_UP, LET_GO), (TAKE, DROP)])
def test_without_both_there_is_none(actions: tuple[ActionGraphlet, ...]) -> None:
    with pytest.raises(RefusalError, match="no action was learned that puts a thing somewhere else"):
        carrying_action(knowing(*actions))
