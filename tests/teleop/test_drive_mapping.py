import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots import list_robots, load_robot
from robots.model import RobotModel
from teleop.devices import DeviceReading
from teleop.drive_command import ArmWish, DriveCommand
from teleop.drive_mapping import DriveMapping
from teleop.drive_state import SPEED_STEPS
from teleop.gamepad import AXES, BUTTONS, RESTING, GamepadState
from teleop.gamepad_mapping import GamepadMapping
from teleop.mapping_file import MappingError, read_mapping_file

ARMS = {"baxter": {"left": 7, "right": 7}, "mico_segway": {"arm": 6}, "three_dof": {"arm": 3}}

STATES = st.builds(
    GamepadState,
    st.tuples(*[st.floats(-1.0, 1.0)] * len(AXES)),
    st.tuples(*[st.sampled_from([0.0, 0.0, 0.3, 1.0])] * len(BUTTONS)),
)


def make(robot: str, path: Path | None = None) -> DriveMapping:
    """A mapping at rest, ready to drive."""
    mapping = DriveMapping(
        read_mapping_file(path).robot[robot], robot, ARMS[robot], robot == "mico_segway", str(path or "")
    )
    assert mapping.command(RESTING) == DriveCommand({next(iter(ARMS[robot])): ArmWish(frame=mapping.state.frame)})
    return mapping


def press(mapping: DriveMapping, *buttons: str) -> tuple[tuple[str, str], ...]:
    """Press buttons one after the other, let go of all, and return what happened."""
    for count in range(1, len(buttons) + 1):
        mapping.command(GamepadState.from_controls(**dict.fromkeys(buttons[:count], 1.0)))
    mapping.command(RESTING)
    return tuple((event.name, event.detail) for event in mapping.take_events())


def wish_fault(mapping: DriveMapping, **controls: float) -> str:
    return mapping.command(GamepadState.from_controls(**controls)).fault


def wish(mapping: DriveMapping, **controls: float) -> ArmWish:
    command = mapping.command(GamepadState.from_controls(**controls))
    assert command.fault == ""
    (only,) = set(command.arms.values())
    return only


def file_with(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "own.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", list_robots())
def test_every_robot_has_its_section(name: str) -> None:
    mapping = DriveMapping.load(None, load_robot(name))
    assert name in read_mapping_file().robot
    assert mapping.arms == ARMS[name]


# What the thesis's operators had


@pytest.mark.parametrize(
    ("controls", "axis", "speed"),
    [
        ({"left_y": -1.0}, 0, 0.05),
        ({"down": 1.0}, 0, -0.05),
        ({"left_x": -1.0}, 1, 0.05),
        ({"right": 1.0}, 1, -0.05),
        ({"right_trigger": 1.0}, 2, 0.05),
        ({"left_trigger": 1.0}, 2, -0.05),
        ({"right_x": 1.0}, 3, 0.3),
        ({"right_y": -1.0}, 4, 0.3),
        ({"x": 1.0}, 5, 0.3),
        ({"y": 1.0}, 5, -0.3),
    ],
)
def test_baxters_controls(controls: dict[str, float], axis: int, speed: float) -> None:
    expected = [0.0] * 6
    expected[axis] = speed
    assert wish(make("baxter"), **controls) == ArmWish(tuple(expected), "world")


@given(STATES)
def test_baxters_tool_is_never_faster_than_top_speed(gamepad: GamepadState) -> None:
    mapping = make("baxter")
    for each in mapping.command(gamepad).arms.values():
        assert math.hypot(*each.twist[:3]) <= 0.05 + 1e-15  # rounding
        assert math.hypot(*each.twist[3:]) <= 0.3 + 1e-15


