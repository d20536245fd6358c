"""The door to SDL: which gamepads are plugged in, and what each says. pygame is imported here and nowhere else."""

import os
import threading
from dataclasses import dataclass
from types import TracebackType

from teleop.gamepad import BUTTON_INDEX, GamepadState
from teleop.pad_source import RawInput

from .errors import DeviceError

# Before SDL starts. A gamepad needs no window, and its program is often in the background.
os.environ.setdefault("PYGAME_HIDE_SUPPORT_PROMPT", "1")
os.environ.setdefault("SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS", "1")
os.environ.setdefault("SDL_NO_SIGNAL_HANDLERS", "1")  # or SIGTERM becomes an event that nobody reads
if not os.environ.get("DISPLAY") and not os.environ.get("WAYLAND_DISPLAY"):
    os.environ.setdefault("SDL_VIDEODRIVER", "dummy")

import pygame  # noqa: E402
from pygame._sdl2 import controller  # noqa: E402

_EVENTS = (
    pygame.JOYAXISMOTION,
    pygame.JOYBALLMOTION,
    pygame.JOYHATMOTION,
    pygame.JOYBUTTONDOWN,
    pygame.JOYBUTTONUP,
    pygame.JOYDEVICEADDED,
    pygame.JOYDEVICEREMOVED,
    pygame.CONTROLLERAXISMOTION,
    pygame.CONTROLLERBUTTONDOWN,
    pygame.CONTROLLERBUTTONUP,
    pygame.CONTROLLERDEVICEADDED,
    pygame.CONTROLLERDEVICEREMOVED,
    pygame.CONTROLLERDEVICEREMAPPED,
)
_FULL = 32767.0
_PYGAME = 32768.0 / _FULL  # pygame divides by 32768, so that full deflection would be a little less than 1
_STICKS = (
    pygame.CONTROLLER_AXIS_LEFTX,
    pygame.CONTROLLER_AXIS_LEFTY,
    pygame.CONTROLLER_AXIS_RIGHTX,
    pygame.CONTROLLER_AXIS_RIGHTY,
)
_TRIGGERS = {
    "left_trigger": pygame.CONTROLLER_AXIS_TRIGGERLEFT,
    "right_trigger": pygame.CONTROLLER_AXIS_TRIGGERRIGHT,
}
_BUTTONS = {
    "a": pygame.CONTROLLER_BUTTON_A,
    "b": pygame.CONTROLLER_BUTTON_B,
    "x": pygame.CONTROLLER_BUTTON_X,
    "y": pygame.CONTROLLER_BUTTON_Y,
    "left_bumper": pygame.CONTROLLER_BUTTON_LEFTSHOULDER,
    "right_bumper": pygame.CONTROLLER_BUTTON_RIGHTSHOULDER,
    "back": pygame.CONTROLLER_BUTTON_BACK,
    "start": pygame.CONTROLLER_BUTTON_START,
    "left_stick": pygame.CONTROLLER_BUTTON_LEFTSTICK,
    "right_stick": pygame.CONTROLLER_BUTTON_RIGHTSTICK,
    "up": pygame.CONTROLLER_BUTTON_DPAD_UP,
    "down": pygame.CONTROLLER_BUTTON_DPAD_DOWN,
    "left": pygame.CONTROLLER_BUTTON_DPAD_LEFT,
    "right": pygame.CONTROLLER_BUTTON_DPAD_RIGHT,
    "guide": pygame.CONTROLLER_BUTTON_GUIDE,
}


@dataclass(frozen=True, slots=True)
class PadInfo:
    """A gamepad that is plugged in.

    Attributes:
        number: SDL's number of it, never used again for another one while the program runs; later ones are higher.
        name: What it is called; two may have the same name.
        guid: SDL's identifier of its make.
        axes: How many axes it has, then buttons and hats.
        buttons: See `axes`.
        hats: See `axes`.
        known: Whether SDL knows its layout.
    """

    number: int
    name: str
    guid: str
    axes: int
    buttons: int
    hats: int
    known: bool


