"""SDL's own virtual joysticks, plugged into SDL by ctypes: the real path, without any device and without uinput."""

import ctypes
from pathlib import Path

import pygame

GAMEPAD, ARCADE_STICK = 1, 3  # SDL_JoystickType
GAMEPAD_AXES, GAMEPAD_BUTTONS = 6, 15  # the layout that SDL knows for a virtual game controller


def _library() -> ctypes.CDLL:
    """The SDL that pygame has loaded: its wheel's, or the system's."""
    bundled = sorted((Path(pygame.__file__).parent.parent / "pygame_ce.libs").glob("libSDL2-2*"))
    library = ctypes.CDLL(str(bundled[0]) if bundled else "libSDL2-2.0.so.0")
    library.SDL_JoystickFromInstanceID.restype = ctypes.c_void_p
    library.SDL_JoystickSetVirtualAxis.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_int16)
    library.SDL_JoystickSetVirtualButton.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8)
    library.SDL_JoystickSetVirtualHat.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_uint8)
    return library


class VirtualPad:
    """A joystick that SDL believes in. Attach it while SDL's joysticks are started."""

    def __init__(
        self, kind: int = GAMEPAD, axes: int = GAMEPAD_AXES, buttons: int = GAMEPAD_BUTTONS, hats: int = 0
    ) -> None:
        self._sdl = _library()
        index = self._sdl.SDL_JoystickAttachVirtual(kind, axes, buttons, hats)
        assert index >= 0
        self.number = int(self._sdl.SDL_JoystickGetDeviceInstanceID(index))

    def axis(self, index: int, value: float) -> None:
        assert self._sdl.SDL_JoystickSetVirtualAxis(self._pad(), index, round(value * 32767)) == 0

    def button(self, index: int, pressed: bool = True) -> None:
        assert self._sdl.SDL_JoystickSetVirtualButton(self._pad(), index, int(pressed)) == 0

    def hat(self, index: int, bits: int) -> None:
        assert self._sdl.SDL_JoystickSetVirtualHat(self._pad(), index, bits) == 0

    def unplug(self) -> None:
        for index in range(self._sdl.SDL_NumJoysticks()):
            if self._sdl.SDL_JoystickGetDeviceInstanceID(index) == self.number:
                assert self._sdl.SDL_JoystickDetachVirtual(index) == 0
                return

    def _pad(self) -> int:
        pad = self._sdl.SDL_JoystickFromInstanceID(self.number)
        assert pad, "no device has opened this pad yet"
        return int(pad)
