import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.devices import KeyTable, combine, keys_to_gamepad
from teleop.gamepad import RESTING, GamepadState
from teleop.mapping_file import MappingError

TABLE = KeyTable.load()


@pytest.mark.parametrize(
    ("pressed", "controls"),
    [
        (set(), {}),
        ({"w"}, {"left_y": -1.0}),
        ({"w", "s"}, {}),  # against each other
        ({"e"}, {"right_trigger": 1.0}),
        ({"e", "shift"}, {"right_trigger": 0.4}),
        ({"w", "d", "shift"}, {"left_y": -0.4, "left_x": 0.4}),
        ({"c", "shift"}, {"a": 1.0}),  # a button has no halves
        ({"+"}, {"back": 1.0, "up": 1.0}),
        ({"+", "="}, {"back": 1.0, "up": 1.0}),
        ({"f12", "é"}, {}),
    ],
)
def test_keys_play_controls(pressed: set[str], controls: dict[str, float]) -> None:
    assert keys_to_gamepad(pressed) == GamepadState.from_controls(**controls)


@given(st.sets(st.sampled_from([*TABLE.keys, "shift", "unknown"])))
def test_any_keys_give_a_gamepad_without_fault(pressed: set[str]) -> None:
    assert keys_to_gamepad(pressed).fault() == ""


def test_a_file_of_ones_own_changes_single_keys(tmp_path: Path) -> None:
    file = tmp_path / "mapping.toml"
    file.write_text('[keyboard]\nslow = 0.2\nkeys = { w = "left_trigger", s = "" }\n', encoding="utf-8")
    table = KeyTable.load(file)
    assert keys_to_gamepad({"w", "s", "d", "shift"}, table) == GamepadState.from_controls(left_trigger=0.2, left_x=0.2)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('keys = { w = "left_z" }', "mapping.toml: keyboard.keys: key 'w': a gamepad has no 'left_z'; it has left_x"),
        ('keys = { W = "left_y" }', "key 'W': write keys in lower case"),
        ('keys = { shift = "left_y" }', "shift makes every key slow"),
        ("slow = 2", "keyboard.slow: .*less than or equal to 1; got 2"),
        ("fast = 2", "keyboard.fast: unknown key; allowed keys here are slow, keys"),
    ],
)
def test_wrong_keys_are_refused(tmp_path: Path, text: str, message: str) -> None:
    file = tmp_path / "mapping.toml"
    file.write_text(f"[keyboard]\n{text}\n", encoding="utf-8")
    with pytest.raises(MappingError, match=message):
        KeyTable.load(file)


def test_combined_devices_add_up() -> None:
    one = GamepadState.from_controls(left_x=0.7, right_y=-0.25, a=1.0)
    two = GamepadState.from_controls(left_x=0.7, right_y=0.5, left_trigger=0.5)
    assert combine([one, two]) == GamepadState.from_controls(left_x=1.0, right_y=0.25, a=1.0, left_trigger=0.5)
    assert combine([]) == RESTING
    assert combine([one]) == one


def test_a_broken_device_is_not_hidden_by_the_others() -> None:
    assert "left_y is nan" in combine([RESTING, GamepadState.from_controls(left_y=math.nan)]).fault()
