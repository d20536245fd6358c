"""Which stick, button and key moves what: from a gamepad to what a person wants of the whole robot."""

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from .button_reader import ButtonReader, Presses
from .control_expression import Sum, Term
from .drive_actions import ARM_CHOICES, act
from .drive_command import ArmWish, DriveCommand
from .drive_state import DriveEvent, DriveState
from .gamepad import GamepadState
from .gamepad_mapping import GripperWish
from .mapping_file import ANY, DEFAULT_FILE, MappingError, RobotSection, read_mapping_file
from .stick_shape import shape

if TYPE_CHECKING:
    from robots.model import RobotModel

    from .devices.device import DeviceReading

Step = tuple[DriveState, DriveCommand, tuple[DriveEvent, ...]]

_LINEAR = ("x", "y", "z")
_TURNING = ("roll", "pitch", "yaw")


class DriveMapping:
    """Gamepad to `DriveCommand` for one robot.

    `step` is pure: the same state and gamepad give the same command, so that recorded gamepads can be driven afresh.
    `command` and `read` remember the state in between, for a loop that just drives.

    Sticks have a dead zone and an expo as in `GamepadMapping`. Whenever it might surprise (at the start, after a fault
    or a stop, and when they begin to move another arm, joint, frame or the wheels) the sticks must be let go once
    before they move anything; until then the command carries a fault that says which control is not at rest.

    Attributes:
        robot: Name of the robot.
        arms: Its arms and how many joints each has.
        settings: The robot's section of the mapping file.
        sums: Controls of each axis of motion.
        chords: Buttons of each action.
        state: What `command` remembers.
    """

    def __init__(
        self,
        settings: RobotSection,
        robot: str,
        arms: Mapping[str, int],
        wheels: bool = False,
        source: str = "",
    ) -> None:
        """Fit a section of a mapping file to a robot; `load` finds the section.

        Args:
            settings: The section.
            robot: Name of the robot.
            arms: Joints of each arm; the first is chosen at the start.
            wheels: Whether its base drives.
            source: The file, for messages.

        Raises:
            MappingError: The section asks for what the robot has not.
        """
        self.robot = robot
        self.arms = dict(arms)
        self.settings = settings
        self._source = source or str(DEFAULT_FILE)
        self._wheels = wheels
        self.sums = settings.axes.sums()
        self.chords = settings.buttons.chords()
        self._check()
        self._reader = ButtonReader(self.chords)
        self._acting = frozenset(name for chords in self.chords.values() for chord in chords for name in chord)
        self.state = self.start()
        self._events: list[DriveEvent] = []

    @classmethod
    def load(cls, path: str | Path | None, robot: "RobotModel") -> "DriveMapping":
        """Read a mapping file and take the robot's section, or the section `any` when none has its name.

        Args:
            path: A TOML file that may leave out what is as usual; None takes the one that comes with Showtell.
            robot: The robot.

        Raises:
            MappingError: The file is wrong or does not fit the robot; names file, key, value and what is allowed.
        """
        sections = read_mapping_file(path).robot
        named = robot.name in sections
        settings = sections[robot.name if named else ANY]
        if not named and robot.drive is None:  # what suits any robot includes wheels
            settings = settings.model_copy(
                update={
                    "axes": settings.axes.model_copy(update={"drive": "", "turn": ""}),
                    "buttons": settings.buttons.model_copy(update={"mode": ""}),
                }
            )
        arms = {name: len(arm.joint_names) for name, arm in robot.arms.items()}
        return cls(settings, robot.name, arms, robot.drive is not None, str(path or DEFAULT_FILE))

    def start(self) -> DriveState:
        """Return the state of a gamepad just taken up."""
        return DriveState((next(iter(self.arms)),), frame=self.settings.frames[0])

    def step(self, state: DriveState, gamepad: GamepadState) -> Step:
        """Map what a gamepad says.

        Args:
            state: What is remembered of before.
            gamepad: What it says now.

        Returns:
            What is to be remembered, what the person wants, and what buttons did. Never raises: what a gamepad cannot
            send is named in the command's fault.
        """
        if fault := gamepad.fault():
            # Even a gamepad that cannot be trusted with motion is heard when its stop is pressed.
            stop = "stop" in self._reader.read(gamepad, frozenset(), frozenset()).held
            told = (DriveEvent("stop"),) if stop and not state.stopped else ()
            state = _mistrusted(replace(state, stopped=state.stopped or stop))
            return state, DriveCommand(stop=state.stopped, fault=fault), told
        presses = self._presses(state, gamepad)
        new, events = act(state, presses, self.arms, self.settings.frames)
        wishes = {name: self._value(total, gamepad, presses.spent) for name, total in self._moving(new).items()}
        fault = ""
        if not new.armed:
            fault = "" if new.stopped else self._not_at_rest(new, gamepad, presses.spent)
            new = replace(new, armed=not fault and not new.stopped)
        still = bool(fault) or new.stopped
        command = DriveCommand(
            arms={} if still else self._arm_wishes(new, wishes, _gripper(presses)),
            base=(0.0, 0.0) if still or new.mode == "arm" else self._base(wishes),
            speed_ratio=new.speed_ratio,
            enabled="enable" in presses.held if "enable" in self.chords else True,
            stop=new.stopped,
            fault=fault,
        )
        return new, command, events

    def command(self, gamepad: GamepadState) -> DriveCommand:
        """Map what the gamepad says now, remembering the state; never raises. `take_events` tells what buttons did."""
        self.state, command, events = self.step(self.state, gamepad)
        self._events.extend(events)
        return command

    def read(self, reading: "DeviceReading", now: float) -> DriveCommand:
        """Map a device's reading: `command`, with the reading's age and its fault.

        Args:
            reading: What the device said last.
            now: The time on the clock of its timestamps [s].
        """
        age = max(now - reading.timestamp, 0.0)
        if reading.fault or not reading.connected:
            self.distrust()
            fault = reading.fault or f"{reading.name} is not connected"
            return DriveCommand(stop=self.state.stopped, age=age, fault=fault)
        return replace(self.command(reading.gamepad), age=age)

    def take_events(self) -> tuple[DriveEvent, ...]:
        """Return what buttons did since the last call."""
        events, self._events = tuple(self._events), []
        return events

    # What others than the gamepad may change: the page's buttons

    def distrust(self) -> None:
        """The input is lost: what is pressed or deflected when it comes back does nothing until it was let go."""
        self.state = _mistrusted(self.state)

    def stop(self) -> None:
        """Stop until `release`."""
        self.state = replace(self.state, stopped=True, armed=False)

    def release(self) -> None:
        """Release the emergency stop; the sticks must be let go before they move anything."""
        self.state = replace(self.state, stopped=False, armed=False)

    def choose(self, *arms: str) -> None:
        """Choose the arms that the sticks move.

        Raises:
            MappingError: The robot has no such arm.
        """
        unknown = [name for name in arms if name not in self.arms]
        if unknown or not arms:
            name = repr(unknown[0]) if unknown else "without a name"
            raise MappingError(f"{self.robot} has no arm {name}; its arms are {', '.join(self.arms)}")
        self.state = replace(self.state, arms=tuple(name for name in self.arms if name in arms), armed=False)

    def set_speed(self, ratio: float) -> None:
        """Set the speed ratio.

        Raises:
            MappingError: It is not in 0..1.
        """
        if not 0.0 <= ratio <= 1.0:
            raise MappingError(f"the speed ratio is {ratio!r}, allowed 0..1")
        self.state = replace(self.state, speed_ratio=float(ratio))

    # Buttons and sticks

    def _presses(self, state: DriveState, gamepad: GamepadState) -> Presses:
        """What the buttons say.

        At the first look after a fault nobody has pressed what is down, save the stop: a button that was down already,
        perhaps under another hand, must not release the emergency stop or move the fingers.
        """
        if state.seen:
            return self._reader.read(gamepad, state.held, state.spent)
        found = self._reader.read(gamepad, frozenset(), frozenset())
        return Presses(found.pressed, found.pressed & self._acting, found.held & {"stop"}, frozenset())

    def _moving(self, state: DriveState) -> dict[str, Sum]:
        """The sums of controls that move something now."""
        names = ("drive", "turn") if state.mode == "base" else ("jog",) if state.jogging else _LINEAR + _TURNING
        return {name: self.sums[name] for name in names if name in self.sums}

    def _value(self, total: Sum, gamepad: GamepadState, spent: frozenset[str]) -> float:
        """A sum of shaped controls, -1..1."""
        value = 0.0
        for term in total:
            value += term.factor * self._deflection(term, gamepad, spent)
        return min(max(value, -1.0), 1.0)

    def _not_at_rest(self, state: DriveState, gamepad: GamepadState, spent: frozenset[str]) -> str:
        """Say which control would move something now, or return an empty string."""
        for total in self._moving(state).values():
            for term in total:
                if deflection := self._deflection(term, gamepad, spent):
                    return f"let go of the sticks first: {term.name} is at {deflection:.2f}"
        return ""

    def _deflection(self, term: Term, gamepad: GamepadState, spent: frozenset[str]) -> float:
        if term.name in spent:
            return 0.0
        raw = gamepad.axes[term.index] if term.is_axis else gamepad.buttons[term.index]
        return shape(raw, self.settings.dead_zone, self.settings.expo)

    def _arm_wishes(self, state: DriveState, wishes: dict[str, float], gripper: GripperWish) -> dict[str, ArmWish]:
        settings = self.settings
        if state.mode == "base":
            wish = ArmWish(frame=state.frame, gripper=gripper)
        elif state.jogging:
            jog = (state.joint, settings.jog_speed * wishes.get("jog", 0.0))
            wish = ArmWish(frame=state.frame, gripper=gripper, jog=jog)
        else:
            linear = self._scaled([wishes.get(name, 0.0) for name in _LINEAR], settings.top_speed)
            turning = self._scaled([wishes.get(name, 0.0) for name in _TURNING], settings.turn_speed)
            wish = ArmWish((*linear, *turning), state.frame, gripper)
        return dict.fromkeys(state.arms, wish)

    def _scaled(self, values: list[float], speed: float) -> list[float]:
        """Deflections to speeds; together no faster than `speed`, unless that is each axis's own."""
        length = 1.0 if self.settings.each_axis else max(math.hypot(*values), 1.0)
        return [speed * value / length for value in values]

    def _base(self, wishes: dict[str, float]) -> tuple[float, float]:
        return (
            self.settings.base_speed * wishes.get("drive", 0.0),
            self.settings.base_turn_speed * wishes.get("turn", 0.0),
        )

    # Checks

    def _check(self) -> None:
        chords = self.chords
        where = f"{self._source}: robot.{self.robot}"
        for action, needed in ARM_CHOICES.items():
            missing = [name for name in needed if name not in self.arms]
            if action in chords and missing:
                raise MappingError(
                    f"{where}.buttons.{action}: {self.robot} has no arm {missing[0]!r}; its arms are "
                    f"{', '.join(self.arms)}: use next_arm, or leave it empty"
                )
        if not self._wheels:
            for key, name in (("buttons", "mode"), ("axes", "drive"), ("axes", "turn")):
                if name in (chords if key == "buttons" else self.sums):
                    raise MappingError(f"{where}.{key}.{name}: {self.robot} has no wheels; leave it empty")
        if "stop" in chords and "release" not in chords:
            raise MappingError(f"{where}.buttons.release: empty, but a stop stays until it is released; name a button")


def _mistrusted(state: DriveState) -> DriveState:
    """After a fault: let go of sticks and buttons first; buttons that are up when it is over were not released."""
    return replace(state, armed=False, seen=False)


def _gripper(presses: Presses) -> GripperWish:
    close, open_ = "gripper_close" in presses.held, "gripper_open" in presses.held
    return "keep" if close == open_ else "close" if close else "open"
