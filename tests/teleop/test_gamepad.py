import pytest

from teleop.gamepad import AXES, BUTTONS, RESTING, GamepadState


def test_layout_is_the_w3c_standard_one() -> None:
    assert AXES == ("left_x", "left_y", "right_x", "right_y")
    # https://www.w3.org/TR/gamepad/#remapping: 0-3 face buttons, 4-7 shoulders, 8-9 centre, 10-11 sticks, 12-15 pad, 16
    assert [BUTTONS.index(name) for name in ("a", "b", "left_bumper", "left_trigger", "back", "up", "guide")] == [
        0,
        1,
        4,
        6,
        8,
        12,
        16,
    ]


def test_from_controls_sets_what_it_names() -> None:
    state = GamepadState.from_controls(left_y=-0.5, right_trigger=0.25)
    assert state.axes == (0.0, -0.5, 0.0, 0.0)
    assert state.buttons[7] == 0.25
    assert sum(state.buttons) == 0.25
    assert RESTING.fault() == ""


def test_unknown_control_is_refused_with_the_names() -> None:
    with pytest.raises(ValueError, match=r"no 'thumb'; it has left_x, .*guide"):
        GamepadState.from_controls(thumb=1.0)


def test_another_layout_is_refused() -> None:
    with pytest.raises(ValueError, match="4 axes and 17 buttons, got 2 and 17"):
        GamepadState(axes=(0.0, 0.0))


@pytest.mark.parametrize(
    ("controls", "fault"),
    [
        ({"left_x": float("nan")}, "axis left_x is nan"),
        ({"right_y": -1.5}, "axis right_y is -1.5, allowed -1..1"),
        ({"a": float("inf")}, "button a is inf"),
        ({"left_trigger": -0.1}, "button left_trigger is -0.1, allowed 0..1"),
    ],
)
def test_fault_names_the_value_that_no_gamepad_sends(controls: dict[str, float], fault: str) -> None:
    assert fault in GamepadState.from_controls(**controls).fault()
