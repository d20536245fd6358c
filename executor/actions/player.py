"""Playing an action graphlet on a world: one primitive after the other, by whichever arm can."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count

import numpy as np

from executor.actions.action_plan import ActionPlan, plan_action
from executor.actions.hand import ActingHand
from executor.actions.primitives import Primitive
from executor.actions.quantities import Quantities
from executor.actions.rolling import roll_nearer
from executor.actions.things import pose_of
from executor.handled import Handled
from learning.graphs.action_graphlet import ActionGraphlet
from robots.pose import FloatArray
from twin import World


@dataclass(frozen=True, slots=True)
class Played:
    """How an action was played.

    Attributes:
        success: Whether every primitive was done.
        reason: Why not; its first words name the kind of failure.
        primitive: Name of the primitive that failed.
        arm: The arm that acted.
        started: Whether the world was brought to the action's first state.
    """

    success: bool
    reason: str = ""
    primitive: str = ""
    arm: str = ""
    started: bool = False


class ActionPlayer:
    """Plays action graphlets on a world, for any of its objects and any destination.

    Args:
        world: The twin.
        rng: Where the planners' chance comes from.
    """

    def __init__(self, world: World, rng: np.random.Generator) -> None:
        self.world = world
        self._rng = rng

    def play(
        self,
        graphlet: ActionGraphlet,
        object_id: int,
        goal: FloatArray | None = None,
        quantities: Quantities | None = None,
        on_start: Callable[[str], None] = lambda arm: None,
    ) -> Played:
        """Play an action. An arm that cannot even begin leaves it to the next one.

        Args:
            graphlet: The action.
            object_id: The object to act on.
            goal: Where its centre shall come to rest, (3,) [m], for an action that sets it down; None: where it is.
            quantities: How much of each change belongs to the action; usual amounts if not given.
            on_start: Called with the arm's name when the world is in the action's first state.

        Raises:
            RefusalError: The graphlet has a change that no motion makes.
            TwinError: There is no such object.
        """
        plan = plan_action(graphlet, quantities or Quantities())
        self.world.model_of(object_id)
        failed: list[Played] = []
        place = pose_of(self.world.state(), object_id).position
        for attempt in count():
            for arm in self._arms(object_id):
                hand = ActingHand(self.world, arm, object_id, goal if plan.sets_down else None, self._rng)
                played = self._with(hand, plan, on_start)
                if played.success or not hand.may_give_up:
                    return played
                failed.append(played)
                hand.make_way()
            if not roll_nearer(self.world, place, attempt, self._rng):
                break
        # An arm that reached the object and had no room tells more than one that is far away.
        return min(failed, key=lambda each: each.reason.startswith("out of reach"))

    def _with(self, hand: ActingHand, plan: ActionPlan, on_start: Callable[[str], None]) -> Played:
        """Play with one arm."""

        def done(steps: tuple[Primitive, ...]) -> Iterator[tuple[Primitive, Handled]]:
            for step in steps:
                yield step, hand.do(step)

        if not (plan.starts_held and hand.take_over()):
            for step, outcome in done(plan.before):
                if not outcome.success:
                    return Played(False, outcome.reason, _name(step), hand.name)
        hand.settle()
        on_start(hand.name)
        for step, outcome in done(plan.steps):
            if not outcome.success:
                return Played(False, outcome.reason, _name(step), hand.name, started=True)
        return Played(True, arm=hand.name, started=True)

    def _arms(self, object_id: int) -> list[str]:
        """Names of the arms: that which holds the object, else the nearest first."""
        state = self.world.state()
        names = list(self.world.robot.arms)
        for name, arm in zip(names, state.arms, strict=True):
            if arm.held == object_id and arm.gripper_closed:
                return [name]
        place = pose_of(state, object_id).position[:2]
        arms = self.world.placed_robot.arms
        away = {
            name: float(np.linalg.norm(arms[name].forward_kinematics(arms[name].home).position[:2] - place))
            for name in names
        }
        return sorted(names, key=lambda name: away[name])


def _name(step: Primitive) -> str:
    return type(step).__name__.lower()
