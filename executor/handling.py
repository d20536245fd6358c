"""Picking, carrying and placing on the twin: collision-checked motions around a grasp by friction."""

from dataclasses import dataclass, replace

import numpy as np

from executor.arm_motions import WAY_CLEARANCE, ArmMotions, moved
from executor.follow import wait
from executor.grasp_choice import GENTLE, Accepts, ChosenGrasp, choose_grasp, way_back, way_up
from executor.handled import Handled
from robots.arm_model import ArmModel
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose
from robots.trajectories import JointLimits, ToolLimits, Trajectory
from twin import World
from twin.slip import SlipMonitor

__all__ = ["CarryPlan", "Handled", "Handling"]

PRESS_DOWN = 0.0005
"""Height [m] above the table at which an object is let go."""
SETTLING = 0.012
"""Height [m] from which an object is lowered slowly,"""
TOUCHED_DOWN = 5.0
"""until the wrist is pushed up by this force [N]."""
NOTHING_HELD = "nothing held: pick an object first"
SLOW = ToolLimits(0.03, 0.3, 6.0, 0.2, 2.0, 30.0)
"""Tool limits where something is touched."""
CARRYING = ToolLimits(0.30, 1.0, 10.0, 1.0, 4.0, 40.0)
"""Tool limits with an object in the hand."""


@dataclass(frozen=True, slots=True)
class CarryPlan:
    """How a held object is carried, lowered, slowly set down where it shall rest, and how the hand then leaves it."""

    carrying: Trajectory
    lowering: Trajectory
    settling: Trajectory
    leaving: Trajectory


