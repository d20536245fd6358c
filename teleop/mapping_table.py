"""What each stick, button and key does, as rows for people: the README and the page show them."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .control_expression import Chord, Sum
from .devices.keyboard import KeyTable, keys_to_gamepad
from .drive_mapping import DriveMapping
from .gamepad import BUTTONS, GamepadState

if TYPE_CHECKING:
    from robots.model import RobotModel

_MOTIONS = {
    "x": "away / back (x)",
    "y": "left / right (y)",
    "z": "up / down (z)",
    "roll": "turn about x",
    "pitch": "turn about y",
    "yaw": "turn about z",
    "jog": "move the chosen joint",
    "drive": "drive forward / back",
    "turn": "drive left / right",
}
_ACTIONS = {
    "gripper_close": "close the gripper",
    "gripper_open": "open the gripper",
    "enable": "hold to move",
    "stop": "emergency stop",
    "release": "release the emergency stop",
    "choose_left": "choose the left arm",
    "choose_right": "choose the right arm",
    "choose_both": "choose both arms",
    "next_arm": "choose the next arm",
    "mode": "drive the wheels or the arm",
    "frame": "change the frame: {frames}",
    "jog": "joint by joint, or the tool",
    "joint_next": "next joint, when joint by joint",
    "joint_previous": "previous joint, when joint by joint",
    "speed_up": "faster",
    "speed_down": "slower",
    "record": "start or stop recording",
    "discard": "discard the recording",
    "redo": "discard it and record again",
    "success": "label it a success",
    "failure": "label it a failure",
    "trim": "trim it",
}
_WAYS = {"x": ("right", "left"), "y": ("down", "up")}
_NAMES = {"up": "pad up", "down": "pad down", "left": "pad left", "right": "pad right"}
_NAMES |= {"left_stick": "left stick pressed", "right_stick": "right stick pressed"}


@dataclass(frozen=True, slots=True)
class MappingRow:
    """One line of the table.

    Attributes:
        action: What happens; the two directions of a motion are written as one.
        pad: What to do on a gamepad.
        keys: What to press on a keyboard; empty when no key does it.
    """

    action: str
    pad: str
    keys: str


def describe(robot: "RobotModel", path: str | Path | None = None) -> tuple[MappingRow, ...]:
    """Describe how a robot is driven.

    Args:
        robot: The robot.
        path: A mapping file; None takes the one that comes with Showtell.

    Raises:
        MappingError: The file is wrong or does not fit the robot.
    """
    return describe_mapping(DriveMapping.load(path, robot), KeyTable.load(path))


def describe_mapping(mapping: DriveMapping, table: KeyTable) -> tuple[MappingRow, ...]:
    """Describe a mapping that is loaded already."""
    alone = {key: keys_to_gamepad({key}, table) for key in table.keys}
    rows = [
        MappingRow(text, _sum_text(mapping.sums[name]), _sum_keys(mapping.sums[name], alone))
        for name, text in _MOTIONS.items()
        if name in mapping.sums
    ]
    frames = ", ".join(mapping.settings.frames)
    rows += [
        MappingRow(
            text.format(frames=frames),
            " or ".join(" + ".join(_name(button) for button in chord) for chord in mapping.chords[name]),
            _chord_keys(mapping.chords[name], alone),
        )
        for name, text in _ACTIONS.items()
        if name in mapping.chords
    ]
    if any(row.keys for row in rows):
        rows.append(MappingRow("slowly", "push less", "shift"))
    return tuple(rows)


def _name(button: str) -> str:
    return _NAMES.get(button, button.upper() if len(button) == 1 else button.replace("_", " "))


def _sum_text(total: Sum) -> str:
    """Sticks first, each with both of its ways; then the buttons that push one way and the other."""
    parts = []
    for term in total:
        if term.is_axis:
            stick, way = term.name.split("_")
            plus, minus = _WAYS[way] if term.factor > 0.0 else _WAYS[way][::-1]
            parts.append(f"{stick} stick {plus} / {minus}")
    ways = [[_name(term.name) for term in total if not term.is_axis and term.factor * sign > 0.0] for sign in (1, -1)]
    if any(ways):
        parts.append(" / ".join(" or ".join(names) or "-" for names in ways))
    return "; ".join(parts)


def _sum_keys(total: Sum, alone: Mapping[str, GamepadState]) -> str:
    """Keys that push one way, then those that push the other."""
    ways: tuple[list[str], list[str]] = ([], [])
    for key, state in alone.items():
        if sum(value > 0.5 for value in state.buttons) > 1:
            continue  # a key that plays a chord moves nothing
        value = sum(
            term.factor * (state.axes[term.index] if term.is_axis else state.buttons[term.index]) for term in total
        )
        if value:
            ways[value < 0.0].append(key)
    return " / ".join(" or ".join(keys) or "-" for keys in ways) if any(ways) else ""


def _chord_keys(chords: tuple[Chord, ...], alone: Mapping[str, GamepadState]) -> str:
    """Keys that play exactly one of the chords."""
    wanted = [set(chord) for chord in chords]
    pressed = {
        key: {name for name, value in zip(BUTTONS, state.buttons, strict=True) if value > 0.5}
        for key, state in alone.items()
    }
    return " or ".join(key for key, names in pressed.items() if names in wanted)
