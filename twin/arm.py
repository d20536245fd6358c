"""A robot in physics: its joints follow commanded velocities, its fingers close by limited force."""

from collections.abc import Sequence

import numpy as np

from robots.model import RobotModel
from robots.pose import FloatArray, Pose

from .physics import Physics

FINGER_FRICTION = 1.0
GEAR_FORCE = 200.0
"""Force [N] that keeps the pair of fingers centred: large beside what a block can resist with."""
DEFAULT_FORCE = 200.0
"""Force [N, Nm] of a joint for which the URDF gives none."""
LEAD = 0.02
"""How far [rad] a joint's target may run ahead of a joint that something blocks."""
TOUCH = 0.0005
"""Fingers closer than this [m] to a block touch it."""


class Arm:
    """The arm's motors and sensors."""

    def __init__(self, physics: Physics, robot: RobotModel) -> None:
        """Load the robot; `place` it before the first step."""
        self._physics = physics
        self._robot = robot
        pose = robot.pose_base_in_world
        self.body = physics.add_robot(
            robot.urdf_path, (tuple(pose.position.tolist()), tuple(pose.orientation_xyzw.tolist()))
        )
        joints = physics.joints(self.body)
        self._driven = [joints[name] for name in robot.joint_names]
        self._fingers = [joints[name] for name in robot.gripper.joints]
        self._passive = [
            (joints[each.joint], robot.joint_names.index(each.source), each.ratio, each.offset) for each in robot.mimic
        ]
        self._moved = self._driven + [joint for joint, *_ in self._passive]
        self._sensed = self._driven + self._fingers
        self._forces = [physics.joint_force(self.body, joint) or DEFAULT_FORCE for joint in self._moved]
        self._tool = physics.links(self.body)[robot.tool_frame]
        self._count = len(self._driven)
        self._lower, self._upper = robot.lower.tolist(), robot.upper.tolist()
        self._limit = robot.velocity.tolist()
        for finger in self._fingers:
            # Without the anchor a held block creeps by about 1 mm in 3 s, and turns.
            physics.set_friction(self.body, finger, FINGER_FRICTION, anchored=True)
        physics.gear(self.body, self._fingers[0], self._fingers[1], GEAR_FORCE)
        self.target = robot.home.tolist()
        self.opening = robot.gripper.max_opening
        self._states: list[tuple[float, float]] = []

    def place(self, q: FloatArray, opening: float, commanded: float) -> None:
        """Put the arm at rest at a posture (n,) [rad] with a gap between the fingers [m], and command another gap."""
        for name, position in self._robot.expand(q).items():
            self._physics.reset_joint(self.body, self._physics.joints(self.body)[name], position)
        for finger in self._fingers:
            self._physics.reset_joint(self.body, finger, opening / 2)
        self.resume(q.tolist(), commanded)

    def resume(self, target: Sequence[float], opening: float) -> None:
        """Take up motor targets again, when placed or after physics was restored."""
        self.target = list(target)
        self.opening = opening
        self._drive()
        self._drive_fingers()
        self.sense()

    def command(self, velocity: Sequence[float], opening: float, duration: float) -> None:
        """Command velocities of the driven joints [rad/s] for the coming step [s], and the gap of the fingers [m]."""
        moved = False
        for joint, wanted in enumerate(velocity):
            limit, measured = self._limit[joint], self._states[joint][0]
            step = min(max(wanted, -limit), limit) * duration
            # A joint that something blocks must not store up motion.
            target = min(max(self.target[joint] + step, measured - LEAD), measured + LEAD)
            target = min(max(target, self._lower[joint]), self._upper[joint])
            moved |= target != self.target[joint]
            self.target[joint] = target
        if moved:
            self._drive()
        if opening != self.opening:
            self.opening = opening
            self._drive_fingers()

    def sense(self) -> None:
        """Read the joints; after every step."""
        self._states = self._physics.joint_states(self.body, self._sensed)

    @property
    def q(self) -> FloatArray:
        """Measured positions of the driven joints, (n,) [rad]."""
        return np.array([state[0] for state in self._states[: self._count]])

    @property
    def dq(self) -> FloatArray:
        """Measured velocities of the driven joints, (n,) [rad/s]."""
        return np.array([state[1] for state in self._states[: self._count]])

    @property
    def measured_opening(self) -> float:
        """Gap between the fingers [m]."""
        return self._states[self._count][0] + self._states[self._count + 1][0]

    def tool(self) -> Pose:
        """Pose of the tool frame in the world."""
        position, orientation = self._physics.link_pose(self.body, self._tool)
        return Pose(np.array(position), np.array(orientation))

    def between_fingers(self) -> set[int]:
        """Bodies that both fingers touch."""
        left = self._physics.touching(self.body, self._fingers[0], TOUCH)
        return left & self._physics.touching(self.body, self._fingers[1], TOUCH) if left else left

    def _drive(self) -> None:
        passive = [ratio * self.target[source] + offset for _, source, ratio, offset in self._passive]
        self._physics.drive(self.body, self._moved, self.target + passive, self._forces)

    def _drive_fingers(self) -> None:
        gripper = self._robot.gripper
        for finger in self._fingers:
            self._physics.drive_slowly(self.body, finger, self.opening / 2, gripper.force, gripper.closing_speed)
