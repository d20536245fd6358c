"""What a demo file holds: topics, JSON schemas and metadata keys, shared by the recorder and the reader."""

from collections.abc import Mapping

import orjson

FORMAT_VERSION = "1"
"""Raised when an older reader could no longer understand a file."""
METADATA = "showtell"
"""Name of the metadata record that makes an MCAP file a demo."""

GAMEPAD = "/gamepad"
COMMAND = "/command"
JOINTS = "/joints"
GRIPPER = "/gripper"
OBJECTS = "/objects"
UTTERANCE = "/utterance"

UNITS = {"length": "m", "angle": "rad", "time": "s", "velocity": "rad/s", "twist": "m/s, rad/s", "quaternion": "xyzw"}

_STEP = {"type": "integer", "description": "control steps since the start; 240 a second"}
_NUMBERS = {"type": "array", "items": {"type": ["number", "null"]}}  # null is NaN
_NUMBER = {"type": "number"}
_TEXT = {"type": "string"}


def _schema(title: str, **properties: object) -> bytes:
    fields = {"step": _STEP, **properties}
    return orjson.dumps({"title": title, "type": "object", "properties": fields, "required": list(fields)})


def _described(kind: Mapping[str, object], text: str) -> dict[str, object]:
    return {**kind, "description": text}


SCHEMAS: dict[str, tuple[str, bytes]] = {
    GAMEPAD: (
        "showtell.Gamepad",
        _schema(
            "W3C standard gamepad",
            axes=_described(_NUMBERS, "left x, left y, right x, right y; -1..1"),
            buttons=_described(_NUMBERS, "17 buttons; 0..1"),
        ),
    ),
    COMMAND: (
        "showtell.Command",
        _schema(
            "Command asked for and executed in this step",
            asked=_described(_NUMBERS, "tool twist asked for, axes of the world"),
            executed=_described(_NUMBERS, "tool twist executed after limits, axes of the world"),
            joint_velocity=_described(_NUMBERS, "executed joint velocities"),
            gripper_opening=_described(_NUMBER, "wanted gap between the fingers"),
            reason=_described(_TEXT, "why asked and executed differ"),
        ),
    ),
    JOINTS: ("showtell.Joints", _schema("Driven joints before this step", time=_NUMBER, q=_NUMBERS, dq=_NUMBERS)),
    GRIPPER: (
        "showtell.Gripper",
        _schema(
            "Tool frame and fingers before this step",
            position=_NUMBERS,
            orientation_xyzw=_NUMBERS,
            opening=_NUMBER,
            closed={"type": "boolean"},
            held={"type": ["integer", "null"]},
        ),
    ),
    OBJECTS: (
        "showtell.Objects",
        _schema(
            "Object poses before this step",
            ids={"type": "array", "items": {"type": "integer"}},
            positions={"type": "array", "items": _NUMBERS},
            orientations_xyzw={"type": "array", "items": _NUMBERS},
        ),
    ),
    UTTERANCE: ("showtell.Utterance", _schema("A sentence about this demo", text=_TEXT)),
}
"""Topic to schema name and JSON schema."""


def log_time(step: int, rate: int) -> int:
    """Nanoseconds since the start of a step at `rate` steps a second."""
    return step * 1_000_000_000 // rate
