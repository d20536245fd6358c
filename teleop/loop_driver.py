"""What the control loop drives: the page's sticks, through the mapping and the servo, to a world and onto disk."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

import numpy as np

from robots.pose import FloatArray
from twin.world import World

from .drive_command import DriveCommand
from .drive_mapping import DriveMapping
from .drive_session import DriveSession
from .errors import TeleopError
from .gamepad import RESTING, GamepadState
from .record import STATE_EVERY
from .recorder import Recorder
from .servo_reason import DriveReason
from .servo_result import RobotServoResult

SafetyState = Literal["ok", "slowed", "stopped"]
BOTH, WHEELS = "both", "wheels"
"""What may be chosen besides an arm's name."""
_MOVING = 1e-6
_GATHERING = {DriveReason.NONE, DriveReason.ACCELERATION_LIMIT}
"""A robot that gathers speed or brakes is not held back by anything."""
_AXES = {
    "x": "away and back",
    "y": "left and right",
    "z": "up and down",
    "roll": "roll the hand",
    "pitch": "pitch the hand",
    "yaw": "turn the hand",
    "drive": "wheels: forward and back",
    "turn": "wheels: turn",
    "jog": "single joint: turn it",
}
_BUTTONS = {
    "gripper_close": "close the gripper",
    "gripper_open": "open the gripper",
    "enable": "hold to move",
    "stop": "stop",
    "release": "release the stop",
    "choose_left": "left arm",
    "choose_right": "right arm",
    "choose_both": "both arms",
    "next_arm": "next arm",
    "mode": "arm or wheels",
    "frame": "axes: room, tool, camera",
    "jog": "single joint on and off",
    "joint_next": "next joint",
    "joint_previous": "joint before",
    "speed_up": "faster",
    "speed_down": "slower",
    "record": "record, end, keep",
    "discard": "discard",
    "redo": "record again",
    "success": "it worked",
    "failure": "it failed",
}


@dataclass(frozen=True, slots=True)
class OperatorInput:
    """What the page says at one instant.

    Attributes:
        gamepad: Sticks and buttons, of a gamepad or as keys and touches stand for them.
        enabled: Whether motion is held on; False brakes smoothly to rest.
        age: How old this is [s].
        fault: Why it cannot be trusted; empty when it can.
        arrived: Whether it came since the last control step; otherwise it is an earlier one that still counts.
        camera_xyzw: Orientation in the world of the picture that the person sees, or None where that is not known.
    """

    gamepad: GamepadState = RESTING
    enabled: bool = True
    age: float = 0.0
    fault: str = ""
    arrived: bool = True
    camera_xyzw: tuple[float, float, float, float] | None = None


@dataclass(frozen=True, slots=True)
class DriveReport:
    """What a step did.

    Attributes:
        state: Whether the wish was followed.
        reason: Why not, in plain words; empty when it was.
        asked: Speed asked of the fastest tool [m/s].
        executed: Speed given to it [m/s].
        moving: Whether any joint or the base was commanded to move.
    """

    state: SafetyState
    reason: str
    asked: float = 0.0
    executed: float = 0.0
    moving: bool = False


