"""The one way from a person's wish to the world: look around, limit, one step. Recording and replay both go here."""

from collections.abc import Mapping, Sequence

import numpy as np

import robots.settled_coal  # noqa: F401  (distances the same in every process: see there)
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.obstacle import Obstacle
from robots.pose import Pose
from twin.state import JointCommand
from twin.world import World

from .drive_command import DriveCommand
from .robot_servo import RobotServo
from .servo_result import RobotServoResult, ServoView

LOOK_EVERY = 8
"""Control steps between two looks at where things are and what is held: 30 Hz."""


class DriveSession:
    """Drives one world with a whole robot. The same commands in the same scene give the same states, bit for bit.

    Attributes:
        world: The world.
        servo: What keeps every limit and distance.
    """

    def __init__(self, world: World) -> None:
        """Take a world over as it stands.

        Args:
            world: The world to drive; for a demo that can be simulated afresh, one in which nothing has moved.
        """
        self.world = world
        self._steps = 0
        self.servo = RobotServo(world.robot, *self._around())

    def step(self, command: DriveCommand) -> RobotServoResult:
        """Limit and execute one control step of `World.DT`."""
        world = self.world
        if self._steps and self._steps % LOOK_EVERY == 0:
            self.servo.watch(*self._around())
        self._steps += 1
        view = ServoView(
            q=world.commanded_positions,
            dq=world.joint_velocities,
            openings=dict(zip(world.robot.arms, world.commanded_openings, strict=True)),
            pose_base_in_world=None if world.robot.drive is None else world.base_pose,
        )
        result = self.servo.step(command, view, world.DT)
        openings = [result.openings[name] for name in world.robot.arms]
        speed, turn = result.base_twist.tolist()
        world.step(JointCommand(result.joint_velocity, openings, (speed, turn)))
        return result

    def take_over(self) -> None:
        """Go on in the world as it is, after somebody else moved it: from measured speeds, braked smoothly."""
        self.servo.reset(self.world.commanded_base_twist)
        self.servo.watch(*self._around())

    def _around(self) -> tuple[list[Obstacle], Mapping[str, Sequence[Obstacle]]]:
        """What is around, in the world, and what each arm holds, in its tool's frame."""
        world = self.world
        hands = dict(zip(world.robot.arms, world.state().arms, strict=True))
        holding = {name: hand for name, hand in hands.items() if hand.held is not None}
        if not holding:
            return world.obstacles(), {}
        names = {str(hand.held) for hand in holding.values()}
        things = world.obstacles()
        held = {
            name: [_seen_from(hand.pose_tool_in_world, each) for each in things if each.name == str(hand.held)]
            for name, hand in holding.items()
        }
        return [each for each in things if each.name not in names], held


def _seen_from(frame: Pose, thing: Obstacle) -> Obstacle:
    """The same thing with its pose in a frame."""
    rotation, where = rotation_matrix(frame.orientation_xyzw), thing.pose_obstacle_in_world
    turned = rotation.T @ rotation_matrix(where.orientation_xyzw)
    pose = Pose(rotation.T @ (where.position - frame.position), quaternion_xyzw(np.ascontiguousarray(turned)))
    return Obstacle(thing.name, thing.kind, thing.size, pose, thing.corners)
