import json
import math
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from teleop.gamepad import AXES, BUTTONS
from teleop.server_files import file_response, page_files
from teleop.server_protocol import Do, Input, ProtocolError, Set, Talk, read_message

INPUT = {
    "type": "input",
    "seq": 3,
    "at": 1.5,
    "axes": [0.5] * len(AXES),
    "buttons": [0] * len(BUTTONS),
    "enabled": True,
}


def test_messages_are_read() -> None:
    message = read_message(json.dumps(INPUT))
    assert isinstance(message, Input)
    assert message.axes == [0.5] * 4
    assert read_message('{"type": "set", "speed": 0.5}') == Set(type="set", speed=0.5)
    assert read_message('{"type": "do", "action": "record"}') == Do(type="do", action="record")
    talk = '{"type": "talk", "action": "read", "text": "take it", "choice": 3}'
    assert read_message(talk) == Talk(type="talk", action="read", text="take it", choice=3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"axes": [0.0] * 5}, "axes"),
        ({"axes": "0000"}, "axes"),
        ({"buttons": [True] * len(BUTTONS)}, "buttons"),
        ({"enabled": 1}, "enabled"),
        ({"at": math.nan}, "at"),
        ({"at": math.inf}, "at"),
        ({"silence": -1.0}, "silence"),
        ({"silence": math.inf}, "silence"),
        ({"seq": 1.5}, "seq"),
        ({"token": "x"}, "token"),
    ],
)
def test_a_wrong_value_is_named(change: dict[str, object], told: str) -> None:
    with pytest.raises(ProtocolError, match=told):
        read_message(json.dumps(INPUT | change))


@pytest.mark.parametrize(
    ("change", "told"),
    [({"action": "learn all"}, "action"), ({"choice": -1}, "choice"), ({"text": "a" * 501}, "text")],
)
def test_wrong_talk_is_named(change: dict[str, object], told: str) -> None:
    with pytest.raises(ProtocolError, match=told):
        read_message(json.dumps({"type": "talk", "action": "do", "text": "take it"} | change))


@given(st.text() | st.binary() | st.recursive(st.none() | st.floats() | st.text(), st.lists).map(json.dumps))
def test_anything_else_is_refused_without_another_error(data: str | bytes) -> None:
    with pytest.raises(ProtocolError):
        read_message(data)


def test_the_page_has_no_inline_script_or_style_and_loads_nothing_from_elsewhere() -> None:
    files = page_files()
    assert {"/", "/index.html", "/app.js", "/viewer.js", "/style.css"} <= set(files)
    html = files["/"][1].decode()
    assert "<script>" not in html
    assert "style=" not in html
    assert re.search(r"\son\w+=", html) is None
    for kind, data in files.values():
        if "svg" not in kind:
            assert b"http://" not in data
            assert b"https://" not in data
    answer = file_response("GET", "/", "127.0.0.1:1", "http")
    assert "script-src" not in answer.headers["Content-Security-Policy"]  # falls back to default-src 'self'
    assert "unsafe" not in answer.headers["Content-Security-Policy"]
    assert file_response("HEAD", "/", "127.0.0.1:1", "http").body == b""
