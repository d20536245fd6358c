"""Keys that play a gamepad: the same table for the terminal and the page."""

from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from types import MappingProxyType

from teleop.control_expression import Sum, parse_sum
from teleop.gamepad import AXES, BUTTONS, GamepadState
from teleop.mapping_file import KeyboardSection, read_mapping_file


class KeyTable:
    """Which controls each key plays.

    Attributes:
        slow: Deflection of the axes while shift is held.
        keys: Controls of each key; keys are named as browsers name them, in lower case, and `space`.
    """

    def __init__(self, section: KeyboardSection) -> None:
        """Read a mapping file's section."""
        self.slow = section.slow
        self.keys: Mapping[str, Sum] = MappingProxyType(
            {key: parse_sum(text) for key, text in section.keys.items() if text.strip()}
        )

    @classmethod
    def load(cls, path: str | Path | None = None) -> "KeyTable":
        """Read a mapping file's keys; None takes the one that comes with Showtell.

        Raises:
            MappingError: The file is wrong; names file, key and what is allowed.
        """
        return cls(read_mapping_file(path).keyboard)


def keys_to_gamepad(pressed: Iterable[str], table: KeyTable | None = None) -> GamepadState:
    """Play a gamepad with keys.

    Args:
        pressed: Names of the keys that are held; those that are not in the table do nothing. `shift` deflects sticks
            and triggers less.
        table: None takes the keys that come with Showtell.
    """
    table = table or _usual_keys()
    names = set(pressed)
    size = table.slow if "shift" in names else 1.0
    axes, buttons = [0.0] * len(AXES), [0.0] * len(BUTTONS)
    for name in names:
        for term in table.keys.get(name, ()):
            if term.is_axis:
                axes[term.index] += size * term.factor
            else:  # a button is pressed, however; a trigger a little
                amount = size * term.factor if term.name.endswith("trigger") else term.factor
                buttons[term.index] = max(buttons[term.index], amount)
    return GamepadState(
        tuple(min(max(value, -1.0), 1.0) for value in axes), tuple(min(max(value, 0.0), 1.0) for value in buttons)
    )


def combine(states: Iterable[GamepadState]) -> GamepadState:
    """Several devices in one person's hands: axes add up to -1..1, the furthest pressed button counts.

    A value that no gamepad can send stays one: the fault must be seen.
    """
    all_states = tuple(states)
    for state in all_states:
        if state.fault():
            return state
    axes = (sum(state.axes[index] for state in all_states) for index in range(len(AXES)))
    buttons = (max((state.buttons[index] for state in all_states), default=0.0) for index in range(len(BUTTONS)))
    return GamepadState(tuple(min(max(value, -1.0), 1.0) for value in axes), tuple(buttons))


@cache
def _usual_keys() -> KeyTable:
    return KeyTable.load()
