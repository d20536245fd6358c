"""From graphlets to primitives: each change of state is the motion that makes it, whatever the action is called."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from executor.actions.action_plan import LEAST_LIFT, plan_action
from executor.actions.primitives import (
    Carry,
    Close,
    Lift,
    Lower,
    Primitive,
    Push,
    Reach,
    Release,
    Retreat,
    Shape,
    Stay,
    Touch,
)
from executor.actions.quantities import Quantities
from executor.errors import RefusalError
from learning.graphs import ActionGraphlet, GraphletState, Side

AMOUNTS = Quantities(rise=0.12, shift=0.07, force={Side.ABOVE: 5.0, Side.BESIDE: 2.0}, durations={0: 3.0, 1: 1.5})


def state(text: str) -> GraphletState:
    """`C touch raised 1` and the like."""
    words = text.split()
    side = next((each for each in Side if each.name.lower() in words), None)
    return GraphletState(words[0] == "C", "touch" in words, int(words[-1]), "raised" in words, side)


def graphlet(*texts: str) -> ActionGraphlet:
    return ActionGraphlet.of(state(text) for text in texts)


HELD: tuple[Primitive, ...] = (Reach(0.12), Close())
CASES: dict[str, tuple[ActionGraphlet, tuple[Primitive, ...], tuple[Primitive, ...]]] = {
    "closes on it": (
        graphlet("O apart 0", "O touch 0", "C touch 0"),
        (Shape(False),),
        (Reach(LEAST_LIFT), Close()),
    ),
    "raises it": (graphlet("C touch 0", "C touch raised 1"), HELD, (Lift(0.12),)),
    "keeps it": (graphlet("C touch raised 0"), (*HELD, Lift(0.12)), (Stay(3.0),)),
    "brings it down": (graphlet("C touch raised 0", "C touch 1"), (*HELD, Lift(0.12)), (Carry(), Lower())),
    "lets it fall": (graphlet("C touch raised 0", "O apart 1"), (*HELD, Lift(0.12)), (Release(), Retreat())),
    "leans on it": (
        graphlet("C apart 0", "C touch above 0", "C apart 0"),
        (Shape(True),),
        (Touch(Side.ABOVE, 5.0), Stay(1.5), Retreat()),
    ),
    "shoves it": (
        graphlet("C apart 0", "C touch beside 0", "C touch beside 1", "C apart 1"),
        (Shape(True),),
        (Touch(Side.BESIDE, 2.0, 0.07), Push(0.07), Retreat()),
    ),
    "shoves it at once": (
        graphlet("C apart 0", "C touch beside 1"),
        (Shape(True),),
        (Touch(Side.BESIDE, 2.0, 0.07), Push(0.07)),
    ),
    "takes it elsewhere, seen by a camera": (
        graphlet("O apart 0", "O touch 0", "C touch 0", "C touch raised 1", "C touch 2", "O touch 2", "O apart 2"),
        (Shape(False),),
        (Reach(0.12), Close(), Lift(0.12), Carry(), Lower(), Release(), Retreat()),
    ),
    "takes it elsewhere, on the board": (
        graphlet("O apart 0", "O touch 0", "C touch 0", "C touch 1", "O touch 1", "O apart 1"),
        (Shape(False),),
        (Reach(0.12), Close(), Lift(0.12), Carry(), Lower(), Release(), Retreat()),
    ),
    "takes it up, on the board": (
        graphlet("O apart 0", "O touch 0", "C touch 0", "C touch 1"),
        (Shape(False),),
        (Reach(0.12), Close(), Lift(0.12)),
    ),
    "puts it somewhere, on the board": (
        graphlet("C touch 0", "C touch 1", "O touch 1", "O apart 1"),
        (*HELD, Lift(0.12)),
        (Carry(), Lower(), Release(), Retreat()),
    ),
}


@pytest.mark.parametrize("case", list(CASES))
def test_each_change_is_the_motion_that_makes_it(case: str) -> None:
    shown, before, steps = CASES[case]
    plan = plan_action(shown, AMOUNTS)
    assert plan.before == before
    assert plan.steps == steps
    assert plan.starts_held == shown.states[0].holds
    assert plan.sets_down == (Lower() in steps)


def test_what_no_hand_can_do_is_refused() -> None:
    with pytest.raises(RefusalError, match="a hand that is closed on nothing raises nothing"):
        plan_action(ActionGraphlet((state("C apart 0"), GraphletState(True, True, 0, True, Side.ABOVE))), AMOUNTS)
    with pytest.raises(RefusalError, match="from holding to .* in one change"):
        plan_action(graphlet("C touch 0", "C touch above 0"), AMOUNTS)


STATES = st.builds(
    GraphletState,
    st.booleans(),
    st.booleans(),
    st.integers(0, 2),
    st.booleans(),
    st.sampled_from([None, Side.ABOVE, Side.BESIDE]),
)


@given(st.lists(STATES, min_size=1, max_size=6))
def test_any_sequence_of_states_is_planned_or_refused(states: list[GraphletState]) -> None:
    """Flicker of perception may give strange graphlets; none of them is an error of the planner."""
    try:
        plan = plan_action(ActionGraphlet.of(states), AMOUNTS)
    except RefusalError:
        return
    done = [*plan.before, *plan.steps]
    for number, step in enumerate(done):
        if isinstance(step, Close):  # fingers close on an object only after the hand has come around it
            assert any(isinstance(each, Reach) for each in done[:number])
        if isinstance(step, Push):
            assert any(isinstance(each, Touch) for each in done[:number])
