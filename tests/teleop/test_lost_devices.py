"""Devices at this machine are lost while they drive: the robot stops in time, in simulated time; the demo says so."""

import os
import pty
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from robots import load_robot
from teleop import check_replay, drive_by_hand, load_demo
from teleop.demo_stops import least_time_to_rest
from teleop.devices import Device, Gamepad, TerminalKeyboard
from teleop.devices.terminal_keys import HELD_FOR
from teleop.hand_loop import HandStatus
from teleop.loop_deck import Deck
from teleop.loop_pace import Pace
from tests.teleop.lost_input import PERIOD, ROUNDING, TOLERANCE, check_stops
from tests.teleop.virtual_pads import VirtualPad

SCENES = ("board", "tabletop", "ordering")
LEFT_X, GUIDE, START = 0, 5, 6
BEGINS, LOST, ENDS = 10, 130, 260
"""Control steps: the stick is deflected, the device is lost, the session ends."""


def drive(scene: str, device: Device, folder: Path, act: Callable[[int], None], steps: int = ENDS) -> list[HandStatus]:
    """Record a session in simulated time: before each control step, `act` is what the person does; returns what was
    shown."""
    shown: list[HandStatus] = []
    step = -1

    def clock() -> float:
        nonlocal step
        step += 1
        act(step)
        return 100.0 + step * PERIOD

    deck = Deck(scene, None, 3, folder)
    deck.record()
    drive_by_hand(deck, device, shown.append, seconds=(steps - 0.5) * PERIOD, clock=clock, pace=Pace(0.0))
    return shown


@pytest.mark.parametrize("scene", SCENES)
def test_a_gamepad_that_is_unplugged_stops_the_robot(scene: str, tmp_path: Path) -> None:
    with Gamepad() as device:
        pad = VirtualPad()
        device.poll(0.0)

        def act(step: int) -> None:
            if step == BEGINS:
                pad.axis(LEFT_X, -1.0)
            elif step == LOST:
                pad.unplug()

        shown = drive(scene, device, tmp_path, act)
    (path,) = tmp_path.glob("*.mcap")
    (stop,) = check_stops(path, [f"gamepad {device.info and device.info.name!r} was unplugged: plug it in again"])
    assert (stop.last_input, stop.braking) == (pytest.approx((LOST - 1) * PERIOD), pytest.approx(LOST * PERIOD))
    assert "was unplugged" in shown[-1].report.reason
    assert shown[-1].device == ""
    assert check_replay(path).max_error == 0.0


@pytest.mark.parametrize("scene", SCENES)
def test_a_terminal_that_is_closed_stops_the_robot(scene: str, tmp_path: Path) -> None:
    person, program = pty.openpty()
    with TerminalKeyboard(descriptor=program) as device:

        def act(step: int) -> None:
            if BEGINS <= step < LOST and (step - BEGINS) % 8 == 0:
                os.write(person, b"a")
            elif step == LOST:
                os.close(person)

        shown = drive(scene, device, tmp_path, act)
    os.close(program)
    (path,) = tmp_path.glob("*.mcap")
    (event,) = [each for each in load_demo(path).events if each.text.startswith("lost: the terminal was closed")]
    reason = event.text.removeprefix("lost: ").split("; the last input")[0]
    (stop,) = check_stops(path, [reason])
    assert stop.braking == pytest.approx(LOST * PERIOD)
    assert "the terminal was closed" in shown[-1].report.reason


def test_a_terminal_that_freezes_while_a_key_repeats_stops_the_robot(tmp_path: Path) -> None:
    """A terminal that says nothing any more looks like one whose key was let go.

    Braking begins as soon as for any other lost input, but keeps to the line, as when a stick is let go.
    """
    person, program = pty.openpty()
    last = BEGINS + 8 * ((LOST - BEGINS) // 8)
    with TerminalKeyboard(descriptor=program) as device:

        def act(step: int) -> None:
            if BEGINS <= step <= last and (step - BEGINS) % 8 == 0:  # 30 Hz, as terminals repeat
                os.write(person, b"a")

        drive("board", device, tmp_path, act)
    os.close(program)
    os.close(person)
    (path,) = tmp_path.glob("*.mcap")
    demo = load_demo(path)
    asked, speeds = demo.commands.asked, demo.commands.joint_velocity
    braking = int(np.flatnonzero(asked.any(axis=1))[-1]) + 1
    assert (braking - last) * PERIOD <= 0.1 + ROUNDING
    rest = int(np.flatnonzero(speeds.any(axis=1))[-1]) + 1
    rate = (speeds[braking - 1] - speeds[braking - 2]) / PERIOD
    needed = least_time_to_rest(load_robot("three_dof"), speeds[braking - 1], rate)
    assert needed > 3 * TOLERANCE
    # Straight braking keeps half of the limits in reserve for the joints' curved ways: it takes twice as long.
    assert (rest + 1 - braking) * PERIOD <= 2.0 * needed + 2.0 * TOLERANCE
    tool = np.linalg.norm(demo.commands.executed[braking - 1 :, :3], axis=1)
    assert (tool <= tool[0] + 1e-3).all()  # it only slows down; as much speed may keep the tool on its line


def test_a_key_that_was_pressed_once_is_held_as_long_as_a_terminal_takes_to_repeat(tmp_path: Path) -> None:
    person, program = pty.openpty()
    with TerminalKeyboard(descriptor=program) as device:
        drive("board", device, tmp_path, lambda step: os.write(person, b"a") if step == BEGINS else None)
    os.close(program)
    os.close(person)
    (path,) = tmp_path.glob("*.mcap")
    held = np.flatnonzero(load_demo(path).inputs.axes[:, 0])
    assert (held[0], held[-1]) == (BEGINS, BEGINS + round(HELD_FOR / PERIOD) - 1)


def test_the_emergency_stop_outlives_a_gamepad_that_is_lost_and_comes_back(tmp_path: Path) -> None:
    states: dict[int, bool] = {}
    with Gamepad() as device:
        pad = VirtualPad()
        device.poll(0.0)
        deck = Deck("board", None, 3, tmp_path)
        step = -1

        def clock() -> float:
            nonlocal step, pad
            step += 1
            states[step] = deck.driver.mapping.state.stopped
            match step:
                case 5:
                    pad.button(GUIDE)
                case 10:
                    pad.unplug()
                case 20:
                    pad = VirtualPad()
                    device.poll(0.0)
                    pad.button(START)  # under a hand that takes it up, before anybody has looked
                    pad.axis(LEFT_X, -1.0)
                case 40:
                    pad.button(START, False)
                case 50:
                    pad.button(START)
                case 80:
                    pad.axis(LEFT_X, 0.0)
            return 100.0 + step * PERIOD

        reasons: list[str] = []
        drive_by_hand(
            deck, device, lambda told: reasons.append(told.report.reason), seconds=0.4, clock=clock, pace=Pace(0.0)
        )
        pad.unplug()
    assert [states[each] for each in (5, 7, 12, 25, 45, 52)] == [False, True, True, True, True, False]
    assert any(each.startswith("let go of the sticks first") for each in reasons)
