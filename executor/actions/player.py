"""Playing an action graphlet on a world: one primitive after the other, by whichever arm can."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import count

import numpy as np

from executor.actions.action_plan import ActionPlan, plan_action
from executor.actions.hand import ActingHand
from executor.actions.primitives import Close, Lift, Lower, Primitive, Reach, Release, Retreat, Touch
from executor.actions.quantities import Quantities
from executor.actions.reaching import reaches
from executor.actions.rolling import roll_nearer
from executor.actions.things import is_crowded, pose_of
from executor.arm_motions import ArmMotions
from executor.handled import Handled
from learning.graphs.action_graphlet import ActionGraphlet
from robots.pose import FloatArray, Pose
from twin import World
from twin.grasp_poses import GraspPose

AT_HOME = 0.05
"""An arm so near to its home posture [rad] is there."""

HOPELESS = ("no grasp", "no room")
"""How the reasons begin for which an arm cannot take a thing, wherever it shall go."""


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
        on_primitive: Called with each primitive when it begins.

    Attributes:
        grasps: Grasps that were come to in the last action, the first first.
    """

    def __init__(
        self,
        world: World,
        rng: np.random.Generator,
        on_primitive: Callable[[Primitive], None] = lambda primitive: None,
    ) -> None:
        self.world = world
        self._rng = rng
        self._on_primitive = on_primitive
        self.grasps: tuple[GraspPose, ...] = ()
        self._hopeless: dict[tuple[str, int, float], str] = {}

    def play(
        self,
        graphlet: ActionGraphlet,
        object_id: int,
        goal: FloatArray | None = None,
        quantities: Quantities | None = None,
        on_start: Callable[[str], None] = lambda arm: None,
        *,
        stays: bool = False,
        slipped: Sequence[GraspPose] = (),
    ) -> Played:
        """Play an action. An arm that cannot even begin leaves it to the next one; if none can, a base rolls nearer.

        Nothing moves where no arm could begin from anywhere.

        Args:
            graphlet: The action.
            object_id: The object to act on.
            goal: Where its centre shall come to rest, (3,) [m], for an action that sets it down; None: where it is.
            quantities: How much of each change belongs to the action; usual amounts if not given.
            on_start: Called with the arm's name when the world is in the action's first state.
            stays: Whether the base stays where it is.
            slipped: Grasps that are not tried again.

        Raises:
            RefusalError: The graphlet has a change that no motion makes.
            TwinError: There is no such object.
        """
        plan = plan_action(graphlet, quantities or Quantities())
        self.world.model_of(object_id)
        goal = goal if plan.sets_down else None
        failed: list[Played] = []
        place = pose_of(self.world.state(), object_id).position
        middle = place if goal is None else 0.5 * (place + np.asarray(goal))

        def suits(base: Pose) -> bool:
            return any(reaches(self.world, arm, object_id, goal, base) for arm in self.world.robot.arms)

        for attempt in count():
            for again in (False, True):
                for arm in self._arms(object_id):
                    hand = ActingHand(self.world, arm, object_id, goal, self._rng, slipped)
                    self.grasps = ()
                    now = (arm, object_id, self.world.time)
                    can = Handled(False, self._hopeless[now]) if now in self._hopeless else hand.foresee(plan)
                    if not can.success:
                        if can.reason.startswith(HOPELESS):
                            self._hopeless[now] = can.reason
                        first = next(step for step in (*plan.before, *plan.steps) if isinstance(step, Reach | Touch))
                        failed.append(Played(False, can.reason, _name(first), arm))
                        continue
                    self._way_made(arm)
                    played = self._with(hand, plan, on_start)
                    self.grasps = hand.grasps
                    if played.success or not hand.may_give_up:
                        return played
                    failed.append(played)
                    hand.make_way()
                if again or not self._way_made():
                    break
            # Where other things leave no room, they are what is in the way, and to stand nearer is no cure.
            blocked = is_crowded(self.world, object_id) and any(each.reason.startswith("no room") for each in failed)
            if stays or blocked or not roll_nearer(self.world, middle, attempt, self._rng, suits):
                break
        # An arm that reached the object and had no room tells more than one that is far away.
        return min(failed, key=lambda each: each.reason.startswith("out of reach"))

    def _way_made(self, acting: str = "") -> bool:
        """Whether an empty hand that was not at home went there, so that the acting one, or any, has room."""
        made = False
        state = self.world.state()
        for number, name in enumerate(self.world.robot.arms):
            if name == acting or len(self.world.robot.arms) == 1:
                continue
            motions = ArmMotions(self.world, name, self._rng)
            away = float(np.abs(motions.q - motions.arm.home).max())
            if state.arms[number].held is None and away > AT_HOME:
                made |= motions.go(motions.arm.home, motions.around()).success
        return made

    def _with(self, hand: ActingHand, plan: ActionPlan, on_start: Callable[[str], None]) -> Played:
        """Play with one arm."""

        def done(steps: tuple[Primitive, ...]) -> Iterator[tuple[Primitive, Handled]]:
            for step in steps:
                self._on_primitive(step)
                yield step, hand.do(step)

        before: tuple[Primitive, ...] = ()
        steps = plan.steps
        if hand.take_over():
            if plan.starts_held:  # it may have been grasped and not been lifted
                before = () if hand.in_air else tuple(step for step in plan.before if isinstance(step, Lift))
            else:
                before, steps = _from_the_hand(steps, in_air=hand.in_air)
        else:
            before = plan.before
        for step, outcome in done(before):
            if not outcome.success:
                return Played(False, outcome.reason, _name(step), hand.name)
        hand.settle()
        on_start(hand.name)
        for step, outcome in done(steps):
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


def _from_the_hand(
    steps: tuple[Primitive, ...], *, in_air: bool
) -> tuple[tuple[Primitive, ...], tuple[Primitive, ...]]:
    """What comes first, and what is left, of an action with an empty hand if its object is in the hand already."""
    closing = next((number for number, step in enumerate(steps) if isinstance(step, Close)), None)
    if closing is None:
        return (Lower(), Release(), Retreat()), steps
    left = steps[closing + 1 :]
    return (), left[1:] if in_air and left and isinstance(left[0], Lift) else left


def _name(step: Primitive) -> str:
    return type(step).__name__.lower()