class Handling:
    """Picks up and places objects with one arm of a world.

    Args:
        world: The twin.
        arm: Name of the arm.
        rng: Where the planner's chance comes from.

    Attributes:
        world: The twin.
        arm_name: Name of the arm.
        motions: Its motions.
    """

    def __init__(self, world: World, arm: str, rng: np.random.Generator) -> None:
        self.world = world
        self.arm_name = arm
        self.motions = ArmMotions(world, arm, rng)
        self._gap = 0.0
        self._let_go: int | None = None
        self._slip: SlipMonitor | None = None

    @property
    def arm(self) -> ArmModel:
        """The arm, where its base is now."""
        return self.motions.arm

    @property
    def limits(self) -> JointLimits:
        """The arm's limits."""
        return self.motions.limits

    @property
    def q(self) -> FloatArray:
        """Where the arm's drives are told to be, (n,) [rad]."""
        return self.motions.q

    @property
    def held(self) -> int | None:
        """Id of what was gripped and not let go since."""
        return self.motions.held

    def pick(self, object_id: int, lift: float = 0.10) -> Handled:
        """Grip an object and lift it.

        Args:
            object_id: Which one.
            lift: How far up [m].

        Raises:
            TwinError: There is no such object.
        """
        reached = self.reach(object_id, lift)
        if not reached.success:
            return reached
        gripped = self.grip(object_id)
        return self.raise_by(lift) if gripped.success else gripped

    def choose(
        self, object_id: int, lift: float = 0.10, accepts: Accepts = lambda grip, posture: True
    ) -> ChosenGrasp | str:
        """Choose a grasp for `reach`, or say why there is none; nothing moves. Arguments as there."""
        return choose_grasp(self.motions, object_id, lift, accepts)

    def reach(
        self,
        object_id: int,
        lift: float = 0.10,
        accepts: Accepts = lambda grip, posture: True,
        chosen: ChosenGrasp | str | None = None,
    ) -> Handled:
        """Bring the open hand around an object.

        Args:
            object_id: Which one.
            lift: How far up it must be possible to lift it then [m].
            accepts: Whether a grasp suits what comes after it.
            chosen: A grasp that was chosen in the world as it is; None: one is chosen now.

        Raises:
            TwinError: There is no such object.
        """
        if chosen is None:
            chosen = self.choose(object_id, lift, accepts)
        if isinstance(chosen, str):
            return Handled(False, chosen)
        self.motions.fingers.tell(chosen.grip.opening)
        came = self.motions.go(chosen.before, self.motions.around(detailed={object_id}))
        if came.success:
            self.motions.play(chosen.way)
            self._gap = chosen.grip.opening
        return came

    def grip(self, object_id: int) -> Handled:
        """Close the fingers on an object that is between them."""
        self.motions.fingers.move(0.0)
        return self.take_over(object_id)

    def take_over(self, object_id: int) -> Handled:
        """Go on with an object that is between the closed fingers already."""
        state = self.world.state()
        if state.arms[self.motions.number].held != object_id:
            return Handled(False, "not gripped: the fingers closed without the object between them")
        self.motions.held = object_id
        self._gap = self._gap or self.arm.gripper.max_opening
        self._slip = SlipMonitor(state, self.motions.number, object_id)
        return Handled(True)

    def raise_by(self, height: float) -> Handled:
        """Lift the held object straight up [m]."""
        up = self.motions.go_straight(moved(self.motions.tool, np.array([0.0, 0.0, height])), GENTLE)
        return self.checked(up, "lifting")

    def plan_carry(
        self, offset: FloatArray, turn: float = 0.0, drop: float = 0.10, near: FloatArray | None = None
    ) -> CarryPlan | None:
        """Plan to carry the held object, so that it can be lowered there; None if that is out of reach or blocked.

        Args:
            offset: By which its centre moves, (3,) [m].
            turn: By which it is turned about the vertical [rad].
            drop: By which it is lowered then [m].
            near: Posture near which that at the end is sought first, (n,) [rad]; None: where the arm is.
        """
        motions = self.motions
        target = self._carried_to(offset, turn)
        model = motions.around()
        straight = motions.plan_straight(self.q, target, CARRYING).trajectory
        if straight is not None and motions.way_free(model, straight, WAY_CLEARANCE):
            rest = self._setting_down(straight.at(straight.duration)[0], drop)
            if rest is not None:
                return CarryPlan(straight, *rest)
        for start in (self.q,) if near is None else (near, self.q):
            goal = motions.reach(target, start)
            if goal is None or not motions.free(model, goal, WAY_CLEARANCE):
                continue
            rest = self._setting_down(goal, drop)
            if rest is None:
                continue
            planned = motions.plan_free(model, goal, self.limits.scaled(1.5))
            if planned.trajectory is not None:
                return CarryPlan(planned.trajectory, *rest)
        return None

    def carry(self, plan: CarryPlan) -> Handled:
        """Carry the held object as planned."""
        if self.held is None:
            return Handled(False, NOTHING_HELD)
        self.motions.play(plan.carrying)
        return self.checked(Handled(True), "carrying")

    def place(self, plan: CarryPlan) -> Handled:
        """Lower the held object as planned, let it go, and draw the hand back."""
        lowered, early = self.lower(plan)
        if self.held is None:
            return lowered
        self.let_go()
        left = self.leave(None if early else plan.leaving)
        return lowered if left.success else left

    def lower(self, plan: CarryPlan) -> tuple[Handled, bool]:
        """Lower the held object as planned, slowly at last; whether it touched down before the end."""
        if self.held is None:
            return Handled(False, NOTHING_HELD), False
        self.motions.play(plan.lowering)
        lowered = self.checked(Handled(True), "lowering")
        weight = float(self.motions.wrist_force[2])
        # An object that was tilted by the fingers reaches the table early.
        early = self.motions.play(plan.settling, lambda: float(self.motions.wrist_force[2]) - weight > TOUCHED_DOWN)
        return lowered, early

    def lower_into(self, depth: float) -> bool:
        """Lower the held object slowly on from where it is, by a depth [m] at most; whether it touched something."""
        tool, weight = self.motions.tool, float(self.motions.wrist_force[2])
        ways = (
            self.motions.plan_straight(self.q, moved(tool, np.array([0.0, 0.0, -part * depth])), SLOW).trajectory
            for part in (1.0, 0.5)
        )
        way = next((each for each in ways if each is not None), None)
        return way is not None and self.motions.play(
            way, lambda: float(self.motions.wrist_force[2]) - weight > TOUCHED_DOWN
        )

    def let_go(self) -> None:
        """Open the fingers as far as they came around the object."""
        self.motions.fingers.move(self._gap)
        self._gap = 0.0
        self._let_go = self.motions.held
        self.motions.held = self._slip = None

    def leave(self, way: Trajectory | None = None) -> Handled:
        """Draw the hand straight back from where it let go, on a way planned before or a new one.

        Where it would hit something on every straight way back it goes up; it goes blindly only at the last.
        """
        leaving = way
        if leaving is None:
            left = () if self._let_go is None else (self._let_go,)
            around = self.motions.around(without=left)
            leaving = (
                way_back(self.motions, self.q, around)
                or way_up(self.motions, self.q, around)
                or way_back(self.motions, self.q)
            )
        if leaving is None:
            return Handled(False, "no straight way: the hand cannot draw back from where the object touched down")
        self.motions.play(leaving)
        return Handled(True)

    def rest(self, seconds: float) -> None:
        """Stand still for a time [s]."""
        wait(self.world, seconds, self.motions.fingers.openings)

    def go_home(self) -> Handled:
        """Bring the arm to its home posture."""
        self.motions.fingers.tell(self.arm.gripper.max_opening)
        return self.motions.go(self.arm.home, self.motions.around())

    def checked(self, done: Handled, doing: str) -> Handled:
        """Add how the object moved in the hand; failure if it is lost."""
        if self._slip is None or not done.success:
            return done
        slip = self._slip.measure(self.world.state())
        if slip.lost:
            return Handled(False, f"dropped: the object left the hand while {doing}", slip)
        return replace(done, slip=slip)

    def _setting_down(self, start: FloatArray, drop: float) -> tuple[Trajectory, Trajectory, Trajectory] | None:
        """The ways straight down from a posture, fast and slowly, and that back from the object; None without them."""
        above = self.arm.forward_kinematics(start)
        slow = min(SETTLING, drop)
        lowering = self.motions.plan_straight(start, moved(above, np.array([0.0, 0.0, slow - drop])), GENTLE).trajectory
        if lowering is None:
            return None
        near = lowering.at(lowering.duration)[0]
        at = moved(above, np.array([0.0, 0.0, PRESS_DOWN - drop]))
        settling = self.motions.plan_straight(near, at, SLOW).trajectory
        if settling is None:
            return None
        opening = self._gap or self.arm.gripper.max_opening
        emptied = self.motions.around(holding=False)
        leaving = way_back(self.motions, settling.at(settling.duration)[0], emptied, opening)
        return None if leaving is None else (lowering, settling, leaving)

    def _carried_to(self, offset: FloatArray, turn: float) -> Pose:
        """Where the tool is when the held object has moved and turned."""
        tool = self.motions.tool
        centre = next(
            (each.pose_object_in_world.position for each in self.world.state().objects if each.id == self.held),
            tool.position,
        )
        about = rotation_matrix(np.array([0.0, 0.0, np.sin(turn / 2), np.cos(turn / 2)]))
        position = centre + np.asarray(offset, dtype=float) + about @ (tool.position - centre)
        return Pose(position, quaternion_xyzw(about @ rotation_matrix(tool.orientation_xyzw)))
