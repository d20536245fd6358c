"""What a demo file holds: topics, JSON schemas and metadata keys, shared by the recorder and the reader."""

from collections.abc import Mapping

import orjson

FORMAT_VERSION = "1"
"""Raised when an older reader could no longer understand a file; topics and metadata may be added without that."""
METADATA = "showtell"
"""Name of the metadata record that makes an MCAP file a demo."""

GAMEPAD = "/gamepad"
COMMAND = "/command"
JOINTS = "/joints"
GRIPPER = "/gripper"
OBJECTS = "/objects"
UTTERANCE = "/utterance"
DRIVE = "/drive"
ARMS = "/arms"
HANDS = "/hands"
BASE = "/base"
EVENT = "/event"
OUTCOME = "/outcome"
PRELUDE_GAMEPAD = "/prelude/gamepad"
PRELUDE_DRIVE = "/prelude/drive"

EVENTS = ("safety", "stop", "device", "gripper", "operator", "record")
"""Kinds of events."""
OUTCOMES = ("success", "failure", "unknown")
"""How a demo ended, in the words of whoever recorded it."""
WHEN = ("before", "during", "after")
"""When a sentence was said."""

UNITS = {"length": "m", "angle": "rad", "time": "s", "velocity": "rad/s", "twist": "m/s, rad/s", "quaternion": "xyzw"}

_STEP = {"type": "integer", "description": "control steps since the start; 240 a second"}
_NUMBERS = {"type": "array", "items": {"type": ["number", "null"]}}  # null is NaN
_NUMBER = {"type": "number"}
_TEXT = {"type": "string"}
_TEXTS = {"type": "array", "items": _TEXT}
_ROWS = {"type": "array", "items": _NUMBERS}
_SWITCH = {"type": "boolean"}


def _schema(title: str, *, optional: Mapping[str, object] | None = None, **properties: object) -> bytes:
    fields = {"step": _STEP, **properties}
    every = {**fields, **(optional or {})}
    return orjson.dumps({"title": title, "type": "object", "properties": every, "required": list(fields)})


def _described(kind: Mapping[str, object], text: str) -> dict[str, object]:
    return {**kind, "description": text}


_GAMEPAD = _schema(
    "W3C standard gamepad",
    axes=_described(_NUMBERS, "left x, left y, right x, right y; -1..1"),
    buttons=_described(_NUMBERS, "17 buttons; 0..1"),
    optional={"arrived": _described(_SWITCH, "whether this came since the last step; else it is an earlier one")},
)
_DRIVE = _schema(
    "What the person wanted of the robot in this step",
    arms={
        "type": "object",
        "description": "by arm: twist (6), frame of its axes, gripper (close, open, keep), jog (joint, speed) or null",
    },
    base=_described(_NUMBERS, "speed and turning speed of the base"),
    speed_ratio=_described(_NUMBER, "0..1, scales everything"),
    enabled=_described(_SWITCH, "the dead-man switch"),
    stop=_described(_SWITCH, "emergency stop"),
    age=_described(_NUMBER, "how old the input was"),
    fault=_described(_TEXT, "why the input could not be trusted"),
    camera_xyzw={
        "type": ["array", "null"],
        "items": _NUMBER,
        "description": "orientation of the picture the person saw, of which a frame `camera` is meant; x right, y down",
    },
)

SCHEMAS: dict[str, tuple[str, bytes]] = {
    GAMEPAD: ("showtell.Gamepad", _GAMEPAD),
    COMMAND: (
        "showtell.Command",
        _schema(
            "Command asked for and executed in this step, of the first arm",
            asked=_described(_NUMBERS, "tool twist asked for, axes of the world"),
            executed=_described(_NUMBERS, "tool twist executed after limits, axes of the world"),
            joint_velocity=_described(_NUMBERS, "executed joint velocities, all arms"),
            gripper_opening=_described(_NUMBER, "wanted gap between the fingers"),
            reason=_described(_TEXT, "why asked and executed differ"),
        ),
    ),
    JOINTS: ("showtell.Joints", _schema("Driven joints before this step", time=_NUMBER, q=_NUMBERS, dq=_NUMBERS)),
    GRIPPER: (
        "showtell.Gripper",
        _schema(
            "Tool frame and fingers of the first arm before this step",
            position=_NUMBERS,
            orientation_xyzw=_NUMBERS,
            opening=_NUMBER,
            closed=_SWITCH,
            held={"type": ["integer", "null"]},
        ),
    ),
    OBJECTS: (
        "showtell.Objects",
        _schema(
            "Object poses before this step",
            ids={"type": "array", "items": {"type": "integer"}},
            positions=_ROWS,
            orientations_xyzw=_ROWS,
        ),
    ),
    UTTERANCE: (
        "showtell.Utterance",
        _schema(
            "A sentence about this demo",
            text=_TEXT,
            when=_described(_TEXT, "before, during or after the demo"),
            optional={"language": _described(_TEXT, "tag of its language (BCP 47)")},
        ),
    ),
    DRIVE: ("showtell.Drive", _DRIVE),
    ARMS: (
        "showtell.Arms",
        _schema(
            "Commands asked for and executed in this step, by arm",
            names=_TEXTS,
            asked=_described(_ROWS, "tool twists asked for, axes of the world"),
            executed=_described(_ROWS, "tool twists executed after limits, axes of the world"),
            openings=_described(_NUMBERS, "wanted gaps between the fingers"),
            reasons=_described(_TEXTS, "why asked and executed differ"),
            details=_described(_TEXTS, "the joint, the pair or the fault behind the reason"),
            base_asked=_described(_NUMBERS, "speed and turning speed asked of the base"),
            base_executed=_described(_NUMBERS, "the same after limits"),
            state=_described(_TEXT, "ok, slowed or stopped"),
            reason=_described(_TEXT, "why it is not ok"),
        ),
    ),
    HANDS: (
        "showtell.Hands",
        _schema(
            "Tool frames, fingers and forces of all arms before this step",
            names=_TEXTS,
            positions=_ROWS,
            orientations_xyzw=_ROWS,
            openings=_NUMBERS,
            closed={"type": "array", "items": _SWITCH},
            held={"type": "array", "items": {"type": ["integer", "null"]}},
            wrist_wrenches=_described(_ROWS, "force and torque at each wrist, axes of the world; N, Nm"),
            finger_efforts=_described(_ROWS, "efforts of the two fingers' motors; N or Nm"),
        ),
    ),
    BASE: (
        "showtell.Base",
        _schema("The robot's base in the world before this step", position=_NUMBERS, orientation_xyzw=_NUMBERS),
    ),
    EVENT: (
        "showtell.Event",
        _schema(
            "Something that happened",
            kind=_described(_TEXT, ", ".join(EVENTS)),
            text=_TEXT,
            arm=_described(_TEXT, "the arm it concerns, empty for the robot"),
        ),
    ),
    OUTCOME: (
        "showtell.Outcome",
        _schema("How the demo ended", outcome=_described(_TEXT, ", ".join(OUTCOMES)), note=_TEXT),
    ),
    PRELUDE_GAMEPAD: ("showtell.PreludeGamepad", _GAMEPAD),
    PRELUDE_DRIVE: ("showtell.PreludeDrive", _DRIVE),
}
"""Topic to schema name and JSON schema."""


def log_time(step: int, rate: int) -> int:
    """Nanoseconds since the start of a step at `rate` steps a second."""
    return step * 1_000_000_000 // rate