@given(STATES)
def test_the_board_arm_feels_as_before(gamepad: GamepadState) -> None:
    """Same bits as `GamepadMapping`, while no button changes what the sticks move."""
    quiet = [0.0 if name in ("back", "left_stick", "right_stick", "guide", "start") else 1.0 for name in BUTTONS]
    gamepad = GamepadState(gamepad.axes, tuple(a * b for a, b in zip(gamepad.buttons, quiet, strict=True)))
    before = GamepadMapping().command(gamepad)
    after = wish(make("three_dof"), **dict(zip(AXES + BUTTONS, gamepad.axes + gamepad.buttons, strict=True)))
    assert (after.twist, after.gripper, after.frame) == (before.twist, before.gripper, before.frame)


@pytest.mark.parametrize(
    ("controls", "gripper"), [({"a": 1.0}, "close"), ({"b": 1.0}, "open"), ({"a": 1.0, "b": 1.0}, "keep")]
)
@pytest.mark.parametrize("robot", list(ARMS))
def test_gripper_buttons(robot: str, controls: dict[str, float], gripper: str) -> None:
    assert wish(make(robot), **controls).gripper == gripper


def test_bumpers_choose_the_arm_and_back_with_one_both() -> None:
    mapping = make("baxter")
    assert mapping.state.arms == ("left",)
    assert press(mapping, "right_bumper") == (("arms", "right"),)
    assert list(mapping.command(GamepadState.from_controls(left_y=-1.0)).arms) == ["right"]
    mapping.command(RESTING)
    assert press(mapping, "left_bumper") == (("arms", "left"),)
    assert press(mapping, "left_bumper") == ()
    assert press(mapping, "back", "left_bumper") == (("arms", "left and right"),)  # and nothing is discarded
    command = mapping.command(GamepadState.from_controls(left_y=-1.0, a=1.0))
    assert dict(command.arms) == dict.fromkeys(("left", "right"), ArmWish((0.05, 0, 0, 0, 0, 0), "world", "close"))


def test_the_mode_button_drives_the_wheels() -> None:
    mapping = make("mico_segway")
    assert press(mapping, "left_bumper") == (("mode", "base"),)
    command = mapping.command(GamepadState.from_controls(left_y=-1.0, left_x=1.0, a=1.0))
    assert command.base == (0.3, -0.6)
    assert command.arms["arm"] == ArmWish(frame="base", gripper="close")
    mapping.command(RESTING)
    assert press(mapping, "right_bumper") == (("mode", "arm"),)
    assert mapping.command(GamepadState.from_controls(left_y=-1.0)).base == (0.0, 0.0)


def test_joint_by_joint() -> None:
    mapping = make("mico_segway")
    assert press(mapping, "right_stick") == (("jog", "on"),)
    assert wish(mapping, left_y=-1.0).jog == (0, 0.3)
    mapping.command(RESTING)
    assert press(mapping, "right") == (("joint", "1"),)
    assert press(mapping, "left") == (("joint", "0"),)
    assert press(mapping, "left") == (("joint", "5"),)
    assert wish(mapping, left_y=1.0) == ArmWish(frame="base", jog=(5, -0.3))
    mapping.command(RESTING)
    assert press(mapping, "right_stick") == (("jog", "off"),)
    assert wish(mapping, left_y=-1.0).jog is None


def test_frames_are_gone_through() -> None:
    mapping = make("baxter")
    assert press(mapping, "left_stick") == (("frame", "tool"),)
    assert wish(mapping, left_y=-1.0) == ArmWish((0.05, 0, 0, 0, 0, 0), "tool")
    mapping.command(RESTING)
    assert press(mapping, "left_stick") == (("frame", "camera"),)
    assert wish(mapping, left_y=-1.0) == ArmWish((0.05, 0, 0, 0, 0, 0), "camera")  # away from the viewer
    mapping.command(RESTING)
    assert press(mapping, "left_stick") == (("frame", "world"),)


def test_speed_steps() -> None:
    mapping = make("baxter")
    ratios = []
    for _ in range(len(SPEED_STEPS) + 1):
        press(mapping, "back", "down")
        ratios.append(mapping.state.speed_ratio)
    assert ratios == [*SPEED_STEPS[-2::-1], SPEED_STEPS[0], SPEED_STEPS[0]]
    assert press(mapping, "back", "up") == (("speed", "0.2"),)
    assert mapping.command(RESTING).speed_ratio == 0.2