class RobotDriver:
    """Drives one world from its start, with all arms and wheels of its robot.

    Attributes:
        world: The world.
        mapping: What sticks and buttons mean, and what the person chose.
    """

    def __init__(self, world: World, before: "RobotDriver | None" = None, mapping: Path | None = None) -> None:
        """Take a world over.

        Args:
            world: The world; nothing in it has moved yet.
            before: Whose choices are kept, as far as the robot is the same.
            mapping: File of sticks and buttons; None takes the usual one.

        Raises:
            TeleopError: The file is wrong; names key and value.
        """
        self.world = world
        self.mapping = DriveMapping.load(mapping, world.robot)
        self._session = DriveSession(world)
        self._steps = 0
        if before is not None and before.world.robot.name == world.robot.name:
            self.mapping.state = replace(before.mapping.state, armed=False)

    @property
    def choices(self) -> tuple[str, ...]:
        """What `choose` takes."""
        arms = tuple(self.world.robot.arms)
        return (*arms, *((BOTH,) if len(arms) == 2 else ()), *((WHEELS,) if self.world.robot.drive else ()))

    @property
    def chosen(self) -> str:
        """What the sticks move now."""
        state = self.mapping.state
        return WHEELS if state.mode == "base" else BOTH if len(state.arms) > 1 else state.arms[0]

    @property
    def manner(self) -> str:
        """How they move it, in a few words."""
        state = self.mapping.state
        if state.mode == "base":
            return "wheels"
        whose = f"{self.chosen} arms" if self.chosen == BOTH else f"{state.arms[0]} arm".replace("arm arm", "arm")
        return f"{whose}, joint {state.joint + 1}" if state.jogging else f"{whose}, axes of the {state.frame}"

    def choose(self, name: str) -> None:
        """Choose what the sticks move; they must be let go once before they do.

        Raises:
            TeleopError: There is no such arm, and no wheels.
        """
        if name not in self.choices:
            robot = self.world.robot.name
            raise TeleopError(f"{robot} has nothing called {name!r} to drive; choose one of {', '.join(self.choices)}")
        if name != WHEELS:
            self.mapping.choose(*(self.world.robot.arms if name == BOTH else (name,)))
        self.mapping.state = replace(self.mapping.state, mode="base" if name == WHEELS else "arm", armed=False)

    def step(self, wish: OperatorInput, recorder: Recorder | None = None) -> DriveReport:
        """Do one control step of `World.DT`, and record it."""
        mapping = self.mapping
        if wish.fault:
            mapping.distrust()
            command = DriveCommand(stop=mapping.state.stopped, age=wish.age, fault=wish.fault)
        else:
            command = replace(mapping.command(wish.gamepad), age=wish.age)
            if any(each.frame == "camera" for each in command.arms.values()):
                command = replace(command, camera_xyzw=wish.camera_xyzw)
            if not wish.enabled:
                command = replace(command, enabled=False)
        if recorder is not None and self._steps % STATE_EVERY == 0:
            recorder.state(self._steps, self.world.state())
        result = self._session.step(command)
        if recorder is not None:
            recorder.drive(self._steps, wish.gamepad, command, result, arrived=wish.arrived)
        self._steps += 1
        return report_of(result, command.fault if not command.stop else "")

    def take_over(self) -> None:
        """Go on after somebody else moved the robot; the sticks must be let go once before they move anything."""
        self._session.take_over()
        self.mapping.distrust()

    def last_state(self, recorder: Recorder) -> None:
        """Record the state that the last step led to."""
        recorder.state(self._steps, self.world.state())

    def close(self) -> None:
        """Close the world."""
        self.world.close()


def controls_of(mapping: DriveMapping) -> list[tuple[str, str]]:
    """What each action of a mapping is called, and which controls do it, as its file says."""
    said = [(_AXES[name], text) for name, text in mapping.settings.axes if text and name in _AXES]
    return said + [(_BUTTONS[name], text) for name, text in mapping.settings.buttons if text and name in _BUTTONS]


def report_of(result: RobotServoResult, fault: str) -> DriveReport:
    """A servo's result as the page shows it; a fault is its own reason."""
    speeds = [(_speed(each.asked), _speed(each.executed)) for each in result.arms.values()]
    asked, executed = max(speeds, key=lambda pair: max(pair))
    moving = bool(np.abs(result.joint_velocity).max() > _MOVING or np.abs(result.base_twist).max() > _MOVING)
    state, reason = result.state, fault or result.reason
    if state == "slowed" and {result.base_reason, *(each.reason for each in result.arms.values())} <= _GATHERING:
        state, reason = "ok", ""
    return DriveReport(state, reason, asked, executed, moving)


def _speed(twist: FloatArray) -> float:
    return float(np.linalg.norm(twist[:3]))
