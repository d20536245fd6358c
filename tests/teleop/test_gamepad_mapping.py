import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.gamepad import GamepadState
from teleop.gamepad_mapping import GamepadMapping

MAPPING = GamepadMapping(top_speed=0.3, dead_zone=0.1, expo=0.4)


def test_rest_and_dead_zone_give_exactly_zero() -> None:
    assert MAPPING.command(GamepadState()).twist == (0.0,) * 6
    inside = GamepadState.from_controls(left_x=0.1, left_y=-0.09, right_trigger=0.1)
    assert MAPPING.command(inside).twist == (0.0,) * 6


@pytest.mark.parametrize(
    ("controls", "axis", "speed"),
    [
        ({"left_y": -1.0}, 0, 0.3),  # stick up: away from the robot
        ({"left_x": -1.0}, 1, 0.3),  # stick left: to the left
        ({"right_trigger": 1.0}, 2, 0.3),
        ({"left_trigger": 1.0}, 2, -0.3),
    ],
)
def test_each_control_moves_its_axis_at_top_speed(controls: dict[str, float], axis: int, speed: float) -> None:
    twist = MAPPING.command(GamepadState.from_controls(**controls)).twist
    assert twist[axis] == pytest.approx(speed, abs=1e-15)
    assert sum(map(abs, twist)) == pytest.approx(abs(speed), abs=1e-15)


@pytest.mark.parametrize(
    ("controls", "wish"),
    [
        ({"a": 1.0}, "close"),
        ({"right_bumper": 1.0}, "close"),
        ({"b": 1.0}, "open"),
        ({"left_bumper": 1.0}, "open"),
        ({"a": 1.0, "b": 1.0}, "keep"),
        ({"a": 0.4}, "keep"),
        ({}, "keep"),
    ],
)
def test_gripper_buttons(controls: dict[str, float], wish: str) -> None:
    assert MAPPING.command(GamepadState.from_controls(**controls)).gripper == wish


def test_fault_is_passed_on_and_asks_for_nothing() -> None:
    command = MAPPING.command(GamepadState.from_controls(left_x=float("nan"), left_y=-1.0, a=1.0))
    assert "left_x" in command.fault
    assert command.twist == (0.0,) * 6
    assert command.gripper == "keep"


@given(st.floats(-0.3, 0.3).filter(lambda speed: speed == 0.0 or abs(speed) > 1e-6))
def test_deflection_is_the_inverse_of_the_mapping(speed: float) -> None:
    command = MAPPING.command(GamepadState.from_controls(left_y=-MAPPING.deflection(speed)))
    # The bisection stops at 1e-6 of full deflection; the slope is at most top_speed * 1.8 / 0.9.
    assert command.twist[0] == pytest.approx(speed, abs=1e-6)


@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_mapping_is_odd_and_monotone(a: float, b: float) -> None:
    low, high = sorted((a, b))
    speeds = [MAPPING.command(GamepadState.from_controls(left_y=-value)).twist[0] for value in (low, high, -high)]
    assert speeds[0] <= speeds[1]
    assert speeds[2] == -speeds[1]


@pytest.mark.parametrize("settings", [{"top_speed": 0.0}, {"dead_zone": 1.0}, {"expo": -0.1}])
def test_settings_out_of_range_are_refused(settings: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="allowed"):
        GamepadMapping(**settings)
