"""What a mapping file says, checked: what each control does, which key plays which control, how an odd pad is read."""

from functools import cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from robots.validation import read_toml

from .control_expression import Chord, Sum, parse_chords, parse_sum
from .drive_command import TwistFrame
from .errors import TeleopError
from .gamepad import AXIS_INDEX, BUTTON_INDEX
from .pad_source import parse_axis_source, parse_button_source

DEFAULT_FILE = Path(__file__).parent / "mappings" / "default.toml"
"""The mapping that comes with Showtell."""
ANY = "any"
"""Section of a robot that no other section names."""

Speed = Annotated[float, Field(gt=0.0, le=10.0)]


class MappingError(TeleopError, ValueError):
    """A mapping file is wrong or does not fit the robot; the message names file, key, value and what is allowed."""


class _Section(BaseModel):
    """A table of the file: frozen, and no key that we do not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")


class AxesSection(_Section):
    """Axes of motion, each a sum of controls: linear x, y, z, turning about them, one joint, and the wheels."""

    x: str = ""
    y: str = ""
    z: str = ""
    roll: str = ""
    pitch: str = ""
    yaw: str = ""
    jog: str = ""
    drive: str = ""
    turn: str = ""

    @field_validator("*")
    @classmethod
    def _readable(cls, text: str) -> str:
        parse_sum(text)
        return text

    def sums(self) -> dict[str, Sum]:
        """The axes that have controls."""
        return {name: parse_sum(text) for name, text in self if text.strip()}


class ButtonsSection(_Section):
    """Actions, each a button, a chord or alternatives of them.

    Held: `gripper_close`, `gripper_open`, `enable` (the dead-man switch: without it nothing moves), `stop`. The others
    act when they are pressed. `record`, `discard`, `redo`, `success`, `failure` and `trim` are for whoever records.
    """

    gripper_close: str = ""
    gripper_open: str = ""
    enable: str = ""
    stop: str = ""
    release: str = ""
    choose_left: str = ""
    choose_right: str = ""
    choose_both: str = ""
    next_arm: str = ""
    mode: str = ""
    frame: str = ""
    jog: str = ""
    joint_next: str = ""
    joint_previous: str = ""
    speed_up: str = ""
    speed_down: str = ""
    record: str = ""
    discard: str = ""
    redo: str = ""
    success: str = ""
    failure: str = ""
    trim: str = ""

    @field_validator("*")
    @classmethod
    def _readable(cls, text: str) -> str:
        parse_chords(text)
        return text

    def chords(self) -> dict[str, tuple[Chord, ...]]:
        """The actions that have buttons."""
        return {name: parse_chords(text) for name, text in self if text.strip()}


class RobotSection(_Section):
    """How one robot is driven: speeds at full deflection [m/s], [rad/s], and the feel of the sticks."""

    top_speed: Speed = 0.05
    turn_speed: Speed = 0.3
    jog_speed: Speed = 0.3
    base_speed: Speed = 0.2
    base_turn_speed: Speed = 0.4
    each_axis: bool = False
    """Whether the speeds are those of each axis alone; otherwise those of all axes together."""
    dead_zone: Annotated[float, Field(ge=0.0, lt=1.0)] = 0.08
    expo: Annotated[float, Field(ge=0.0, le=1.0)] = 0.4
    frames: Annotated[tuple[TwistFrame, ...], Field(min_length=1)] = ("world",)
    axes: AxesSection = AxesSection()
    buttons: ButtonsSection = ButtonsSection()


class KeyboardSection(_Section):
    """Which controls each key plays."""

    slow: Annotated[float, Field(gt=0.0, le=1.0)] = 0.4
    keys: dict[Annotated[str, Field(min_length=1, max_length=20)], str] = Field(default_factory=dict)

    @field_validator("keys")
    @classmethod
    def _readable(cls, keys: dict[str, str]) -> dict[str, str]:
        for key, text in keys.items():
            if key != key.lower() or key == "shift":
                raise ValueError(f"key {key!r}: write keys in lower case; shift makes every key slow")
            try:
                parse_sum(text)
            except ValueError as error:
                raise ValueError(f"key {key!r}: {error}") from error
        return keys


class PadSection(_Section):
    """Where a gamepad that SDL does not know has its controls."""

    axes: dict[str, str] = Field(default_factory=dict)
    buttons: dict[str, str] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _readable(self) -> "PadSection":
        for kind, given, allowed in (("axes", self.axes, AXIS_INDEX), ("buttons", self.buttons, BUTTON_INDEX)):
            for name, text in given.items():
                if name not in allowed:
                    raise ValueError(f"{kind}.{name}: unknown; allowed are {', '.join(allowed)}")
                try:
                    parse_axis_source(text) if kind == "axes" else parse_button_source(text)
                except ValueError as error:
                    raise ValueError(f"{kind}.{name}: {error}") from error
        return self


class MappingFile(_Section):
    """A whole mapping file."""

    robot: dict[str, RobotSection] = Field(default_factory=dict)
    keyboard: KeyboardSection = KeyboardSection()
    pad: dict[str, PadSection] = Field(default_factory=dict)


def read_mapping_file(path: str | Path | None = None) -> MappingFile:
    """Read a mapping; what the file leaves out is as in the one that comes with Showtell.

    Args:
        path: A TOML file; None takes the one that comes with Showtell.

    Raises:
        MappingError: The file cannot be read, is not TOML, or a value is wrong; names file, key and what is allowed.
    """
    if path is None:
        return _default()
    own = read_toml(Path(path), MappingFile, MappingError).model_dump(exclude_unset=True)
    default = _default().model_dump(exclude_unset=True)
    merged = _merge(default, own)
    for name, section in own.get("robot", {}).items():
        if name not in default["robot"]:  # a robot of the user's own starts from what suits any
            merged["robot"][name] = _merge(default["robot"][ANY], section)
    return MappingFile.model_validate(merged)


@cache
def _default() -> MappingFile:
    return read_toml(DEFAULT_FILE, MappingFile, MappingError)


def _merge(base: dict[str, Any], over: dict[str, Any]) -> dict[str, Any]:
    """Tables are merged key by key; everything else is replaced."""
    merged = dict(base)
    for key, value in over.items():
        inner = merged.get(key)
        merged[key] = _merge(inner, value) if isinstance(inner, dict) and isinstance(value, dict) else value
    return merged
