"""The keyboard of a terminal as a gamepad."""

import contextlib
import os
import select
import sys
import termios
import tty

from teleop.gamepad import RESTING

from .device import DeviceBase, DeviceReading
from .errors import DeviceError
from .keyboard import KeyTable, keys_to_gamepad
from .terminal_keys import TerminalKeys

_AT_MOST = 4096
"""Bytes read at one look."""
_AWAY = 0.5
"""After a pause this long between two looks the program may have been in the background [s]."""


class TerminalKeyboard(DeviceBase):
    """Reads keys from a terminal, without waiting for Enter and without echo; Ctrl-C still interrupts.

    The terminal is put back as it was by `close`. See `TerminalKeys` for what a terminal cannot tell.
    """

    def __init__(self, table: KeyTable | None = None, descriptor: int | None = None) -> None:
        """Take the terminal.

        Args:
            table: None takes the keys that come with Showtell.
            descriptor: The terminal's file descriptor; None takes stdin.

        Raises:
            DeviceError: That is not a terminal.
        """
        self._table = table or KeyTable.load()
        self._keys = TerminalKeys()
        self._lost = ""
        self._seen = self._last_look = 0.0
        try:
            self._descriptor = sys.stdin.fileno() if descriptor is None else descriptor
            self._before = termios.tcgetattr(self._descriptor)
            tty.setcbreak(self._descriptor, termios.TCSANOW)
        except (OSError, ValueError, AttributeError, termios.error) as error:
            raise DeviceError(
                "the keyboard needs a terminal, and standard input is none: run in a terminal, or use another device"
            ) from error
        self._open = True

    def held(self, now: float) -> frozenset[str]:
        """Names of the keys that count as held, for a display."""
        return self._keys.held(now)

    def poll(self, now: float) -> DeviceReading:
        """Say which keys count as held; a closed terminal is a reading that is not connected."""
        if not self._lost:
            self._look(now)
        if self._lost:
            return DeviceReading(RESTING, self._seen, False, "keyboard", self._lost)
        self._seen = now
        return DeviceReading(keys_to_gamepad(self._keys.held(now), self._table), now, True, "keyboard")

    def close(self) -> None:
        """Put the terminal back as it was."""
        if self._open:
            self._open = False
            self._lost = self._lost or "the keyboard was closed"
            with contextlib.suppress(OSError, termios.error):  # the terminal may be gone
                termios.tcsetattr(self._descriptor, termios.TCSANOW, self._before)

    def _look(self, now: float) -> None:
        try:
            if now - self._last_look > _AWAY:  # a shell takes its own mode back while we are in the background
                tty.setcbreak(self._descriptor, termios.TCSANOW)
            self._last_look = now
            data = b""
            if select.select([self._descriptor], [], [], 0.0)[0]:
                data = os.read(self._descriptor, _AT_MOST)
                if not data:
                    self._lost = "the terminal was closed"
            self._keys.feed(data, now)
        except (OSError, ValueError, termios.error) as error:
            self._lost = f"the terminal was closed: {error}"