# Buttons that are held together


@pytest.mark.parametrize(
    ("buttons", "events"),
    [
        (("start",), ("record",)),
        (("back",), ("discard",)),
        (("back", "start"), ("redo",)),
        (("back", "a"), ("success",)),
        (("back", "b"), ("failure",)),
        (("back", "a", "b"), ("success", "failure")),
    ],
)
def test_recording_buttons(buttons: tuple[str, ...], events: tuple[str, ...]) -> None:
    assert press(make("baxter"), *buttons) == tuple((name, "") for name in events)


def test_what_takes_part_in_a_chord_does_nothing_else_until_released() -> None:
    mapping = make("baxter")
    both = mapping.command(GamepadState.from_controls(back=1.0, a=1.0, up=1.0))
    assert both.arms["left"] == ArmWish()
    assert mapping.command(GamepadState.from_controls(a=1.0, up=1.0)).arms["left"] == ArmWish()
    mapping.command(RESTING)
    assert mapping.command(GamepadState.from_controls(a=1.0)).arms["left"].gripper == "close"
    assert [event.name for event in mapping.take_events()] == ["success", "speed"][:1]  # speed was at its top


def test_a_button_that_stays_pressed_acts_once() -> None:
    mapping = make("baxter")
    for _ in range(5):
        mapping.command(GamepadState.from_controls(start=1.0))
    assert [event.name for event in mapping.take_events()] == ["record"]


# Safety


@pytest.mark.parametrize("buttons", [("guide",), ("left_stick", "right_stick"), ("right_stick", "left_stick")])
@pytest.mark.parametrize("robot", list(ARMS))
def test_the_stop_stays_until_it_is_released_and_the_sticks_are_let_go(robot: str, buttons: tuple[str, ...]) -> None:
    mapping = make(robot)
    mapping.command(GamepadState.from_controls(left_y=-1.0, **dict.fromkeys(buttons, 1.0)))
    for _ in range(3):  # pressing it again in panic does not release it
        press(mapping, *buttons)
    command = mapping.command(GamepadState.from_controls(left_y=-1.0))
    assert (command.stop, dict(command.arms), command.base) == (True, {}, (0.0, 0.0))
    assert press(mapping, "back") == (("discard", ""),)
    released = mapping.command(GamepadState.from_controls(left_y=-1.0, start=1.0))
    assert not released.stop
    assert "let go of the sticks first: left_y is at -1.00" in released.fault
    assert [event.name for event in mapping.take_events()] == ["release"]  # and nothing is recorded
    mapping.command(RESTING)
    assert wish(mapping, left_y=-1.0).twist[0] > 0.0


def test_the_stop_works_through_a_held_chord_and_a_held_stick() -> None:
    mapping = make("baxter")
    mapping.command(GamepadState.from_controls(back=1.0, a=1.0))
    assert mapping.command(GamepadState.from_controls(back=1.0, a=1.0, guide=1.0, left_x=0.7)).stop


def test_nothing_moves_before_the_sticks_were_at_rest() -> None:
    mapping = DriveMapping(read_mapping_file().robot["baxter"], "baxter", ARMS["baxter"])
    command = mapping.command(GamepadState.from_controls(left_y=-1.0))
    assert dict(command.arms) == {}
    assert command.fault == "let go of the sticks first: left_y is at -1.00"
    assert mapping.command(RESTING).fault == ""
    assert wish(mapping, left_y=-1.0).twist[0] == 0.05


@pytest.mark.parametrize(
    ("robot", "buttons"),
    [("baxter", ("right_bumper",)), ("mico_segway", ("left_bumper",)), ("baxter", ("right_stick",))],
)
def test_a_held_stick_does_not_move_something_else(robot: str, buttons: tuple[str, ...]) -> None:
    mapping = make(robot)
    held = {"left_y": -1.0}
    assert wish(mapping, **held).twist[0] > 0.0
    for controls in (held | dict.fromkeys(buttons, 1.0), held):  # some act when they are released
        command = mapping.command(GamepadState.from_controls(**controls))
    assert "let go" in command.fault
    assert (dict(command.arms), command.base) == ({}, (0.0, 0.0))