class SdlPads:
    """All gamepads that are plugged in, in the order in which they came. Use `open_pads` to get the process's one.

    SDL keeps one list a process, and wants to be asked by one thread.
    """

    _shared: "SdlPads | None" = None
    _users = 0
    _lock = threading.Lock()

    def __init__(self) -> None:
        """Start SDL.

        Raises:
            DeviceError: SDL does not start.
        """
        self._pads: dict[int, tuple[PadInfo, pygame.joystick.JoystickType, controller.Controller | None]] = {}
        self.newest = -1
        try:
            _start_events()
            pygame.joystick.init()
            controller.init()
        except pygame.error as error:
            raise DeviceError(
                f"SDL cannot read gamepads: {error}; without a display set SDL_VIDEODRIVER=dummy"
            ) from error
        for index in range(pygame.joystick.get_count()):
            self._add(index)

    def __enter__(self) -> "SdlPads":
        """Return the gamepads."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close them."""
        self.close()

    def close(self) -> None:
        """One user less; the last one ends SDL's gamepads."""
        with SdlPads._lock:
            if SdlPads._shared is not self:
                return
            SdlPads._users -= 1
            if SdlPads._users > 0:
                return
            SdlPads._shared = None
        self._pads.clear()
        controller.quit()
        pygame.joystick.quit()
        pygame.display.quit()

    def refresh(self) -> tuple[PadInfo, ...]:
        """Hear what SDL has to tell; return the gamepads that are plugged in now."""
        try:
            events = pygame.event.get(_EVENTS)
        except pygame.error:  # other code has ended SDL: every gamepad is lost
            self._pads.clear()
            return ()
        for event in events:
            if event.type == pygame.JOYDEVICEADDED:
                self._add(event.device_index)
            elif event.type == pygame.JOYDEVICEREMOVED:
                self._pads.pop(event.instance_id, None)
        return tuple(info for info, _, _ in self._pads.values())

    def raw(self, number: int) -> RawInput | None:
        """What a gamepad says in its own layout; None when it is gone."""
        if number not in self._pads:
            return None
        pad = self._pads[number][1]
        hats = (pad.get_hat(index) for index in range(pad.get_numhats()))
        return RawInput(
            tuple(max(pad.get_axis(index) * _PYGAME, -1.0) for index in range(pad.get_numaxes())),
            tuple(float(pad.get_button(index)) for index in range(pad.get_numbuttons())),
            tuple((int(right), int(up)) for right, up in hats),
        )

    def standard(self, number: int) -> GamepadState | None:
        """What a gamepad says in W3C's layout; None when it is gone or SDL does not know its layout."""
        known = self._pads[number][2] if number in self._pads else None
        if known is None:
            return None
        buttons = [0.0] * len(BUTTON_INDEX)
        for name, button in _BUTTONS.items():
            buttons[BUTTON_INDEX[name]] = float(known.get_button(button))
        for name, axis in _TRIGGERS.items():
            buttons[BUTTON_INDEX[name]] = min(max(known.get_axis(axis) / _FULL, 0.0), 1.0)
        return GamepadState(tuple(max(known.get_axis(axis) / _FULL, -1.0) for axis in _STICKS), tuple(buttons))

    def _add(self, index: int) -> None:
        try:
            pad = pygame.joystick.Joystick(index)
            number = pad.get_instance_id()
            if number in self._pads:  # it was there when SDL started, and is told of again
                return
            known = controller.Controller(index) if controller.is_controller(index) else None
        except pygame.error:  # unplugged in the meantime: its removal is told too
            return
        name = pad.get_name()
        info = PadInfo(
            number, name, pad.get_guid(), pad.get_numaxes(), pad.get_numbuttons(), pad.get_numhats(), known is not None
        )
        self._pads[number] = (info, pad, known)
        self.newest = max(self.newest, number)


def _start_events() -> None:
    """Start SDL's events, which come with its display; where there is none (also no reachable one) with a dummy."""
    try:
        pygame.display.init()
    except pygame.error:
        os.environ["SDL_VIDEODRIVER"] = "dummy"
        pygame.display.init()


def open_pads() -> SdlPads:
    """Return the process's gamepads, starting SDL for the first user; each user closes them once.

    Raises:
        DeviceError: SDL does not start.
    """
    with SdlPads._lock:
        if SdlPads._shared is None:
            SdlPads._shared = SdlPads()
        SdlPads._users += 1
        return SdlPads._shared
