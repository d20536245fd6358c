"""The picture that a person sees, from the page's message to the demo and back."""

import json

import pytest

from teleop.drive_command import ArmWish, DriveCommand
from teleop.drive_track import command_from_message, command_to_message
from teleop.server_protocol import Input, ProtocolError, read_message

INPUT = {"type": "input", "seq": 1, "at": 0.0, "axes": [0.0] * 4, "buttons": [0.0] * 17, "enabled": True}


def test_a_page_says_how_its_picture_is_turned_and_older_pages_do_not() -> None:
    told = read_message(json.dumps(INPUT | {"camera": [0.5, 0.5, -0.5, -0.5]}))
    assert isinstance(told, Input) and told.camera == [0.5, 0.5, -0.5, -0.5]
    for silent in (INPUT, INPUT | {"camera": None}):
        told = read_message(json.dumps(silent))
        assert isinstance(told, Input) and told.camera is None


@pytest.mark.parametrize("camera", [[0.0, 0.0, 0.0, 1.1], [0.0, 0.0, 0.0, 0.0], [1.0, 0.0, 0.0], ["x", 0, 0, 1], 1.0])
def test_what_is_no_orientation_is_refused(camera: object) -> None:
    with pytest.raises(ProtocolError, match=r"input\.camera"):
        read_message(json.dumps(INPUT | {"camera": camera}))


def test_the_picture_is_kept_in_the_demo_and_older_demos_have_none() -> None:
    wish = ArmWish((0.1, 0.0, 0.0, 0.0, 0.0, 0.0), "camera")
    command = DriveCommand({"arm": wish}, camera_xyzw=(0.1, 0.2, 0.3, (1.0 - 0.14) ** 0.5))
    message = json.loads(json.dumps(command_to_message(command)))
    assert command_from_message(message) == command  # to the last bit: a replay must not differ
    del message["camera_xyzw"]
    assert command_from_message(message).camera_xyzw is None