@pytest.mark.parametrize("bad", [{"left_x": math.nan}, {"left_x": 7.0}, {"a": -1.0}])
def test_what_no_gamepad_sends_is_a_fault_and_the_sticks_must_be_let_go(bad: dict[str, float]) -> None:
    mapping = make("baxter")
    command = mapping.command(GamepadState.from_controls(left_y=-1.0, **bad))
    assert next(iter(bad)) in command.fault
    assert dict(command.arms) == {}
    assert "let go" in mapping.command(GamepadState.from_controls(left_y=-1.0)).fault


def test_losing_the_device_with_a_button_held_is_no_release_of_it() -> None:
    mapping = make("baxter")
    held = GamepadState.from_controls(back=1.0)  # alone it discards, when it is released
    mapping.read(DeviceReading(held, 1.0, True, "pad"), 1.0)
    mapping.read(DeviceReading(RESTING, 1.0, False, "pad"), 1.1)
    mapping.read(DeviceReading(RESTING, 2.0, True, "pad"), 2.0)
    assert mapping.take_events() == ()


def test_buttons_that_are_down_when_the_device_is_back_do_nothing_until_they_were_let_go() -> None:
    mapping = make("baxter")
    mapping.stop()
    mapping.read(DeviceReading(RESTING, 1.0, False, "pad"), 1.0)
    down = GamepadState.from_controls(start=1.0, a=1.0, back=1.0, left_bumper=1.0)  # under another hand, perhaps
    for _ in range(3):
        assert mapping.read(DeviceReading(down, 2.0, True, "pad"), 2.0).stop
    mapping.read(DeviceReading(RESTING, 2.1, True, "pad"), 2.1)
    assert mapping.take_events() == ()
    start = GamepadState.from_controls(start=1.0)
    assert not mapping.read(DeviceReading(start, 2.2, True, "pad"), 2.2).stop  # pressed now, it is meant
    mapping.read(DeviceReading(RESTING, 2.3, True, "pad"), 2.3)
    mapping.distrust()
    for _ in range(2):
        assert mapping.command(GamepadState.from_controls(a=1.0)).arms["left"].gripper == "keep"
    mapping.command(RESTING)
    assert wish(mapping, a=1.0).gripper == "close"


def test_a_trigger_that_is_held_when_the_device_is_back_must_be_let_go() -> None:
    mapping = make("baxter")
    mapping.distrust()
    for value in (1.0, 0.6, 0.4):  # also on its way back
        assert "let go of the sticks first: right_trigger" in wish_fault(mapping, right_trigger=value)
    assert wish_fault(mapping) == ""


def test_a_stop_that_is_down_when_the_device_is_back_stops() -> None:
    mapping = make("baxter")
    mapping.distrust()
    assert mapping.command(GamepadState.from_controls(guide=1.0)).stop
    assert mapping.command(RESTING).stop


@pytest.mark.parametrize("bad", [{"left_x": math.nan}, {"right_y": -7.0}, {"a": 2.0}])
def test_the_stop_of_a_gamepad_that_cannot_be_trusted_is_heard_and_stays(bad: dict[str, float]) -> None:
    mapping = make("baxter")
    command = mapping.command(GamepadState.from_controls(guide=1.0, **bad))
    assert command.stop and command.fault
    assert [event.name for event in mapping.take_events()] == ["stop"]
    assert mapping.command(RESTING).stop


