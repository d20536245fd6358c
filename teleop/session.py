"""The one way from a gamepad to the world: mapping, servo, one step. Recording and replay both go through here."""

from twin.state import JointCommand
from twin.world import World

from .gamepad import RESTING, GamepadState
from .gamepad_mapping import GamepadMapping
from .servo import Servo, ServoResult


class Session:
    """Teleoperation of one world.

    Attributes:
        world: The world.
        mapping: Gamepad to twist.
        servo: Twist to joint velocity.
        opening: Wanted gap between the fingers [m]; keeps its value while no gripper button is pressed.
    """

    def __init__(self, world: World, mapping: GamepadMapping | None = None) -> None:
        """Start with the gripper as the scene has it.

        Args:
            world: The world to drive.
            mapping: None takes the usual one.
        """
        self.world = world
        self.mapping = mapping or GamepadMapping()
        self.servo = Servo(world.robot)
        spec = world.spec
        self._gamepad = RESTING
        self._command = self.mapping.command(RESTING)
        self._open = world.robot.gripper.max_opening
        self.opening = 0.0 if spec.gripper_closed or spec.held is not None else self._open

    def step(self, gamepad: GamepadState) -> ServoResult:
        """Map, limit and execute one control step of `World.DT`."""
        if gamepad is not self._gamepad:  # a gamepad reports less often than the arm is controlled
            self._gamepad, self._command = gamepad, self.mapping.command(gamepad)
        command = self._command
        if command.gripper != "keep":
            self.opening = 0.0 if command.gripper == "close" else self._open
        world = self.world
        result = self.servo.step(command, world.joint_positions, world.joint_velocities, world.DT)
        world.step(JointCommand(result.joint_velocity, self.opening))
        return result
