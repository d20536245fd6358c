"""What a page says of its gamepad and keys: checked, because it comes from outside."""

import math
import threading
from collections.abc import Mapping
from typing import Any

from teleop.gamepad import AXES, BUTTONS, RESTING, GamepadState

from .device import DeviceBase, DeviceReading
from .errors import DeviceError

_SLACK = 1e-3
"""Browsers divide -32768 by 32767: this far beyond the range is rounding, and is cut off."""
MOST_KEYS = 32
"""Keys that a page may say are held."""
LONGEST_KEY = 20
"""Characters of a key's name."""


def from_browser(data: object) -> GamepadState:
    """Check what `navigator.getGamepads()` gave, as JSON.

    Args:
        data: `{"axes": [4 numbers], "buttons": [17 numbers, or objects with a "value"]}`; more keys are refused, save
            what a `Gamepad` has besides.

    Raises:
        DeviceError: Something is missing, too long, no finite number or out of range; names the value and the bound.
    """
    if not isinstance(data, Mapping):
        raise DeviceError(f'a gamepad reading is an object with "axes" and "buttons", got {type(data).__name__}')
    mapping = data.get("mapping", "standard")
    if mapping != "standard":
        raise DeviceError(
            f"the browser knows no standard layout for this gamepad (mapping {str(mapping)[:40]!r}): plug it into the "
            "computer that runs Showtell and describe it in a mapping file"
        )
    axes = _numbers(data, "axes", len(AXES), -1.0)
    buttons = _numbers(data, "buttons", len(BUTTONS), 0.0)
    return GamepadState(axes, buttons)


def keys_from_browser(data: object) -> frozenset[str]:
    """Check a page's list of held keys, named as `KeyboardEvent.key` names them.

    Raises:
        DeviceError: It is no list of short strings.
    """
    if not isinstance(data, list) or len(data) > MOST_KEYS:
        raise DeviceError(f"held keys are a list of at most {MOST_KEYS} names, got {_short(data)}")
    for key in data:
        if not isinstance(key, str) or not 0 < len(key) <= LONGEST_KEY:
            raise DeviceError(f"a key is a name of 1 to {LONGEST_KEY} characters, got {_short(key)}")
    return frozenset("space" if key == " " else key.lower() for key in data)


class RemoteDevice(DeviceBase):
    """A gamepad that others report: the page's server offers what came, the control loop polls; any threads."""

    def __init__(self, name: str = "page") -> None:
        """Nothing has been heard yet.

        Args:
            name: What it is called in messages.
        """
        self._lock = threading.Lock()
        self._reading = DeviceReading(name=name, fault=f"nothing has been heard of the {name} yet")

    def offer(self, gamepad: GamepadState, now: float) -> None:
        """Take what was heard.

        Args:
            gamepad: What it says.
            now: When it was heard [s], of `time.monotonic`.
        """
        with self._lock:
            self._reading = DeviceReading(gamepad, now, True, self._reading.name)

    def lose(self, why: str) -> None:
        """The other end is gone; `offer` brings it back."""
        with self._lock:
            before = self._reading
            self._reading = DeviceReading(RESTING, before.timestamp, False, before.name, why)

    def poll(self, now: float) -> DeviceReading:
        """Say what was heard last, and when."""
        del now  # the timestamp is the time at which it was heard
        with self._lock:
            return self._reading

    def close(self) -> None:
        """Nobody listens any more."""
        self.lose(f"the {self._reading.name} was closed")


def _numbers(data: Mapping[Any, Any], key: str, count: int, lowest: float) -> tuple[float, ...]:
    values = data.get(key)
    if not isinstance(values, list | tuple) or len(values) != count:
        what = f"{len(values)} values" if isinstance(values, list | tuple) else _short(values)
        raise DeviceError(f"{key} must be a list of {count} numbers, got {what}")
    numbers = []
    for index, value in enumerate(values):
        number = value.get("value") if isinstance(value, Mapping) else value
        if isinstance(number, bool) or not isinstance(number, int | float) or not _finite(number):
            raise DeviceError(f"{key}[{index}] must be a finite number, got {_short(number)}")
        if not lowest - _SLACK <= number <= 1.0 + _SLACK:
            raise DeviceError(f"{key}[{index}] is {_short(number)}, allowed {lowest:g}..1")
        numbers.append(min(max(float(number), lowest), 1.0))
    return tuple(numbers)


def _finite(number: float) -> bool:
    """Whether a number is finite; JSON may hold integers that no float can."""
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


def _short(value: object) -> str:
    """A value as text that cannot flood a log."""
    text = repr(value) if not isinstance(value, list | dict | int) or isinstance(value, bool) else ""
    if isinstance(value, int) and not text:
        return str(value) if abs(value) < 10**12 else "a huge integer"
    return text[:40] if text else type(value).__name__