def test_readings_carry_age_and_loss() -> None:
    mapping = make("baxter")
    pushed = GamepadState.from_controls(left_y=-1.0)
    command = mapping.read(DeviceReading(pushed, 2.0, True, "pad"), 2.03)
    assert command.age == pytest.approx(0.03)
    assert command.arms["left"].twist[0] == 0.05
    lost = mapping.read(DeviceReading(pushed, 2.0, False, "pad"), 2.05)
    assert lost.fault == "pad is not connected"
    assert dict(lost.arms) == {}
    assert "let go" in mapping.read(DeviceReading(pushed, 2.1, True, "pad"), 2.1).fault
    mapping.stop()
    assert mapping.read(DeviceReading(pushed, 2.0, False, "pad"), 2.2).stop


def test_enable_is_a_dead_man_switch(tmp_path: Path) -> None:
    mapping = make("three_dof")
    assert mapping.command(RESTING).enabled
    path = file_with(tmp_path, '[robot.three_dof.buttons]\nenable = "right_bumper"\ngripper_close = "a"\n')
    mapping = DriveMapping(read_mapping_file(path).robot["three_dof"], "three_dof", ARMS["three_dof"])
    assert not mapping.command(RESTING).enabled
    assert mapping.command(GamepadState.from_controls(right_bumper=1.0)).enabled
    assert not mapping.command(GamepadState.from_controls(right_bumper=0.4)).enabled


@pytest.mark.parametrize("robot", list(ARMS))
@given(states=st.lists(STATES, max_size=12))
def test_steps_are_pure_and_a_repeated_reading_changes_nothing(robot: str, states: list[GamepadState]) -> None:
    mapping = make(robot)
    state = mapping.start()
    for gamepad in states:
        first = mapping.step(state, gamepad)
        assert mapping.step(state, gamepad) == first
        again, command, events = mapping.step(first[0], gamepad)  # a gamepad reports less often than the arm moves
        assert events == ()
        assert (again, command.arms, command.base, command.stop) == (
            first[0],
            first[1].arms,
            first[1].base,
            first[1].stop,
        )
        state = again


def test_the_page_may_choose_stop_and_slow_down() -> None:
    mapping = make("baxter")
    mapping.choose("right", "left")
    mapping.set_speed(0.25)
    assert (mapping.state.arms, mapping.command(RESTING).speed_ratio) == (("left", "right"), 0.25)
    mapping.stop()
    assert mapping.command(RESTING).stop
    mapping.release()
    assert not mapping.command(RESTING).stop
    with pytest.raises(MappingError, match=r"baxter has no arm 'third'; its arms are left, right"):
        mapping.choose("third")
    with pytest.raises(MappingError, match=r"speed ratio is nan, allowed 0..1"):
        mapping.set_speed(math.nan)


# Files


def test_a_file_of_ones_own_changes_only_what_it_names(tmp_path: Path) -> None:
    path = file_with(tmp_path, '[robot.baxter]\ntop_speed = 0.2\n[robot.baxter.axes]\nz = "-right_y"\npitch = ""\n')
    mapping = make("baxter", path)
    assert wish(mapping, right_y=-1.0).twist == (0.0, 0.0, 0.2, 0.0, 0.0, 0.0)
    assert wish(mapping, left_y=-0.5, x=1.0).twist[5] == 0.3
    assert read_mapping_file(path).robot["three_dof"] == read_mapping_file().robot["three_dof"]


def own_robot(wheels: bool) -> RobotModel:
    arm = SimpleNamespace(joint_names=("one", "two"))
    named: Any = SimpleNamespace(name="own", arms={"upper": arm, "lower": arm}, drive=object() if wheels else None)
    return cast(RobotModel, named)


@pytest.mark.parametrize("wheels", [False, True])
def test_a_robot_of_ones_own_is_driven_without_a_section(wheels: bool) -> None:
    mapping = DriveMapping.load(None, own_robot(wheels))
    mapping.command(RESTING)
    assert press(mapping, "right_bumper") == (("arms", "lower"),)
    assert press(mapping, "right_bumper") == (("arms", "upper"),)
    assert press(mapping, "left_bumper") == ((("mode", "base"),) if wheels else ())


