"""Where a gamepad in its own layout has a control: `a0`, `a0~`, `+a2`, `b3`, `h0.up`, much as SDL writes it."""

import re
from dataclasses import dataclass
from typing import Literal

_AXIS = re.compile(r"(?P<half>[+-]?)a(?P<index>\d{1,2})(?P<turned>~?)")
_BUTTON = re.compile(r"b(?P<index>\d{1,3})")
_HAT = re.compile(r"h(?P<index>\d)\.(?P<way>up|down|left|right)")
_WAYS = {"up": (1, 1), "down": (1, -1), "left": (0, -1), "right": (0, 1)}


@dataclass(frozen=True, slots=True)
class RawInput:
    """What a gamepad says in its own layout.

    Attributes:
        axes: Each in -1..1.
        buttons: Each 0 or 1.
        hats: Each (right, up), of -1, 0 and 1.
    """

    axes: tuple[float, ...] = ()
    buttons: tuple[float, ...] = ()
    hats: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True, slots=True)
class PadSource:
    """One input of a gamepad in its own layout.

    Attributes:
        kind: Kind of the input: `axis` as it is, `whole` or `half` an axis as 0..1, a `button` or a `hat`.
        index: Which of its kind.
        sign: -1 where the axis is turned round or its negative half is meant.
        part: Of a hat: 0 for left and right, 1 for up and down.
    """

    kind: Literal["axis", "whole", "half", "button", "hat"]
    index: int
    sign: float = 1.0
    part: int = 0

    def value(self, raw: RawInput) -> float:
        """What this input says now; 0 where the gamepad has no such input."""
        inputs = raw.buttons if self.kind == "button" else raw.hats if self.kind == "hat" else raw.axes
        if self.index >= len(inputs):
            return 0.0
        if self.kind == "button":
            return raw.buttons[self.index]
        if self.kind == "hat":
            return 1.0 if raw.hats[self.index][self.part] == self.sign else 0.0
        value = self.sign * raw.axes[self.index]
        return value if self.kind == "axis" else 0.5 * (value + 1.0) if self.kind == "whole" else max(value, 0.0)


def parse_axis_source(text: str) -> PadSource:
    """Parse where an axis is: `a0`, or `a0~` when it is turned round.

    Raises:
        ValueError: The text says something else.
    """
    match = _AXIS.fullmatch(text)
    if match is None or match["half"]:
        raise ValueError(f'{text!r} is no axis: write "a0", or "a0~" when it is turned round')
    return PadSource("axis", int(match["index"]), -1.0 if match["turned"] else 1.0)


def parse_button_source(text: str) -> PadSource:
    """Parse where a button or trigger is: `b0`, `a2` (whole way), `a2~`, `+a2` or `-a2` (half of it), `h0.up`.

    Raises:
        ValueError: The text says something else.
    """
    if match := _BUTTON.fullmatch(text):
        return PadSource("button", int(match["index"]))
    if match := _HAT.fullmatch(text):
        part, sign = _WAYS[match["way"]]
        return PadSource("hat", int(match["index"]), float(sign), part)
    match = _AXIS.fullmatch(text)
    if match is None or (match["half"] and match["turned"]):
        raise ValueError(f'{text!r} is no button: write "b0", "h0.up", or of an axis "a2", "a2~", "+a2" or "-a2"')
    if match["half"]:
        return PadSource("half", int(match["index"]), -1.0 if match["half"] == "-" else 1.0)
    return PadSource("whole", int(match["index"]), -1.0 if match["turned"] else 1.0)
