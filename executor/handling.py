"""Picking, carrying and placing on the twin: collision-checked motions around a grasp by friction."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from executor.follow import follow, wait
from robots.arm_model import ArmModel
from robots.collision import CollisionModel, Obstacle
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose
from robots.trajectories import (
    JointLimits,
    MotionPlan,
    StraightMotion,
    ToolLimits,
    Trajectory,
    move_straight,
    plan_motion,
)
from twin import World
from twin.grasp_poses import GraspPose, grasp_poses
from twin.slip import Slip, SlipMonitor

APPROACH = 0.08
"""How far [m] before the grasp the hand comes onto the straight way to it."""
DEPTHS = (0.012, 0.006, 0.0, -0.006)
"""How much deeper than the middle of the pads the hand goes in where there is room [m]."""
OPENINGS = (0.016, 0.010)
"""Narrower openings than the widest, more than the object's width [m]: between neighbours, inside a bowl."""
TILTS = (0.0, 0.35, -0.35, 0.8, -0.8)
"""Angles [rad] by which the hand comes from another side about the line between the pads."""
TABLE_CLEARANCE = 0.0015
"""Least distance [m] of the open hand from everything when it is at the grasp."""
WAY_CLEARANCE = 0.004
"""Least distance [m] of the arm from everything on free ways."""
LEAST_CLEARANCE = 0.001
"""What is left of it [m] between the postures at which it is looked at."""
LOOK_AGAIN = 0.1
"""Time [s] between two looks at moving fingers,"""
STILL = 0.0002
"""which have stopped when their gap changed by less than this [m] in between;"""
PRESS = 0.2
"""then they press for this time [s] before anything else moves."""
SLOWEST = 4.0
"""No gripper needs longer [s]."""
PRESS_DOWN = 0.0005
"""Height [m] above the table at which an object is let go."""
SETTLING = 0.012
"""Height [m] from which an object is lowered slowly,"""
TOUCHED_DOWN = 5.0
"""until the wrist is pushed up by this force [N]."""
NOTHING_HELD = "nothing held: pick an object first"
TILT = 0.05
"""How far [rad] the tool of an arm that cannot choose its orientation may be from what a grasp asks."""
GENTLE = ToolLimits(0.15, 0.6, 6.0, 0.8, 3.0, 30.0)
"""Tool limits near objects."""
SLOW = ToolLimits(0.03, 0.3, 6.0, 0.2, 2.0, 30.0)
"""Tool limits where something is touched."""
CARRYING = ToolLimits(0.30, 1.0, 10.0, 1.0, 4.0, 40.0)
"""Tool limits with an object in the hand."""