def test_its_section_starts_from_what_suits_any(tmp_path: Path) -> None:
    path = file_with(
        tmp_path, '[robot.own]\ntop_speed = 0.4\naxes = { drive = "", turn = "" }\nbuttons = { mode = "" }\n'
    )
    mapping = DriveMapping.load(path, own_robot(False))
    mapping.command(RESTING)
    assert wish(mapping, left_y=-1.0).twist[0] == 0.4


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "[robot.baxter]\ntop_sped = 1",
            "own.toml: robot.baxter.top_sped: unknown key; allowed keys here are top_speed",
        ),
        ("[robot.baxter]\ntop_speed = -1", "own.toml: robot.baxter.top_speed: .*greater than 0; got -1"),
        ("[robot.baxter]\ndead_zone = nan", "own.toml: robot.baxter.dead_zone: .*got nan"),
        ("[robot.baxter]\nframes = ['moon']", r"own.toml: robot.baxter.frames\[0\]: .*'world', 'base'.*got 'moon'"),
        ("[robot.baxter.axes]\nw = 'a'", "own.toml: robot.baxter.axes.w: unknown key; allowed keys here are x, y, z"),
        (
            "[robot.baxter.axes]\nx = 'left_z'",
            "own.toml: robot.baxter.axes.x: a gamepad has no 'left_z'; it has left_x, .*; got 'left_z'",
        ),
        (
            "[robot.baxter.axes]\nx = '__import__(\"os\")'",
            "own.toml: robot.baxter.axes.x: a gamepad has no '__import__'",
        ),
        ("[robot.baxter.axes]\nx = 'left_y right_y'", "cannot read 'right_y' in 'left_y right_y'"),
        ("[robot.baxter.axes]\nx = '3 * left_y'", "factor of left_y is 3, allowed above 0 up to 1"),
        ("[robot.baxter.axes]\nx = 'left_y - left_y'", "left_y stands twice"),
        ("[robot.baxter.axes]\nx = 'a + '", r"cannot read '\+'"),
        ("[robot.baxter.buttons]\nstop = 'left_x'", "no button 'left_x'; it has a, b, x, y"),
        ("[robot.baxter.buttons]\nstop = 'a + a'", "a button stands twice"),
        ("[robot.baxter.buttons]\nfire = 'a'", "buttons.fire: unknown key; allowed keys here are gripper_close"),
        ("[pad.'Odd']\naxes = { left_z = 'a0' }", "own.toml: pad.Odd: axes.left_z: unknown; allowed are left_x"),
        ("[pad.'Odd']\naxes = { left_x = 'b0' }", "own.toml: pad.Odd: axes.left_x: 'b0' is no axis"),
        ("[pad.'Odd']\nbuttons = { a = 'h0.north' }", "pad.Odd: buttons.a: 'h0.north' is no button"),
        ("robot = 3", "own.toml: robot: .*got 3"),
        ("[robot", "own.toml: not valid TOML"),
    ],
)
def test_bad_files_are_refused_with_file_key_value_and_what_is_allowed(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(MappingError, match=message) as caught:
        read_mapping_file(file_with(tmp_path, text))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("robot", "text", "message"),
    [
        (
            "three_dof",
            "buttons = { choose_left = 'x' }",
            "buttons.choose_left: three_dof has no arm 'left'; its arms are",
        ),
        ("three_dof", "axes = { drive = 'right_y' }", "axes.drive: three_dof has no wheels"),
        ("baxter", "buttons = { mode = 'guide' }", "buttons.mode: baxter has no wheels"),
        ("baxter", "buttons = { release = '' }", "buttons.release: empty, but a stop stays until it is released"),
    ],
)
def test_files_that_do_not_fit_the_robot_are_refused(tmp_path: Path, robot: str, text: str, message: str) -> None:
    path = file_with(tmp_path, f"[robot.{robot}]\n{text}\n")
    with pytest.raises(MappingError, match=f"own.toml: robot.{robot}.{message}"):
        DriveMapping.load(path, load_robot(robot))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(MappingError, match=r"none.toml: cannot be read: No such file"):
        read_mapping_file(tmp_path / "none.toml")
