import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.devices import DeviceError, RemoteDevice, from_browser, keys_from_browser
from teleop.gamepad import AXES, BUTTONS, RESTING, GamepadState


def said(**changes: Any) -> dict[str, Any]:
    return {"axes": [0.0] * 4, "buttons": [0.0] * 17} | changes


def test_numbers_and_button_objects_are_read() -> None:
    buttons: list[Any] = [{"pressed": True, "touched": True, "value": 1.0}, *[0] * 5, 0.25, *[0] * 10]
    state = from_browser(said(axes=[1, -1.0, 0.5, 0], buttons=buttons, mapping="standard", id="pad", timestamp=3.0))
    assert state == GamepadState.from_controls(left_x=1.0, left_y=-1.0, right_x=0.5, a=1.0, left_trigger=0.25)


def test_rounding_of_browsers_is_cut_off() -> None:
    assert from_browser(said(axes=[-1.000030518509476, 0, 0, 0])).axes[0] == -1.0


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (None, "object with .* got NoneType"),
        ([], "object with .* got list"),
        ({}, "axes must be a list of 4 numbers, got None"),
        (said(axes=[0.0] * 3), "axes must be a list of 4 numbers, got 3 values"),
        (said(buttons=[0.0] * 16), "buttons must be a list of 17 numbers, got 16 values"),
        (said(axes="0000"), "axes must be a list of 4 numbers, got '0000'"),
        (said(axes=[0.0, 0.0, 1.2, 0.0]), r"axes\[2\] is 1.2, allowed -1..1"),
        (said(buttons=[-0.5, *[0.0] * 16]), r"buttons\[0\] is -0.5, allowed 0..1"),
        (said(axes=[float("nan"), 0, 0, 0]), r"axes\[0\] must be a finite number, got nan"),
        (said(axes=[True, 0, 0, 0]), r"axes\[0\] must be a finite number, got True"),
        (said(axes=[10**400, 0, 0, 0]), r"axes\[0\] must be a finite number, got a huge integer"),
        (said(axes=[None, 0, 0, 0]), r"axes\[0\] must be a finite number, got None"),
        (said(buttons=[{"pressed": True}, *[0] * 16]), r"buttons\[0\] must be a finite number, got None"),
        (said(buttons=[[1.0], *[0] * 16]), r"buttons\[0\] must be a finite number, got list"),
        (said(mapping=""), "no standard layout for this gamepad"),
    ],
)
def test_what_no_gamepad_says_is_refused(data: object, message: str) -> None:
    with pytest.raises(DeviceError, match=message):
        from_browser(data)


JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=20) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=40,
)


@given(JSON | st.fixed_dictionaries({"axes": JSON, "buttons": JSON}))
def test_any_json_gives_a_good_state_or_a_short_device_error(data: object) -> None:
    try:
        state = from_browser(data)
    except DeviceError as error:
        assert len(str(error)) < 300
    else:
        assert state.fault() == ""


@given(
    st.lists(st.floats(-1.0, 1.0), min_size=len(AXES), max_size=len(AXES)),
    st.lists(st.floats(0.0, 1.0), min_size=len(BUTTONS), max_size=len(BUTTONS)),
)
def test_a_state_survives_json(axes: list[float], buttons: list[float]) -> None:
    state = GamepadState(tuple(axes), tuple(buttons))
    assert from_browser(json.loads(json.dumps({"axes": state.axes, "buttons": state.buttons}))) == state


def test_keys_are_named_as_in_the_table() -> None:
    assert keys_from_browser(["W", " ", "ArrowUp", "+"]) == {"w", "space", "arrowup", "+"}


@pytest.mark.parametrize("data", [None, "w", {"w": 1}, ["w"] * 33, [""], [3], ["x" * 21]])
def test_what_are_no_keys_is_refused(data: object) -> None:
    with pytest.raises(DeviceError, match="key"):
        keys_from_browser(data)


def test_a_remote_device_says_what_it_heard_and_when() -> None:
    state = GamepadState.from_controls(left_x=1.0)
    with RemoteDevice() as device:
        assert "nothing has been heard of the page yet" in device.poll(0.0).fault
        device.offer(state, 1.0)
        reading = device.poll(5.0)
        assert (reading.gamepad, reading.timestamp, reading.connected, reading.fault) == (state, 1.0, True, "")
        device.lose("the page was closed")
        reading = device.poll(5.0)
        assert (reading.gamepad, reading.timestamp, reading.connected) == (RESTING, 1.0, False)
        assert reading.fault == "the page was closed"
        device.offer(state, 6.0)
        assert device.poll(6.0).connected
    assert not device.poll(7.0).connected
