"""From an action graphlet to motion primitives: what changes between two states is what the hand has to do.

==========================================  =================================================
apart -> touching with an open hand         reach around the object
open -> closed while touching               close the fingers on it
apart -> touching with a hand that is shut  touch it from the side that was learned
on the ground -> raised, held               lift by the learned height
raised -> on the ground, held               carry above the destination, if any, and lower
another place, raised and held              carry
another place, touched from outside         push on by the learned way
closed -> open, held                        let go
touching -> apart                           draw back
no change at all                            stay for the learned time
==========================================  =================================================

Nothing here knows an action by name. On the board nothing is ever seen as raised: there a held object's new place
stands for lifting, and for carrying and lowering too where it is let go of later.
"""

from collections.abc import Iterator
from dataclasses import dataclass

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
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.graphlet_state import GraphletState

LEAST_LIFT = 0.02
"""How far [m] it must be possible to lift what is gripped, even where nothing will be: the hand must get away."""


@dataclass(frozen=True, slots=True)
class ActionPlan:
    """What an arm does for an action.

    Attributes:
        before: What brings the world to the action's first state.
        steps: The action itself.
        starts_held: Whether the object is in the hand at the start.
        sets_down: Whether a held object comes to rest: only then does a destination mean anything.
    """

    before: tuple[Primitive, ...]
    steps: tuple[Primitive, ...]
    starts_held: bool
    sets_down: bool


def plan_action(graphlet: ActionGraphlet, quantities: Quantities) -> ActionPlan:
    """Turn a graphlet into primitives.

    Args:
        graphlet: The action.
        quantities: How much of each change.

    Raises:
        RefusalError: The graphlet has a change that no motion makes.
    """
    states = graphlet.states
    planner = _Planner(states, quantities)
    before = tuple(planner.begin())
    steps: list[Primitive] = []
    for number in range(1, len(states)):
        steps += planner.between(number)
    if len(states) == 1:
        steps.append(Stay(quantities.duration_of(0)))
    lowered = any(isinstance(step, Lower) for step in steps)
    return ActionPlan(before, tuple(steps), states[0].holds, lowered)


class _Planner:
    """Walks over the states of a graphlet."""

    def __init__(self, states: tuple[GraphletState, ...], quantities: Quantities) -> None:
        self._states = states
        self._quantities = quantities
        self._on_board = not any(state.raised for state in states)
        taken_up = any(state.raised or (state.holds and state.object_location) for state in states)
        self._lift = quantities.rise if taken_up else LEAST_LIFT
        self._in_air = states[0].holds and (self._on_board or states[0].raised)

    def begin(self) -> Iterator[Primitive]:
        """What leads to the first state from a scene that stands still with an open, empty hand."""
        first = self._states[0]
        if first.holds:
            yield from (Reach(self._quantities.rise), Close())
            if self._in_air:
                yield Lift(self._quantities.rise)
        elif first.side is not None:
            yield Shape(closed=True)
            yield self._touch(0)
        elif first.touching:
            yield Reach(self._lift)
        else:
            yield Shape(first.gripper_closed)

    def between(self, number: int) -> Iterator[Primitive]:
        """What leads from the state before to a state."""
        before, after = self._states[number - 1], self._states[number]
        if before.holds and after.holds:
            yield from self._with_it(before, after, number)
        elif before.holds:
            yield from self._away_from_held(after)
        elif after.holds:
            yield from self._taking(before, after, number)
        elif after.side is not None:
            yield from self._from_outside(before, after, number)
        elif before.touching and not after.touching:
            yield Retreat()
            if before.gripper_closed != after.gripper_closed:
                yield Shape(after.gripper_closed)
        elif after.touching and before.side is not None:
            yield from (Retreat(), Shape(closed=False), Reach(self._lift))  # from outside to around it
        elif after.touching and not before.touching:
            if before.gripper_closed:
                yield Shape(closed=False)
            yield Reach(self._lift)
        elif before.gripper_closed != after.gripper_closed:
            yield Shape(after.gripper_closed)

    def _with_it(self, before: GraphletState, after: GraphletState, number: int) -> Iterator[Primitive]:
        """Between two states with the object in the hand."""
        if before.raised and after.raised:
            if before.object_location != after.object_location:
                yield Carry()
        elif after.raised:
            yield Lift(self._quantities.rise)
        elif before.raised:
            yield from (Carry(), Lower())
        elif before.object_location != after.object_location:
            let_go = any(not state.holds for state in self._states[number:])
            if not (let_go and self._in_air):
                yield Lift(self._quantities.rise)
            self._in_air = not let_go
            if let_go:
                yield from (Carry(), Lower())

    def _taking(self, before: GraphletState, after: GraphletState, number: int) -> Iterator[Primitive]:
        """The object gets between the fingers, and goes on with them if it is raised at once."""
        if not before.touching:
            if before.gripper_closed:
                yield Shape(closed=False)
            yield Reach(self._lift)
        elif before.side is not None:
            yield from (Retreat(), Shape(closed=False), Reach(self._lift))
        yield Close()
        if after.raised or (self._on_board and before.object_location != after.object_location):
            yield Lift(self._quantities.rise)

    def _away_from_held(self, after: GraphletState) -> Iterator[Primitive]:
        """The fingers let go of the object."""
        if after.side is not None:
            raise RefusalError(f"the learned action goes from holding to [{after}] in one change, which no hand can do")
        yield Release()
        if not after.touching:
            yield Retreat()
            if after.gripper_closed:
                yield Shape(closed=True)

    def _from_outside(self, before: GraphletState, after: GraphletState, number: int) -> Iterator[Primitive]:
        """The closed hand comes against the object, or pushes it on."""
        if after.raised:
            raise RefusalError(f"the learned action reaches [{after}]: a hand that is closed on nothing raises nothing")
        if before.side != after.side:
            if before.touching:
                yield Retreat()
            if not before.gripper_closed:
                yield Shape(closed=True)
            yield self._touch(number)
        if before.object_location != after.object_location:
            yield Push(self._quantities.shift)
        elif not self._pushed_next(number):
            yield Stay(self._quantities.duration_of(number))

    def _touch(self, number: int) -> Touch:
        """The touch with which a state begins."""
        side = self._states[number].side
        if side is None:
            raise RefusalError(f"state [{self._states[number]}] is not touched from outside")
        pushed = self._pushed_next(number) or (
            number > 0 and self._states[number - 1].object_location != self._states[number].object_location
        )
        return Touch(side, self._quantities.force_from(side), self._quantities.shift if pushed else 0.0)

    def _pushed_next(self, number: int) -> bool:
        """Whether the touch of a state goes on with the object at another place."""
        return (
            number + 1 < len(self._states)
            and self._states[number + 1].side == self._states[number].side
            and self._states[number + 1].object_location != self._states[number].object_location
        )
