import pytest

from robots import list_robots, load_robot
from teleop.devices import KeyTable
from teleop.drive_mapping import DriveMapping
from teleop.mapping_file import read_mapping_file
from teleop.mapping_table import MappingRow, describe, describe_mapping


def test_rows_name_the_stick_and_the_key_of_each_direction() -> None:
    rows = describe(load_robot("baxter"))
    assert (
        MappingRow("away / back (x)", "left stick up / down; pad up / pad down", "w or arrowup / s or arrowdown")
        in rows
    )
    assert MappingRow("up / down (z)", "right trigger / left trigger", "e / q") in rows
    assert MappingRow("turn about z", "X / Y", "u / o") in rows
    assert MappingRow("close the gripper", "A", "c") in rows
    assert MappingRow("emergency stop", "guide or left stick pressed + right stick pressed", "space or escape") in rows
    assert MappingRow("slower", "back + pad down", "-") in rows


@pytest.mark.parametrize("name", list_robots())
def test_every_motion_and_action_of_a_robot_has_a_row_and_a_key(name: str) -> None:
    robot = load_robot(name)
    mapping = DriveMapping.load(None, robot)
    rows = describe(robot)
    assert len(rows) == len(mapping.sums) + len(mapping.chords) + 1  # and one for shift
    assert all(row.keys for row in rows)
    assert len({row.action for row in rows}) == len(rows)


def test_without_keys_there_are_none_to_show() -> None:
    mapping = DriveMapping(read_mapping_file().robot["three_dof"], "three_dof", {"arm": 3})
    table = KeyTable(read_mapping_file().keyboard.model_copy(update={"keys": {}}))
    assert {row.keys for row in describe_mapping(mapping, table)} == {""}