@dataclass(frozen=True, slots=True)
class Handled:
    """Outcome of a step of handling.

    Attributes:
        success: Whether it was done.
        reason: Why not, in plain words; its first word or two name the kind of failure.
        slip: How the object moved in the hand, where it was held.
    """

    success: bool
    reason: str = ""
    slip: Slip | None = None


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
    """

    def __init__(self, world: World, arm: str, rng: np.random.Generator) -> None:
        self.world = world
        self.arm_name = arm
        self._joints = world.robot.slice_of(arm)
        self._number = list(world.robot.arms).index(arm)
        self._rng = rng
        self._openings = list(world.commanded_openings)
        self._held: int | None = None
        self._grip: GraspPose | None = None
        self._slip: SlipMonitor | None = None

    @property
    def arm(self) -> ArmModel:
        """The arm, where its base is now."""
        return self.world.placed_robot.arms[self.arm_name]

    @property
    def limits(self) -> JointLimits:
        """The arm's limits."""
        arm = self.arm
        return JointLimits(arm.lower, arm.upper, arm.velocity, arm.acceleration, arm.jerk)

    @property
    def q(self) -> FloatArray:
        """Where the arm's drives are told to be, (n,) [rad]."""
        return self.world.commanded_positions[self._joints]

    def pick(self, object_id: int, lift: float = 0.10) -> Handled:
        """Grip an object and lift it.

        Args:
            object_id: Which one.
            lift: How far up [m].

        Raises:
            TwinError: There is no such object.
        """
        chosen = self._choose_grasp(object_id, lift)
        if isinstance(chosen, str):
            return Handled(False, chosen)
        grip, before, down = chosen
        came = self._go(before, grip.opening, object_id)
        if not came.success:
            return came
        follow(self.world, down, self._joints, self._openings)
        self._move_fingers(0.0)
        state = self.world.state()
        if state.arms[self._number].held != object_id:
            return Handled(False, "not gripped: the fingers closed without the object between them")
        self._held, self._grip = object_id, grip
        self._slip = SlipMonitor(state, self._number, object_id)
        tool = self.arm.forward_kinematics(self.q)
        up = self._straight(_moved(tool, np.array([0.0, 0.0, lift])), GENTLE)
        return self._checked(up, "lifting")

    def plan_carry(self, offset: FloatArray, turn: float = 0.0, drop: float = 0.10) -> CarryPlan | None:
        """Plan to carry the held object, so that it can be lowered there; None if that is out of reach or blocked.

        Args:
            offset: By which its centre moves, (3,) [m].
            turn: By which it is turned about the vertical [rad].
            drop: By which it is lowered then [m].
        """
        target = self._carried_to(offset, turn)
        model = self._collisions()
        straight = self._plan_straight(self.q, target, CARRYING)
        if straight.trajectory is not None:
            samples = straight.trajectory.sample(0.05).position
            if all(self._free(model, q, WAY_CLEARANCE) for q in samples):
                rest = self._setting_down(samples[-1], drop)
                if rest is not None:
                    return CarryPlan(straight.trajectory, *rest)
        goal = self._reach(target, self.q)
        if goal is None or not self._free(model, goal, WAY_CLEARANCE):
            return None
        rest = self._setting_down(goal, drop)
        if rest is None:
            return None
        planned = self._plan(model, goal, self.limits.scaled(1.5))
        return None if planned.trajectory is None else CarryPlan(planned.trajectory, *rest)

    def carry(self, plan: CarryPlan) -> Handled:
        """Carry the held object as planned."""
        if self._held is None:
            return Handled(False, NOTHING_HELD)
        follow(self.world, plan.carrying, self._joints, self._openings)
        return self._checked(Handled(True), "carrying")

    def place(self, plan: CarryPlan) -> Handled:
        """Lower the held object as planned, let it go, and draw the hand back."""
        if self._grip is None or self._held is None:
            return Handled(False, NOTHING_HELD)
        follow(self.world, plan.lowering, self._joints, self._openings)
        lowered = self._checked(Handled(True), "lowering")
        weight = self._pull_upwards()
        # An object that was tilted by the fingers reaches the table early.
        early = follow(
            self.world,
            plan.settling,
            self._joints,
            self._openings,
            lambda: self._pull_upwards() - weight > TOUCHED_DOWN,
        )
        self._move_fingers(self._grip.opening)
        self._held = self._grip = self._slip = None
        leaving = self._leaving(self.q) if early else plan.leaving
        if leaving is None:
            return Handled(False, "no straight way: the hand cannot draw back from where the object touched down")
        follow(self.world, leaving, self._joints, self._openings)
        return lowered

    def _pull_upwards(self) -> float:
        """Force on the wrist along the vertical [N]."""
        return float(self.world.state().arms[self._number].wrist_wrench[2])

    def _setting_down(self, start: FloatArray, drop: float) -> tuple[Trajectory, Trajectory, Trajectory] | None:
        """The ways straight down from a posture, fast and slowly, and that back from the object; None without them."""
        above = self.arm.forward_kinematics(start)
        slow = min(SETTLING, drop)
        lowering = self._plan_straight(start, _moved(above, np.array([0.0, 0.0, slow - drop])), GENTLE).trajectory
        if lowering is None:
            return None
        near = lowering.at(lowering.duration)[0]
        at = _moved(above, np.array([0.0, 0.0, PRESS_DOWN - drop]))
        settling = self._plan_straight(near, at, SLOW).trajectory
        if settling is None:
            return None
        leaving = self._leaving(settling.at(settling.duration)[0])
        return None if leaving is None else (lowering, settling, leaving)

    def _leaving(self, start: FloatArray) -> Trajectory | None:
        """The way of the hand straight back from where it let go; None if there is none."""
        at = self.arm.forward_kinematics(start)
        approach = rotation_matrix(at.orientation_xyzw) @ self.arm.gripper.approach
        for part in (1.0, 0.6):
            leaving = self._plan_straight(start, _moved(at, -part * APPROACH * approach), GENTLE).trajectory
            if leaving is not None:
                return leaving
        return None

    def _carried_to(self, offset: FloatArray, turn: float) -> Pose:
        """Where the tool is when the held object has moved and turned."""
        tool = self.arm.forward_kinematics(self.q)
        centre = next(
            (each.pose_object_in_world.position for each in self.world.state().objects if each.id == self._held),
            tool.position,
        )
        about = rotation_matrix(np.array([0.0, 0.0, np.sin(turn / 2), np.cos(turn / 2)]))
        position = centre + np.asarray(offset, dtype=float) + about @ (tool.position - centre)
        return Pose(position, quaternion_xyzw(about @ rotation_matrix(tool.orientation_xyzw)))

    def rest(self, seconds: float) -> None:
        """Stand still for a time [s]."""
        wait(self.world, seconds, self._openings)

    def go_home(self) -> Handled:
        """Bring the arm to its home posture."""
        return self._go(self.arm.home, self.arm.gripper.max_opening, None)

    def _choose_grasp(self, object_id: int, lift: float) -> tuple[GraspPose, FloatArray, Trajectory] | str:
        """The first grasp that the arm reaches freely, the posture before it and the way in; or why there is none."""
        arm, thing = self.arm, self.world.model_of(object_id)
        pose = next(each.pose_object_in_world for each in self.world.state().objects if each.id == object_id)
        proposals = grasp_poses(thing, pose, arm.gripper, depths=DEPTHS, openings=OPENINGS, tilts=TILTS)
        if not proposals:
            return "no grasp: no part of the object fits between the fingers"
        model = CollisionModel(
            self.world.placed_robot, self.world.obstacles(detailed={object_id}), moving=[self.arm_name]
        )
        # What of the hand is not made to touch the object must not push it away when the fingers close.
        touching = [(link, str(object_id)) for link in arm.gripper.touching]
        closed = CollisionModel(
            self.world.placed_robot,
            self.world.obstacles(detailed={object_id}),
            moving=[self.arm_name],
            may_touch=touching,
        )
        # The object itself is lifted with the hand.
        lifted = CollisionModel(
            self.world.placed_robot, self.world.obstacles(detailed=(), without={object_id}), moving=[self.arm_name]
        )
        reached = free = False
        tool, before = None, None
        for proposal in proposals:
            if proposal.pose_tool_in_world is not tool:  # those that follow differ in their opening only
                tool = proposal.pose_tool_in_world
                before = self._reach(_moved(tool, -APPROACH * proposal.approach), arm.home)
                if before is not None and self._reach(tool, before) is None:
                    before = None
            if before is None:
                continue
            reached = True
            if not self._free(model, before, WAY_CLEARANCE, proposal.opening):
                continue
            free = True
            way = self._plan_straight(before, proposal.pose_tool_in_world, GENTLE)
            if way.trajectory is None:
                continue
            samples = way.trajectory.sample(0.05).position[::-1]  # what is in the way is near the end
            if not all(self._free(model, q, TABLE_CLEARANCE, proposal.opening) for q in samples):
                continue
            if not self._free(closed, samples[0], TABLE_CLEARANCE, proposal.width):
                continue
            up = self._plan_straight(
                samples[0], _moved(proposal.pose_tool_in_world, np.array([0.0, 0.0, lift])), GENTLE
            )
            if up.trajectory is not None and self._free(
                lifted, up.trajectory.sample(0.05).position[-1], WAY_CLEARANCE, proposal.opening
            ):
                return proposal, before, way.trajectory
        if not reached:
            return "out of reach: no posture brings the hand to any grasp of the object"
        if not free:
            return "no room: the hand would touch something before every grasp"
        return "no room: the hand would touch something on the way into or out of every grasp"

    def _reach(self, pose: Pose, near: FloatArray) -> FloatArray | None:
        """A posture for a tool pose near another; for an arm with few joints, if its orientation suits."""
        arm = self.arm
        if len(arm.joint_names) >= 6:
            found = arm.inverse_kinematics(pose, start=near, posture=near, tolerance=1e-5, max_restarts=8)
            return found.q if found.success else None
        found = arm.inverse_kinematics(pose.position, start=near)
        if not found.success:
            return None
        there = rotation_matrix(arm.forward_kinematics(found.q).orientation_xyzw)
        off = np.trace(there.T @ rotation_matrix(pose.orientation_xyzw))
        return found.q if np.arccos(np.clip((off - 1.0) / 2.0, -1.0, 1.0)) < TILT else None

    def _go(self, goal: FloatArray, opening: float, beside: int | None) -> Handled:
        """Go freely to a posture, with the fingers opening on the way."""
        self._open_to(opening)
        model = CollisionModel(
            self.world.placed_robot,
            self.world.obstacles(detailed=set() if beside is None else {beside}),
            moving=[self.arm_name],
        )
        planned = self._plan(model, goal, self.limits)
        if not planned.success or planned.trajectory is None:
            return Handled(False, f"no way: {self._why(model, planned.reason, goal)}")
        follow(self.world, planned.trajectory, self._joints, self._openings)
        return Handled(True)

    def _straight(self, pose: Pose, tool: ToolLimits) -> Handled:
        """Go straight to a pose of the tool."""
        planned = self._plan_straight(self.q, pose, tool)
        if planned.trajectory is None:
            return Handled(False, f"no straight way: {planned.reason}")
        follow(self.world, planned.trajectory, self._joints, self._openings)
        return Handled(True)

    def _plan(self, model: CollisionModel, goal: FloatArray, limits: JointLimits) -> MotionPlan:
        """A free way to a posture: searched with some distance to everything, and nowhere with nearly none."""
        return plan_motion(
            self.q,
            goal,
            limits,
            lambda q: self._free(model, q, WAY_CLEARANCE),
            self._rng,
            is_clear=lambda q: self._free(model, q, LEAST_CLEARANCE),
        )

    def _plan_straight(self, start: FloatArray, pose: Pose, tool: ToolLimits) -> StraightMotion:
        arm = self.arm
        turns = len(arm.joint_names) >= 6

        def inverse(at: Pose, near: FloatArray) -> FloatArray | None:
            target = at if turns else at.position
            found = arm.inverse_kinematics(target, start=near, tolerance=1e-6, max_restarts=0)
            return found.q if found.success else None

        return move_straight(
            start,
            pose,
            arm.forward_kinematics,
            inverse,
            self.limits,
            tool,
            turn_tolerance=5e-3 if turns else None,
            jacobian=arm.jacobian,
        )

    def _checked(self, done: Handled, doing: str) -> Handled:
        """Add how the object moved in the hand; failure if it is lost."""
        if self._slip is None or not done.success:
            return done
        slip = self._slip.measure(self.world.state())
        if slip.lost:
            return Handled(False, f"dropped: the object left the hand while {doing}", slip)
        return replace(done, slip=slip)

    def _move_fingers(self, opening: float) -> None:
        """Close or open the fingers and wait until they have."""
        self._open_to(opening)
        before = np.inf
        for _ in range(round(SLOWEST / LOOK_AGAIN)):
            wait(self.world, LOOK_AGAIN, self._openings)
            now = self.world.state().arms[self._number].gripper_opening
            if abs(now - before) < STILL:
                break
            before = now
        wait(self.world, PRESS, self._openings)

    def _open_to(self, opening: float) -> None:
        self._openings[self._number] = min(opening, self.arm.gripper.max_opening)

    def _collisions(self) -> CollisionModel:
        """What the arm may hit, with the held object in its hand."""
        things: dict[str, Sequence[Obstacle]] = {}
        without: tuple[int, ...] = ()
        if self._held is not None:
            tool = self.world.state().arms[self._number].pose_tool_in_world
            mine = [each for each in self.world.obstacles(detailed=()) if each.name == str(self._held)]
            things[self.arm_name] = [
                replace(each, pose_obstacle_in_world=_in_frame(tool, each.pose_obstacle_in_world)) for each in mine
            ]
            without = (self._held,)
        around = self.world.obstacles(detailed=(), without=without)
        return CollisionModel(self.world.placed_robot, around, things, moving=[self.arm_name])

    def _why(self, model: CollisionModel, reason: str, goal: FloatArray) -> str:
        """A planner's reason, with what is near where it names the start or the goal."""
        if "collision" not in reason:
            return reason
        whole = self.world.commanded_positions
        if reason.startswith("goal"):
            whole[self._joints] = goal
        near = model.nearest(whole, dict(zip(self.world.robot.arms, self._openings, strict=True)))
        return f"{reason}: {near.first} and {near.second} {1000 * near.distance:.1f} mm apart"

    def _free(self, model: CollisionModel, q: FloatArray, margin: float, opening: float | None = None) -> bool:
        """Whether the robot with this arm at a posture is free."""
        whole = self.world.commanded_positions
        whole[self._joints] = q
        gap = self._openings[self._number] if opening is None else opening
        openings = dict(zip(self.world.robot.arms, self._openings, strict=True)) | {self.arm_name: gap}
        return model.free(whole, openings, margin)


def _moved(pose: Pose, by: FloatArray) -> Pose:
    return Pose(pose.position + by, pose.orientation_xyzw)


def _in_frame(frame: Pose, pose: Pose) -> Pose:
    """A pose in the world, seen from a frame in the world."""
    back = rotation_matrix(frame.orientation_xyzw).T
    return Pose(back @ (pose.position - frame.position), quaternion_xyzw(back @ rotation_matrix(pose.orientation_xyzw)))
