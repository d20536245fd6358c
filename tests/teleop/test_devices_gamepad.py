import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pygame
import pytest

from robots import load_robot
from teleop.devices import DeviceReading, Gamepad, SdlPads, load_pad_layouts, open_pads
from teleop.drive_mapping import DriveMapping
from teleop.gamepad import AXES, RESTING, GamepadState

from .virtual_pads import ARCADE_STICK, VirtualPad

STEP = 1.0 / 32767.0
"""SDL's axes are 16-bit integers."""
SDL_BUTTONS = (
    "a",
    "b",
    "x",
    "y",
    "back",
    "guide",
    "start",
    "left_stick",
    "right_stick",
    "left_bumper",
    "right_bumper",
    "up",
    "down",
    "left",
    "right",
)
REPOSITORY = Path(__file__).resolve().parent.parent.parent


@pytest.fixture
def pads() -> Iterator[SdlPads]:
    with open_pads() as pads:
        yield pads


@pytest.fixture
def plug(pads: SdlPads) -> Iterator[type[VirtualPad]]:
    """Plug in virtual pads that are unplugged at the end."""
    made: list[VirtualPad] = []

    class Plugged(VirtualPad):
        def __init__(self, *args: int) -> None:
            super().__init__(*args)
            made.append(self)

    yield Plugged
    for pad in made:
        pad.unplug()
    pads.refresh()


def told(device: Gamepad, now: float = 1.0) -> GamepadState:
    """What a device says, which must be there and without fault."""
    reading = device.poll(now)
    assert (reading.connected, reading.fault, reading.timestamp) == (True, "", now)
    return reading.gamepad


@pytest.mark.parametrize(("index", "name"), [(0, "left_x"), (1, "left_y"), (2, "right_x"), (3, "right_y")])
@pytest.mark.parametrize("value", [-1.0, -0.25, 0.5, 1.0])
def test_axes_come_through_sdl(plug: type[VirtualPad], index: int, name: str, value: float) -> None:
    pad = plug()
    with Gamepad() as device:
        told(device)
        pad.axis(index, value)
        expected = [0.0] * len(AXES)
        expected[AXES.index(name)] = value
        assert told(device).axes == pytest.approx(expected, abs=STEP)


@pytest.mark.parametrize(("index", "name"), list(enumerate(SDL_BUTTONS)))
def test_buttons_come_through_sdl(plug: type[VirtualPad], index: int, name: str) -> None:
    pad = plug()
    with Gamepad() as device:
        told(device)
        pad.button(index)
        assert told(device) == GamepadState.from_controls(**{name: 1.0})
        pad.button(index, False)
        assert told(device) == RESTING


@pytest.mark.parametrize(("index", "name"), [(4, "left_trigger"), (5, "right_trigger")])
def test_triggers_go_from_0_to_1(plug: type[VirtualPad], index: int, name: str) -> None:
    pad = plug()
    with Gamepad() as device:
        assert told(device) == RESTING
        for raw, value in ((-1.0, 0.0), (0.0, 0.5), (1.0, 1.0)):  # SDL's virtual triggers rest at -1
            pad.axis(index, raw)
            assert told(device).buttons == pytest.approx(
                GamepadState.from_controls(**{name: value}).buttons, abs=2 * STEP
            )


def test_a_pad_plugged_in_later_is_found(plug: type[VirtualPad]) -> None:
    with Gamepad() as device:
        reading = device.poll(1.0)
        assert not reading.connected
        assert "no gamepad is plugged in" in reading.fault
        pad = plug()
        assert told(device) == RESTING
        pad.axis(0, 1.0)
        assert told(device).axes[0] == 1.0


def test_unplugging_while_driving_is_a_reading_and_brakes(plug: type[VirtualPad]) -> None:
    pad = plug()
    mapping = DriveMapping.load(None, load_robot("three_dof"))
    with Gamepad() as device:
        told(device, 1.0)
        assert not mapping.read(device.poll(1.0), 1.0).fault
        pad.axis(1, -1.0)
        told(device, 1.01)
        assert mapping.read(device.poll(1.01), 1.01).arms["arm"].twist[0] == pytest.approx(0.3, abs=1e-4)
        pad.unplug()
        reading = device.poll(1.02)
        assert reading == DeviceReading(
            RESTING, 1.01, False, "Virtual Controller", "gamepad 'Virtual Controller' was unplugged: plug it in again"
        )
        command = mapping.read(reading, 1.05)
        assert "was unplugged" in command.fault
        assert command.arms == {}
        assert command.age == pytest.approx(0.04)  # 1.05 - 1.01
        # Plugged in again with the stick pushed: it must be let go once.
        again = plug()
        device.poll(1.1)
        again.axis(1, -1.0)
        told(device, 1.2)
        assert "let go of the sticks first: left_y" in mapping.read(device.poll(1.2), 1.2).fault
        again.axis(1, 0.0)
        told(device, 1.3)
        assert not mapping.read(device.poll(1.3), 1.3).fault
        again.axis(1, -1.0)
        told(device, 1.4)
        assert mapping.read(device.poll(1.4), 1.4).arms["arm"].twist[0] > 0.29


def test_another_pad_on_the_table_never_takes_over(plug: type[VirtualPad]) -> None:
    ours, other = plug(), plug()
    with Gamepad() as device:
        told(device)
        assert device.info is not None and device.info.number == ours.number
        other.axis(0, 1.0)
        ours.unplug()
        for now in (1.0, 2.0, 3.0):
            assert not device.poll(now).connected
        back = plug()
        told(device)
        assert device.info is not None and device.info.number == back.number


