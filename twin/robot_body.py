"""A robot in physics: its joints follow commanded velocities, its fingers close by limited force, its wheels roll."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.arm_model import ArmModel
from robots.hand_dynamics import HandDynamics, Load
from robots.kinematics import rotation_matrix
from robots.model import RobotModel
from robots.pose import FloatArray, Pose

from .physics import Physics

FINGER_FRICTION = 1.0
GEAR_FORCE = 200.0
"""Force [N] that keeps a pair of fingers together: large beside what an object can resist with."""
DEFAULT_FORCE = 200.0
"""Force [N, Nm] of a joint for which neither robot.toml nor the URDF gives one."""
LEAD = 0.02
"""How far [rad] a joint's target may run ahead of a joint that something blocks."""
TOUCH = 0.0005
"""Fingers closer than this [m] to an object touch it."""
WHEEL_FRICTION = 1.0
TIP_FORCE = 1.5
"""Torque [Nm] with which the tendons of passive finger tips hold them."""
WHEEL_TORQUE = 40.0
"""Torque [Nm] of a wheel's motor."""
PARK_AFTER = 0.5
"""Time [s] after the last command to the base at which its parking brake closes, as the real base stops then."""
BRAKE_FORCE = 300.0
"""Force [N, Nm] of the parking brake: a constraint to the floor. Without it the wheels' friction, which Bullet solves
anew in each step, lets the base creep by 1.4 mm in a minute of arm motion at full speed."""


@dataclass(slots=True)
class _Hand:
    """One gripper: its joints, the links of each finger, and what it was told."""

    arm: ArmModel
    fingers: list[int]
    finger_links: tuple[list[int], list[int]]
    passive: list[tuple[int, int, int]]  # joint, source finger (0 or 1), index into the robot's finger mimics
    tool: int
    links: frozenset[int]  # all behind the last joint
    opening: float = 0.0


@dataclass(frozen=True, slots=True)
class RobotMemory:
    """What a saved state of physics lacks.

    Attributes:
        target: Joint targets, (n,) [rad].
        openings: Commanded gap between the fingers of each arm [m].
        parked: Whether the base's parking brake was on.
        standing: Time for which the base was told to stand [s].
        efforts: Of all driven joints, then fingers, in the last step [Nm or N].
        wrist_wrenches: What each arm's wrist felt then, (6,) [N, Nm].
    """

    target: tuple[float, ...]
    openings: tuple[float, ...]
    parked: bool
    standing: float
    efforts: tuple[float, ...]
    wrist_wrenches: tuple[FloatArray, ...]


