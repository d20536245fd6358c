"""One arm that acts on one object: each motion primitive carried out on the twin."""

from collections.abc import Sequence
from functools import singledispatchmethod

import numpy as np

from executor.actions.action_plan import ActionPlan
from executor.actions.destination import TURNS, Destination
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
from executor.actions.reaching import reaches
from executor.actions.step_aside import step_aside
from executor.actions.things import clear_below, corners_of, is_crowded, others_around, pose_of
from executor.actions.touching_hand import TouchingHand
from executor.arm_motions import ArmMotions
from executor.follow import wait
from executor.grasp_choice import ChosenGrasp
from executor.handled import Handled
from executor.handling import CarryPlan, Handling
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from twin import World
from twin.grasp_poses import GraspPose

SETTLE = 0.3
"""Time [s] in which everything comes to rest before an action begins."""
FALL = 0.5
"""Time [s] in which what is let go of in the air falls."""
LEAST_DROP = 0.02
"""An object is lowered onto its destination from where it is carried now, or from so far above [m] at least."""
OTHER_GRASP = (0.012, 0.4)
"""A grasp is another one with its tool so far away [m], or turned so far [rad]."""
DEPTH = 0.03
"""An object is lowered so far [m] into what it goes onto, until it touches something,"""
HAND_BESIDE = 0.022
"""if a hand has so much room [m] on each side of it there."""
IN_AIR = 0.01
"""An object is in the air with so much free height below it [m]."""