def test_several_pads_are_chosen_by_place_and_name(plug: type[VirtualPad], pads: SdlPads) -> None:
    first, second = plug(), plug()
    stick = plug(ARCADE_STICK, 2, 4, 1)
    names = [info.name for info in pads.refresh()]
    assert names == ["Virtual Controller", "Virtual Controller", "Virtual Arcade Stick"]
    with ExitStack() as stack:
        devices = [stack.enter_context(Gamepad(choice)) for choice in (0, 1, "arcade", 7, "sega")]
        readings = [device.poll(1.0) for device in devices]
        numbers = [device.info.number if device.info else None for device in devices]
    assert numbers == [first.number, second.number, stick.number, None, None]
    assert "no 'gamepad 7'; plugged in are Virtual Controller, Virtual Controller" in readings[3].fault
    assert "no 'gamepad sega'" in readings[4].fault


def test_a_pad_that_sdl_does_not_know_asks_for_a_layout(plug: type[VirtualPad]) -> None:
    plug(ARCADE_STICK, 2, 4, 1)
    with Gamepad() as device:
        reading = device.poll(1.0)
    assert reading.connected
    assert '[pad."Virtual Arcade Stick"]' in reading.fault


def test_an_unknown_pad_is_read_by_its_layout(plug: type[VirtualPad], tmp_path: Path) -> None:
    file = tmp_path / "mapping.toml"
    file.write_text(
        """
        [pad."Virtual Arcade Stick"]
        axes = { left_x = "a1", left_y = "a0~" }
        buttons = { a = "b2", left_trigger = "a2", right_trigger = "-a3", up = "h0.up", left = "h0.left", b = "b9" }
        """,
        encoding="utf-8",
    )
    pad = plug(ARCADE_STICK, 4, 4, 1)
    with Gamepad(layouts=load_pad_layouts(file)) as device:
        told(device)
        pad.axis(0, 1.0)
        pad.axis(1, 0.5)
        pad.axis(2, 0.0)
        pad.axis(3, -0.5)
        pad.button(2)
        pad.hat(0, 1 | 8)  # SDL_HAT_UP | SDL_HAT_LEFT
        state = told(device)
    expected = GamepadState.from_controls(
        left_x=0.5, left_y=-1.0, a=1.0, left_trigger=0.5, right_trigger=0.5, up=1.0, left=1.0
    )
    assert state.axes == pytest.approx(expected.axes, abs=2 * STEP)
    assert state.buttons == pytest.approx(expected.buttons, abs=2 * STEP)


def test_a_layout_goes_before_what_sdl_knows(plug: type[VirtualPad], tmp_path: Path) -> None:
    file = tmp_path / "mapping.toml"
    file.write_text('[pad."Virtual Controller"]\nbuttons = { b = "b0" }\n', encoding="utf-8")
    pad = plug()
    with Gamepad(layouts=load_pad_layouts(file)) as device:
        told(device)
        pad.button(0)
        assert told(device) == GamepadState.from_controls(b=1.0)


def test_raw_input_is_visible(plug: type[VirtualPad], pads: SdlPads) -> None:
    pad = plug(ARCADE_STICK, 2, 3, 1)
    pads.refresh()
    pad.axis(1, 1.0)
    pad.button(2)
    pad.hat(0, 4)  # SDL_HAT_DOWN
    pads.refresh()
    raw = pads.raw(pad.number)
    assert raw is not None
    assert (raw.axes, raw.buttons, raw.hats) == ((0.0, pytest.approx(1.0, abs=2 * STEP)), (0.0, 0.0, 1.0), ((0, -1),))
    pad.unplug()
    pads.refresh()
    assert pads.raw(pad.number) is None
    assert pads.standard(pad.number) is None


def test_a_closed_gamepad_says_so_and_others_go_on(plug: type[VirtualPad]) -> None:
    plug()
    with Gamepad() as first, Gamepad() as second:
        told(first)
        first.close()
        first.close()
        assert first.poll(2.0).fault == "the gamepad was closed"
        told(second)


def test_sdl_leaves_signals_and_stdout_alone() -> None:
    """SDL would turn SIGTERM into an event that nobody reads, and pygame greets on stdout."""
    code = (
        "import os, signal; from teleop.devices import Gamepad\n"
        "with Gamepad() as device: device.poll(0.0); os.kill(os.getpid(), signal.SIGTERM); print('still here')"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=REPOSITORY, capture_output=True, timeout=60, check=False)
    assert done.returncode == -15
    assert done.stdout == b""


def test_a_display_that_cannot_be_reached_is_done_without() -> None:
    code = "from teleop.devices import Gamepad\nwith Gamepad() as device: print(device.poll(0.0).fault)"
    environment = {key: value for key, value in os.environ.items() if key != "SDL_VIDEODRIVER"} | {"DISPLAY": ":4321"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=REPOSITORY, env=environment, capture_output=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert b"no gamepad is plugged in" in done.stdout


def test_sdl_ended_by_other_code_is_a_lost_gamepad(plug: type[VirtualPad]) -> None:
    plug()
    with Gamepad() as device:
        told(device)
        pygame.quit()
        reading = device.poll(2.0)
    assert (reading.connected, reading.timestamp) == (False, 1.0)
