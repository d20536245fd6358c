import os
import pty
import termios
from collections.abc import Iterator
from dataclasses import dataclass

import pytest

from teleop.devices import DeviceError, TerminalKeyboard
from teleop.devices.terminal_keys import HELD_FOR, LONE_ESCAPE, TerminalKeys
from teleop.gamepad import RESTING, GamepadState


@dataclass
class Terminal:
    """Both ends of a pseudo-terminal."""

    person: int
    program: int


@pytest.fixture
def terminal() -> Iterator[Terminal]:
    person, program = pty.openpty()
    yield Terminal(person, program)
    for end in (person, program):
        try:
            os.close(end)
        except OSError:  # a test closed it
            continue


def test_keys_play_the_gamepad_while_they_are_repeated(terminal: Terminal) -> None:
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        assert keyboard.poll(0.0).gamepad == RESTING
        for now in (0.1, 0.4, 0.7):  # pauses shorter than HELD_FOR
            os.write(terminal.person, b"w")
            reading = keyboard.poll(now)
            assert (reading.gamepad, reading.timestamp) == (GamepadState.from_controls(left_y=-1.0), now)
        assert keyboard.poll(0.7 + HELD_FOR - 0.001).gamepad != RESTING
        assert keyboard.poll(0.7 + HELD_FOR + 0.001).gamepad == RESTING


def test_two_keys_and_arrows_together(terminal: Terminal) -> None:
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        os.write(terminal.person, b"wd\x1b[A c")
        assert keyboard.poll(0.0).gamepad == GamepadState.from_controls(
            left_y=-1.0, left_x=1.0, up=1.0, guide=1.0, a=1.0
        )


def test_capital_letters_are_slow(terminal: Terminal) -> None:
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        os.write(terminal.person, b"W")
        assert keyboard.poll(0.0).gamepad.axes == (0.0, pytest.approx(-0.4), 0.0, 0.0)
        os.write(terminal.person, b"w")
        assert keyboard.poll(0.01).gamepad == GamepadState.from_controls(left_y=-1.0)


def test_the_terminal_is_put_back_as_it_was(terminal: Terminal) -> None:
    before = termios.tcgetattr(terminal.program)
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        during = termios.tcgetattr(terminal.program)
        assert not during[3] & (termios.ICANON | termios.ECHO)
        assert during[3] & termios.ISIG  # Ctrl-C still interrupts
    assert termios.tcgetattr(terminal.program) == before
    reading = keyboard.poll(1.0)
    assert (reading.connected, reading.fault) == (False, "the keyboard was closed")


def test_the_mode_is_taken_again_after_the_background(terminal: Terminal) -> None:
    before = termios.tcgetattr(terminal.program)
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        keyboard.poll(0.0)
        termios.tcsetattr(terminal.program, termios.TCSANOW, before)  # as a shell does when a job is stopped
        keyboard.poll(60.0)
        os.write(terminal.person, b"w")
        assert keyboard.poll(60.01).gamepad == GamepadState.from_controls(left_y=-1.0)


def test_a_closed_terminal_is_a_reading(terminal: Terminal) -> None:
    with TerminalKeyboard(descriptor=terminal.program) as keyboard:
        os.write(terminal.person, b"w")
        keyboard.poll(1.0)
        os.close(terminal.person)
        for now in (1.1, 1.2):
            reading = keyboard.poll(now)
            assert (reading.gamepad, reading.connected, reading.timestamp) == (RESTING, False, 1.0)
            assert "the terminal was closed" in reading.fault


def test_what_is_no_terminal_is_refused() -> None:
    read, write = os.pipe()
    try:
        with pytest.raises(DeviceError, match="needs a terminal"):
            TerminalKeyboard(descriptor=read)
    finally:
        os.close(read)
        os.close(write)


@pytest.mark.parametrize(
    ("data", "keys"),
    [
        (b"\x1b[B", {"arrowdown"}),
        (b"\x1bOC", {"arrowright"}),
        (b"\x1b[1;2D", {"arrowleft", "shift"}),
        (b"\r", {"enter"}),
        (b"\t", {"tab"}),
        (b"\x7f", {"backspace"}),
        (b"\xff\x00\x01", set()),  # no key
        (b"\x1b[3~q", {"q"}),  # Delete is none of ours
        (b"1+", {"1", "+"}),
    ],
)
def test_bytes_of_keys(data: bytes, keys: set[str]) -> None:
    terminal_keys = TerminalKeys()
    terminal_keys.feed(data, 0.0)
    assert terminal_keys.held(0.0) == keys


def test_a_lone_escape_is_a_key_but_a_split_arrow_is_an_arrow() -> None:
    keys = TerminalKeys()
    keys.feed(b"\x1b", 0.0)
    assert keys.held(0.0) == set()
    keys.feed(b"[A", 0.004)
    assert keys.held(0.004) == {"arrowup"}
    keys.feed(b"\x1b", 1.0)
    keys.feed(b"", 1.0 + LONE_ESCAPE + 0.001)
    assert keys.held(1.0 + LONE_ESCAPE + 0.001) == {"escape"}


def test_endless_sequences_are_given_up() -> None:
    keys = TerminalKeys()
    keys.feed(b"\x1b[" + b"1;" * 5000, 0.0)
    keys.feed(b"w", 0.001)
    assert "w" in keys.held(0.001)
