"""Input devices: each says what a gamepad says, in W3C's standard layout, when it said so, and whether it is there.

- `Device` is what all of them do: `poll(now)` gives a `DeviceReading`. Losing a device is a reading, not an exception.
- `Gamepad` is one that is plugged in (through SDL), `TerminalKeyboard` the keys of a terminal, `RemoteDevice` one that
  a page reports (`from_browser` and `keys_from_browser` check what comes), `ScriptedDevice` an operator made of code.
- `keys_to_gamepad` plays a gamepad with keys after a `KeyTable`; `combine` joins devices in one person's hands.
- `DeviceError` says why a device cannot be opened, or what is wrong with what a page sent.

SDL and the twin load when a name that needs them is first used.
"""

from typing import TYPE_CHECKING, Any

from .browser import RemoteDevice, from_browser, keys_from_browser
from .device import Device, DeviceReading
from .errors import DeviceError
from .keyboard import KeyTable, combine, keys_to_gamepad

if TYPE_CHECKING:
    from .gamepad import Gamepad, PadLayout, load_pad_layouts, standard_state
    from .scripted import ScriptedDevice
    from .sdl_pads import PadInfo, SdlPads, open_pads
    from .terminal import TerminalKeyboard

_LAZY = {
    "Gamepad": "gamepad",
    "PadInfo": "sdl_pads",
    "PadLayout": "gamepad",
    "ScriptedDevice": "scripted",
    "SdlPads": "sdl_pads",
    "TerminalKeyboard": "terminal",
    "load_pad_layouts": "gamepad",
    "open_pads": "sdl_pads",
    "standard_state": "gamepad",
}

__all__ = [
    "Device",
    "DeviceError",
    "DeviceReading",
    "Gamepad",
    "KeyTable",
    "PadInfo",
    "PadLayout",
    "RemoteDevice",
    "ScriptedDevice",
    "SdlPads",
    "TerminalKeyboard",
    "combine",
    "from_browser",
    "keys_from_browser",
    "keys_to_gamepad",
    "load_pad_layouts",
    "open_pads",
    "standard_state",
]


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