class RobotBody:
    """The robot's motors and sensors. Arrays follow `RobotModel.joint_names`; openings follow its arms."""

    def __init__(self, physics: Physics, robot: RobotModel) -> None:
        """Load the robot; `place` it before the first step."""
        self._physics = physics
        self.robot = robot
        pose = robot.pose_base_in_world
        self.body = physics.add_robot(
            robot.urdf_path,
            (tuple(pose.position.tolist()), tuple(pose.orientation_xyzw.tolist())),
            fixed=robot.drive is None,
        )
        joints, links = physics.joints(self.body), physics.links(self.body)
        self._joints = joints
        self._driven = [joints[name] for name in robot.joint_names]
        self._count = len(self._driven)
        arm_mimic = [each for arm in robot.arms.values() for each in arm.mimic]
        self._passive = [(joints[each.joint], robot.joint_names.index(each.source), each) for each in arm_mimic]
        self._moved = self._driven + [joint for joint, *_ in self._passive]
        given = [force for arm in robot.arms.values() for force in arm.motor_force]
        self._forces = [
            force or physics.joint_force(self.body, joint) or DEFAULT_FORCE
            for force, joint in zip(given + [0.0] * len(self._passive), self._moved, strict=True)
        ]
        self._hands = [self._hand(arm, joints, links) for arm in robot.arms.values()]
        self._fingers = [finger for hand in self._hands for finger in hand.fingers]
        self._sensed = self._driven + self._fingers
        self._lower, self._upper = robot.lower.tolist(), robot.upper.tolist()
        self._limit = robot.velocity.tolist()
        self._wheels = [joints[name] for name in robot.drive.wheels] if robot.drive else []
        if robot.drive is not None:
            for wheel in self._wheels:
                # Without an anchor: it would hold a wheel back as it rolls, by up to a radian in a turn.
                physics.set_friction(self.body, wheel, WHEEL_FRICTION)
            for roller in robot.drive.rollers:
                physics.set_friction(self.body, links[roller], 0.0)
        self._wheel_speeds = [0.0, 0.0]
        self.base_twist = (0.0, 0.0)
        self._brake: int | None = None
        self._standing = 0.0
        for name, position in robot.locked.items():
            physics.reset_joint(self.body, joints[name], position)
            physics.drive(self.body, [joints[name]], [position], [DEFAULT_FORCE])
        self.target = robot.home.tolist()
        self._states: list[tuple[float, float, float]] = []
        self._before: list[tuple[float, float, float]] = []
        self._twist = self._twist_before = np.zeros(6)
        self._dynamics = HandDynamics(robot)
        self._sensed_names = [*robot.joint_names, *(name for arm in robot.arms.values() for name in arm.gripper.joints)]
        self._wrenches: tuple[FloatArray, ...] | None = None

    def _hand(self, arm: ArmModel, joints: dict[str, int], links: dict[str, int]) -> _Hand:
        physics, gripper = self._physics, arm.gripper
        fingers = [joints[name] for name in gripper.joints]
        finger_links = physics.links_behind(self.body, fingers[0]), physics.links_behind(self.body, fingers[1])
        for link in finger_links[0] + finger_links[1]:
            # Without the anchor a held block creeps by about 1 mm in 3 s, and turns.
            physics.set_friction(self.body, link, FINGER_FRICTION, spinning=gripper.spinning, anchored=True)
        way = gripper.open - gripper.closed
        physics.gear(self.body, fingers[0], fingers[1], -float(way[0] / way[1]), GEAR_FORCE)
        passive = [
            (joints[each.joint], gripper.joints.index(each.source), number)
            for number, each in enumerate(self.robot.finger_mimic)
            if each.source in gripper.joints
        ]
        tool = links[arm.tool_frame]
        behind = frozenset(physics.links_behind(self.body, physics.moving_joint_of(self.body, tool)))
        return _Hand(arm, fingers, finger_links, passive, tool, behind, gripper.max_opening)

    @property
    def openings(self) -> tuple[float, ...]:
        """Commanded gaps [m]."""
        return tuple(hand.opening for hand in self._hands)

    def place(self, q: FloatArray, openings: Sequence[float], commanded: Sequence[float]) -> None:
        """Put the robot at rest at a posture (n,) [rad] with gaps between the fingers [m], and command other gaps."""
        gaps = {hand.arm.name: opening for hand, opening in zip(self._hands, openings, strict=True)}
        for name, position in self.robot.expand(q, gaps).items():
            self._physics.reset_joint(self.body, self._joints[name], position)
        self._resume(q.tolist(), commanded)

    def memory(self) -> RobotMemory:
        """What physics does not keep when its state is saved."""
        efforts = tuple(effort for _, _, effort in self._states)
        return RobotMemory(
            tuple(self.target), self.openings, self.parked, self._standing, efforts, self._all_wrist_wrenches()
        )

    def resume(self, memory: RobotMemory) -> None:
        """Take up what was going on, after physics was restored; the brake is put on by then."""
        self._resume(memory.target, memory.openings)
        self._standing = memory.standing
        self._states = [
            (position, speed, effort) for (position, speed, _), effort in zip(self._states, memory.efforts, strict=True)
        ]
        self._wrenches = memory.wrist_wrenches

    def _resume(self, target: Sequence[float], openings: Sequence[float]) -> None:
        self.target = list(target)
        for hand, opening in zip(self._hands, openings, strict=True):
            hand.opening = opening
        self.sense()
        self.sense()  # nothing has happened in between
        self._drive()
        for number in range(len(self._hands)):
            self._drive_fingers(number)
        self._drive_wheels()

    def command(
        self, velocity: Sequence[float], openings: Sequence[float], base_twist: tuple[float, float], duration: float
    ) -> None:
        """Command what to do in the coming step.

        Args:
            velocity: Of the driven joints, (n,) [rad/s].
            openings: Gap of each arm's fingers [m].
            base_twist: Speed [m/s] and turning speed [rad/s] of the base.
            duration: Length of the step [s].
        """
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
        for number, (hand, opening) in enumerate(zip(self._hands, openings, strict=True)):
            if opening != hand.opening:
                hand.opening = opening
                self._drive_fingers(number)
            elif hand.passive:
                self._drive_tips(number)
        if self._wheels:
            self._steer(base_twist, duration)

    def sense(self) -> None:
        """Read the joints; after every step."""
        self._before, self._states = self._states, self._physics.joint_states(self.body, self._sensed)
        if self._wheels:
            self._twist_before, self._twist = self._twist, self._physics.base_twist(self.body)
        self._wrenches = None

    @property
    def q(self) -> FloatArray:
        """Measured positions of the driven joints, (n,) [rad]."""
        return np.array([state[0] for state in self._states[: self._count]])

    @property
    def dq(self) -> FloatArray:
        """Measured velocities of the driven joints, (n,) [rad/s]."""
        return np.array([state[1] for state in self._states[: self._count]])

    @property
    def effort(self) -> FloatArray:
        """Motor efforts of the driven joints in the last step, (n,) [Nm or N]."""
        return np.array([state[2] for state in self._states[: self._count]])

    def measured_opening(self, number: int) -> float:
        """Gap between the fingers of an arm [m]."""
        first, second = self._states[self._count + 2 * number : self._count + 2 * number + 2]
        return self._hands[number].arm.gripper.opening_at(first[0], second[0])

    def finger_effort(self, number: int) -> tuple[float, float]:
        """Motor efforts of an arm's two fingers in the last step [N or Nm]."""
        first, second = self._states[self._count + 2 * number : self._count + 2 * number + 2]
        return first[2], second[2]

    def tool(self, number: int) -> Pose:
        """Pose of an arm's tool frame in the world."""
        position, orientation = self._physics.link_pose(self.body, self._hands[number].tool)
        return Pose(np.array(position), np.array(orientation))

    def wrist_wrench(self, number: int) -> FloatArray:
        """What the hand and what it holds pull at an arm's last joint, (6,): force [N] then torque [Nm], world's axes.

        The torque is about the joint. A hand at rest shows its weight, downwards.
        """
        return self._all_wrist_wrenches()[number]

    def _all_wrist_wrenches(self) -> tuple[FloatArray, ...]:
        """Computed when asked for. What Bullet measures itself leaves out the force that couples the fingers."""
        if self._wrenches is None:
            step = self._physics.time_step
            joints = {
                name: (now[0], now[1], (now[1] - before[1]) / step)
                for name, now, before in zip(self._sensed_names, self._states, self._before, strict=True)
            }
            self._dynamics.move(joints, self.base(), self._twist, (self._twist - self._twist_before) / step)
            self._wrenches = tuple([self._wrist_wrench(number) for number in range(len(self._hands))])
        return self._wrenches

    def _wrist_wrench(self, number: int) -> FloatArray:
        """What is held moves with the hand, so that its own weight counts, and what else touches it."""
        hand, physics = self._hands[number], self._physics
        loads, held = [], set()
        for body in self.between_fingers(number):
            mass, (centre, axes), moments = physics.mass_of(body)
            if mass > 0.0:
                turn = rotation_matrix(np.array(axes))
                loads.append(Load(mass, np.array(centre), turn @ np.diag(moments) @ turn.T))
                held.add(body)
        pushes = [
            each for each in physics.contact_forces(self.body) if each.link in hand.links and each.other not in held
        ]
        for body in held:
            pushes += [
                each
                for each in physics.contact_forces(body)
                if not (each.other == self.body and each.other_link in hand.links)
            ]
        return self._dynamics.wrench(hand.arm.name, loads, [(each.point, each.force) for each in pushes])

    def base(self) -> Pose:
        """Pose of the base frame in the world."""
        if self.robot.drive is None:
            return self.robot.pose_base_in_world
        position, orientation = self._physics.base_frame(self.body)
        return Pose(np.array(position), np.array(orientation))

    def between_fingers(self, number: int) -> set[int]:
        """Bodies that both fingers of an arm touch."""
        left, right = self._hands[number].finger_links
        touched = self._touched(left)
        return touched & self._touched(right) if touched else touched

    def _touched(self, links: list[int]) -> set[int]:
        return {body for link in links for body in self._physics.touching(self.body, link, TOUCH)} - {self.body}

    def _drive(self) -> None:
        passive = [each.follow(self.target[source]) for _, source, each in self._passive]
        self._physics.drive(self.body, self._moved, self.target + passive, self._forces)

    def _drive_fingers(self, number: int) -> None:
        hand = self._hands[number]
        gripper = hand.arm.gripper
        for finger, position in zip(hand.fingers, gripper.joints_at(hand.opening), strict=True):
            self._physics.drive_slowly(self.body, finger, position, gripper.force, gripper.closing_speed)
        self._drive_tips(number)

    def _drive_tips(self, number: int) -> None:
        """Passive finger joints follow where their finger is, not where it was told to go."""
        hand = self._hands[number]
        for joint, finger, mimic in hand.passive:
            position = self._states[self._count + 2 * number + finger][0]
            target = self.robot.finger_mimic[mimic].follow(position)
            self._physics.drive(self.body, [joint], [target], [TIP_FORCE])

    def _steer(self, base_twist: tuple[float, float], duration: float) -> None:
        drive = self.robot.drive
        assert drive is not None
        speed = min(max(base_twist[0], -drive.speed), drive.speed)
        turn = min(max(base_twist[1], -drive.yaw_rate), drive.yaw_rate)
        self.base_twist = (speed, turn)
        speeds = [
            (speed - turn * drive.track / 2) / drive.wheel_radius,
            (speed + turn * drive.track / 2) / drive.wheel_radius,
        ]
        if speeds != self._wheel_speeds:
            self._wheel_speeds = speeds
            self._drive_wheels()
        self._standing = 0.0 if any(speeds) else self._standing + duration
        if any(speeds):
            self.unpark()
        elif self._brake is None and self._standing >= PARK_AFTER:
            self.park()

    def park(self) -> None:
        """Put the parking brake on, unless the base has no wheels."""
        if self._wheels and self._brake is None:
            self._brake = self._physics.brake(self.body, BRAKE_FORCE)

    def unpark(self) -> None:
        """Let the parking brake go."""
        if self._brake is not None:
            self._physics.release(self._brake)
            self._brake = None

    @property
    def parked(self) -> bool:
        """Whether the parking brake is on."""
        return self._brake is not None

    def _drive_wheels(self) -> None:
        if self._wheels:
            self._physics.spin(self.body, self._wheels, self._wheel_speeds, WHEEL_TORQUE)
