"""Motions of one arm of a world: reached by kinematics, checked against collision, played on the twin."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from executor.fingers import Fingers
from executor.follow import follow
from executor.handled import Handled
from executor.holders import holders
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

WAY_CLEARANCE = 0.004
"""Least distance [m] of the arm from everything on free ways."""
LEAST_CLEARANCE = 0.001
"""What is left of it [m] between the postures at which it is looked at."""
TILT = 0.05
"""How far [rad] the tool of an arm that cannot choose its orientation may be from what is asked."""
SAMPLES = 0.05
"""Time [s] between the postures of a straight way at which it is looked at."""


class ArmMotions:
    """Plans motions of one arm and plays them; the other arms stand still.

    Args:
        world: The twin.
        arm: Name of the arm.
        rng: Where the planner's chance comes from.

    Attributes:
        held: Id of the object in the hand, or None: it moves with the hand and may touch it.
    """

    def __init__(self, world: World, arm: str, rng: np.random.Generator) -> None:
        self.world = world
        self.arm_name = arm
        self.joints = world.robot.slice_of(arm)
        self.number = list(world.robot.arms).index(arm)
        self.fingers = Fingers(world, arm)
        self.held: int | None = None
        self._rng = rng

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
        return self.world.commanded_positions[self.joints]

    @property
    def tool(self) -> Pose:
        """Where the tool is told to be, in the world."""
        return self.arm.forward_kinematics(self.q)

    @property
    def wrist_force(self) -> FloatArray:
        """Force that the hand and what it touches pull with at the wrist, axes of the world, (3,) [N]."""
        return self.world.state().arms[self.number].wrist_wrench[:3]

    def around(
        self,
        *,
        detailed: Collection[int] = (),
        without: Collection[int] = (),
        may_touch: Collection[int] = (),
        holding: bool = True,
    ) -> CollisionModel:
        """What the arm may hit, with the held object in its hand.

        Args:
            detailed: Objects to take part by part, with what they lie in; the others are wrapped in convex hulls.
            without: Objects to leave out.
            may_touch: Objects that those links of the hand may touch that are made for it.
            holding: Whether the held object stays in the hand; else it is left out.
        """
        held: dict[str, Sequence[Obstacle]] = {}
        if self.held is not None and not holding:
            without = {*without, self.held}
        elif self.held is not None:
            tool = self.world.state().arms[self.number].pose_tool_in_world
            mine = [each for each in self.world.obstacles(detailed=()) if each.name == str(self.held)]
            held[self.arm_name] = [
                replace(each, pose_obstacle_in_world=_in_frame(tool, each.pose_obstacle_in_world)) for each in mine
            ]
            without = {*without, self.held}
        detailed = {*detailed, *(each for number in detailed for each in holders(self.world, number))}
        return CollisionModel(
            self.world.placed_robot,
            self.world.obstacles(detailed=detailed, without=without),
            held,
            moving=[self.arm_name],
            may_touch=[(link, str(number)) for link in self.arm.gripper.touching for number in may_touch],
        )

    def free(self, model: CollisionModel, q: FloatArray, margin: float, opening: float | None = None) -> bool:
        """Whether the robot with this arm at a posture (n,) [rad] is free by a margin [m]."""
        whole = self.world.commanded_positions
        whole[self.joints] = q
        openings = dict(zip(self.world.robot.arms, self.fingers.openings, strict=True))
        if opening is not None:
            openings[self.arm_name] = opening
        return model.free(whole, openings, margin)

    def touched(self, model: CollisionModel, q: FloatArray, margin: float, opening: float) -> set[str]:
        """Names of what is nearer than a margin [m] to the robot with this arm at a posture (n,) [rad]."""
        whole = self.world.commanded_positions
        whole[self.joints] = q
        openings = {**dict(zip(self.world.robot.arms, self.fingers.openings, strict=True)), self.arm_name: opening}
        return {each.second for each in model.near(whole, margin, openings)}

    def way_free(
        self, model: CollisionModel, way: Trajectory, margin: float, opening: float | None = None, *, back: bool = False
    ) -> bool:
        """Whether all of a straight way is free by a margin [m]; `back` looks at its end first, for ways to things."""
        samples = way.sample(SAMPLES).position
        return all(self.free(model, q, margin, opening) for q in (samples[::-1] if back else samples))

    def reach(self, pose: Pose, near: FloatArray) -> FloatArray | None:
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

    def plan_straight(self, start: FloatArray, pose: Pose, tool: ToolLimits) -> StraightMotion:
        """The tool's straight way from a posture to a pose."""
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

    def plan_free(self, model: CollisionModel, goal: FloatArray, limits: JointLimits) -> MotionPlan:
        """A free way to a posture: searched with some distance to everything, and nowhere with nearly none."""
        return plan_motion(
            self.q,
            goal,
            limits,
            lambda q: self.free(model, q, WAY_CLEARANCE),
            self._rng,
            is_clear=lambda q: self.free(model, q, LEAST_CLEARANCE),
        )

    def play(self, way: Trajectory, until: Callable[[], bool] | None = None) -> bool:
        """Follow a way; returns whether it was stopped by `until`, see `executor.follow.follow`."""
        return follow(self.world, way, self.joints, self.fingers.openings, until)

    def go(self, goal: FloatArray, model: CollisionModel) -> Handled:
        """Go freely to a posture, with the fingers moving on the way."""
        planned = self.plan_free(model, goal, self.limits)
        if not planned.success or planned.trajectory is None:
            return Handled(False, f"no way: {self._why(model, planned.reason, goal)}")
        self.play(planned.trajectory)
        return Handled(True)

    def go_straight(self, pose: Pose, tool: ToolLimits) -> Handled:
        """Go straight to a pose of the tool."""
        planned = self.plan_straight(self.q, pose, tool)
        if planned.trajectory is None:
            return Handled(False, f"no straight way: {planned.reason}")
        self.play(planned.trajectory)
        return Handled(True)

    def _why(self, model: CollisionModel, reason: str, goal: FloatArray) -> str:
        """A planner's reason, with what is near where it names the start or the goal."""
        if "collision" not in reason:
            return reason
        whole = self.world.commanded_positions
        if reason.startswith("goal"):
            whole[self.joints] = goal
        near = model.nearest(whole, dict(zip(self.world.robot.arms, self.fingers.openings, strict=True)))
        return f"{reason}: {near.first} and {near.second} {1000 * near.distance:.1f} mm apart"


def moved(pose: Pose, by: FloatArray) -> Pose:
    """A pose shifted by (3,) [m] in the world."""
    return Pose(pose.position + by, pose.orientation_xyzw)


def _in_frame(frame: Pose, pose: Pose) -> Pose:
    """A pose in the world, seen from a frame in the world."""
    back = rotation_matrix(frame.orientation_xyzw).T
    return Pose(back @ (pose.position - frame.position), quaternion_xyzw(back @ rotation_matrix(pose.orientation_xyzw)))