class ActingHand:
    """Carries out primitives.

    Args:
        world: The twin.
        arm: Name of the arm.
        object_id: The object it acts on.
        goal: Where the object's centre shall come to rest, (3,) [m]; None: below where it is.
        rng: Where the planners' chance comes from.
        slipped: Grasps that are not tried again, where the object is now.

    Attributes:
        name: Name of the arm.
        may_give_up: Whether nothing has been touched yet: another arm may try.
        grasps: Grasps that were come to.
    """

    def __init__(
        self,
        world: World,
        arm: str,
        object_id: int,
        goal: FloatArray | None,
        rng: np.random.Generator,
        slipped: Sequence[GraspPose] = (),
    ) -> None:
        self.name = arm
        self.may_give_up = True
        self.grasps: tuple[GraspPose, ...] = ()
        self._world = world
        self._handling = Handling(world, arm, rng)
        self._motions = self._handling.motions
        self._object = object_id
        self._goal = goal
        self._rng = rng
        self._slipped = tuple(slipped)
        self._destination: Destination | None = None
        self._plan: CarryPlan | None = None
        self._outside = TouchingHand(self._motions, object_id)
        self._lift_after: float | None = None
        self._foreseen: ChosenGrasp | None = None
        self._early = False

    def do(self, step: Primitive) -> Handled:
        """Carry out a primitive."""
        return self._do(step)

    def foresee(self, plan: ActionPlan) -> Handled:
        """Whether the hand can begin an action, in the world as it is; nothing moves, and what was found is kept."""
        hand = self._world.state().arms[self._motions.number]
        if hand.gripper_closed and hand.held == self._object:
            return Handled(True)
        first = next((step for step in (*plan.before, *plan.steps) if isinstance(step, Reach | Touch)), None)
        if isinstance(first, Touch):
            if not reaches(self._world, self.name, self._object):
                return Handled(False, "out of reach: no posture brings the hand to the object")
            # Where nothing is in the way there is a way; to look for it first would only make everyone wait.
            return self._outside.foresee(first, self._rng) if is_crowded(self._world, self._object) else Handled(True)
        if first is None:
            return Handled(True)
        if self._goal is not None and not reaches(self._world, self.name, self._object, self._goal):
            return Handled(False, "out of reach: no posture brings the object to where it shall go")
        chosen = self._chosen(first.lift)
        if isinstance(chosen, str):
            return Handled(False, chosen)
        self._foreseen = chosen
        return Handled(True)

    def take_over(self) -> bool:
        """Go on with the object if it is in the hand already."""
        hand = self._world.state().arms[self._motions.number]
        if not (hand.gripper_closed and hand.held == self._object):
            return False
        self.may_give_up = False
        return self._handling.take_over(self._object).success

    @property
    def in_air(self) -> bool:
        """Whether there is free room below the object."""
        return self._below() > IN_AIR

    def settle(self) -> None:
        """Let everything come to rest."""
        wait(self._world, SETTLE, self._motions.fingers.openings)

    def make_way(self) -> None:
        """Go home, so that another arm has room."""
        self._handling.go_home()

    @singledispatchmethod
    def _do(self, step: Primitive) -> Handled:
        raise TypeError(f"no motion is known for {step!r}")

    @_do.register
    def _shape(self, step: Shape) -> Handled:
        self._motions.fingers.move(0.0 if step.closed else self._handling.arm.gripper.max_opening)
        return Handled(True)

    @_do.register
    def _reach(self, step: Reach) -> Handled:
        reached = self._reach_from(step.lift)
        self._lift_after = step.lift
        self.may_give_up = not reached.success
        return reached

    @_do.register
    def _close(self, step: Close) -> Handled:
        gripped = self._handling.grip(self._object)
        if gripped.success or self._lift_after is None:
            return gripped
        # What slipped from between the fingers has moved: it is looked at and reached for once more.
        self._motions.fingers.move(self._handling.arm.gripper.max_opening)
        self._handling.leave()
        again = self._reach_from(self._lift_after)
        return self._handling.grip(self._object) if again.success else gripped

    @_do.register
    def _lift(self, step: Lift) -> Handled:
        return self._handling.raise_by(step.height)

    @_do.register
    def _carry(self, step: Carry) -> Handled:
        there = self._handling.checked(Handled(True), "waiting to be carried")
        if self._goal is None or not there.success:
            return there
        plan = self._find_carry(self._goal)
        if plan is None and self._others_step_aside():
            plan = self._find_carry(self._goal)
        if plan is None:
            return Handled(False, "no carry: the destination is out of reach or blocked with the object in the hand")
        self._plan = plan
        return self._handling.carry(plan)

    @_do.register
    def _lower(self, step: Lower) -> Handled:
        if self._plan is None:
            self._plan = self._handling.plan_carry(np.zeros(3), drop=max(self._below(), 0.0))
        if self._plan is None:
            return Handled(False, "no straight way: the hand cannot go straight down to where the object would rest")
        lowered, self._early = self._handling.lower(self._plan)
        if lowered.success and not self._early and self._room_below():
            # What it goes onto may be hollow, and what falls into it tumbles.
            self._handling.lower_into(DEPTH)
            self._early = True  # the way back that was planned begins higher
        return lowered

    @_do.register
    def _release(self, step: Release) -> Handled:
        in_air = self.in_air
        self._handling.let_go()
        if in_air:
            wait(self._world, FALL, self._motions.fingers.openings)
        return Handled(True)

    @_do.register
    def _retreat(self, step: Retreat) -> Handled:
        if not self._outside.came:
            planned = None if self._plan is None or self._early else self._plan.leaving
            return self._handling.leave(planned)
        return self._outside.draw_back()

    @_do.register
    def _touch(self, step: Touch) -> Handled:
        touched = self._outside.touch(step, self._rng)
        self.may_give_up = not self._outside.came
        return touched

    @_do.register
    def _push(self, step: Push) -> Handled:
        return self._outside.push(step.way)

    @_do.register
    def _stay(self, step: Stay) -> Handled:
        if not self._outside.keep(step.seconds):
            wait(self._world, step.seconds, self._motions.fingers.openings)
        return self._handling.checked(Handled(True), "staying")

    def _reach_from(self, lift: float) -> Handled:
        """Bring the open hand around the object, to a grasp that suits its destination."""
        chosen, self._foreseen = self._foreseen, None
        grasp = chosen or self._chosen(lift)
        if not isinstance(grasp, str):
            self.grasps = (*self.grasps, grasp.grip)
        return self._handling.reach(self._object, lift, chosen=grasp)

    def _chosen(self, lift: float) -> ChosenGrasp | str:
        """A grasp that suits the object's destination, or why there is none."""
        if self._goal is not None:
            self._destination = Destination(self._motions, self._object, self._goal, lift)
        return self._handling.choose(self._object, lift, self._accepted)

    def _accepted(self, grip: GraspPose, posture: FloatArray) -> bool:
        """Whether a grasp is another than those that slipped, and suits the destination."""
        return not any(_alike(grip, other) for other in self._slipped) and (
            self._destination is None or self._destination(grip, posture)
        )

    def _below(self) -> float:
        """Free height below the object [m]."""
        return clear_below(self._world, self._object)

    def _find_carry(self, goal: FloatArray) -> CarryPlan | None:
        """A carry to the goal, turned about the vertical where that is needed."""
        here = pose_of(self._world.state(), self._object).position
        drop = max(float(here[2] - goal[2]), LEAST_DROP)
        offset = np.append(goal[:2] - here[:2], goal[2] + drop - here[2])
        tries: list[tuple[float, FloatArray | None]] = [(turn, None) for turn in TURNS]
        if self._destination is not None:
            tries.insert(0, (self._destination.turn, self._destination.above))
        plans = (self._handling.plan_carry(offset, turn, drop, near) for turn, near in tries)
        return next((plan for plan in plans if plan is not None), None)

    def _room_below(self) -> bool:
        """Whether what the object goes onto is so wide that a hand has room in it beside the object."""
        if self._goal is None:
            return False
        mine = corners_of(self._world, self._object)
        wide = float(np.ptp(mine[:, :2], axis=0).max())
        under = float(self._goal[2]) - float(pose_of(self._world.state(), self._object).position[2] - mine[:, 2].min())
        for its in others_around(self._world, self._object, self._goal[:2]):
            if abs(float(its[:, 2].max()) - under) < IN_AIR:
                return float(np.ptp(its[:, :2], axis=0).min()) - wide > 2.0 * HAND_BESIDE
        return False

    def _others_step_aside(self) -> bool:
        """Whether another arm could move up and outwards to give this one room."""
        made = False
        for name in self._world.robot.arms:
            if name != self.name:
                made |= step_aside(ArmMotions(self._world, name, self._rng))
        return made


def _alike(one: GraspPose, other: GraspPose) -> bool:
    """Whether two grasps are nearly the same."""
    a, b = one.pose_tool_in_world, other.pose_tool_in_world
    turn = rotation_matrix(a.orientation_xyzw).T @ rotation_matrix(b.orientation_xyzw)
    angle = float(np.arccos(np.clip((np.trace(turn) - 1.0) / 2.0, -1.0, 1.0)))
    return float(np.linalg.norm(a.position - b.position)) < OTHER_GRASP[0] and angle < OTHER_GRASP[1]
