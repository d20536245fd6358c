"""What the page may say: JSON messages, each checked whole before anything is done with it."""

import math
from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from .errors import TeleopError
from .gamepad import AXES, BUTTONS

LONGEST_MESSAGE = 64 * 1024
"""Longest message [byte]; a longer one ends the connection."""
LONGEST_SENTENCE = 500


def _unit(values: list[float]) -> list[float]:
    if not abs(math.hypot(*values) - 1.0) <= 1e-3:
        raise ValueError(f"must be a unit quaternion, got {values}")
    return values


_Finite = Annotated[float, Field(allow_inf_nan=False)]
_Axes = Annotated[list[float], Field(min_length=len(AXES), max_length=len(AXES))]
_Buttons = Annotated[list[float], Field(min_length=len(BUTTONS), max_length=len(BUTTONS))]
_UnitQuaternion = Annotated[list[_Finite], Field(min_length=4, max_length=4), AfterValidator(_unit)]
_Name = Annotated[str, Field(max_length=100)]


class ProtocolError(TeleopError, ValueError):
    """A message is not what a page sends."""


class _Message(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)


class Input(_Message):
    """What sticks, keys and switches say now; sent at 60 Hz or more by the page that holds control.

    Sticks and buttons are taken as they are, also out of range: the driver stops on those and says why.
    """

    type: Literal["input"]
    seq: Annotated[int, Field(ge=0)]
    at: _Finite
    """The page's clock when this was so [ms since 1970]."""
    silence: Annotated[float, Field(ge=0.0, allow_inf_nan=False)] = 0.0
    """How long the page had heard nothing of its browser then, which tells it of keys and gamepads [ms]."""
    axes: _Axes
    buttons: _Buttons
    enabled: bool
    camera: _UnitQuaternion | None = None
    """Orientation in the world of the picture that the page shows, xyzw: x right, y down, z into it."""


class Set(_Message):
    """Choose an arm or a speed."""

    type: Literal["set"]
    arm: _Name | None = None
    speed: Annotated[float, Field(ge=0.0, le=1.0)] | None = None


class Control(_Message):
    """Take control of the robot, or give it back."""

    type: Literal["control"]
    action: Literal["take", "release"]


class Stop(_Message):
    """Emergency stop, by anyone who watches."""

    type: Literal["stop"]


class Release(_Message):
    """End of the emergency stop, by who holds control."""

    type: Literal["release"]


class Do(_Message):
    """A button for recording and replaying."""

    type: Literal["do"]
    action: Literal[
        "record", "stop", "keep", "success", "failure", "discard", "redo", "describe", "replay", "reset", "another"
    ]
    text: Annotated[str, Field(max_length=LONGEST_SENTENCE)] = ""
    demo: _Name = ""


class Talk(_Message):
    """Something said to who understands it: a command to read or do, an answer to a question, a demo to learn."""

    type: Literal["talk"]
    action: Literal["read", "do", "undo", "wrong", "learn"]
    text: Annotated[str, Field(max_length=LONGEST_SENTENCE)] = ""
    choice: Annotated[int, Field(ge=0, le=10_000)] | None = None
    """Number of the thing that is meant, where the text alone leaves that open."""
    demo: _Name = ""


Message = Input | Set | Control | Stop | Release | Do | Talk
_ADAPTER: TypeAdapter[Message] = TypeAdapter(Annotated[Message, Field(discriminator="type")])


def read_message(data: str | bytes) -> Message:
    """Read what a page sent.

    Raises:
        ProtocolError: It is not JSON, or not a message, or a value has the wrong type.
    """
    if isinstance(data, bytes):
        raise ProtocolError("a message must be text")
    try:
        return _ADAPTER.validate_json(data)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        where = ".".join(str(part) for part in first["loc"]) or "message"
        raise ProtocolError(f"{where}: {first['msg']}") from error
