"""The small language in which a mapping names controls: sums of them for motion, chords of buttons for actions."""

import re
from dataclasses import dataclass

from .gamepad import AXES, AXIS_INDEX, BUTTON_INDEX, BUTTONS

_TERM = re.compile(r"\s*(?P<sign>[+-]?)\s*(?:(?P<factor>\d+(?:\.\d*)?|\.\d+)\s*\*\s*)?(?P<name>[a-z_]\w*)\s*")
LONGEST = 200
"""Characters that an expression may have; a mapping is written by hand."""


@dataclass(frozen=True, slots=True)
class Term:
    """One control's part in a sum.

    Attributes:
        name: The control.
        is_axis: Whether it is an axis; otherwise it is a button.
        index: Its place among the axes or buttons.
        factor: What it is multiplied with.
    """

    name: str
    is_axis: bool
    index: int
    factor: float


Sum = tuple[Term, ...]
Chord = tuple[str, ...]


def parse_sum(text: str) -> Sum:
    """Parse `"-left_y + up - 0.5 * down"`; empty text is an empty sum.

    Raises:
        ValueError: The text is not a sum of controls; says where, and which controls there are.
    """
    _check_length(text)
    terms: list[Term] = []
    place = 0
    rest = text.strip()
    while place < len(rest):
        match = _TERM.match(rest, place)
        if match is None or (terms and not match["sign"]):
            raise ValueError(
                f"cannot read {rest[place:]!r} in {text!r}: write a sum of controls such as "
                '"-left_y + up - down" or "0.5 * right_x"'
            )
        name = match["name"]
        if name not in AXIS_INDEX and name not in BUTTON_INDEX:
            raise ValueError(f"a gamepad has no {name!r}; it has {', '.join(AXES + BUTTONS)}")
        if any(term.name == name for term in terms):
            raise ValueError(f"{name} stands twice in {text!r}")
        factor = float(match["factor"] or 1.0) * (-1.0 if match["sign"] == "-" else 1.0)
        if not 0.0 < abs(factor) <= 1.0:
            raise ValueError(f"the factor of {name} is {factor:g}, allowed above 0 up to 1; set speeds by top_speed")
        is_axis = name in AXIS_INDEX
        terms.append(Term(name, is_axis, AXIS_INDEX[name] if is_axis else BUTTON_INDEX[name], factor))
        place = match.end()
    return tuple(terms)


def parse_chords(text: str) -> tuple[Chord, ...]:
    """Parse `"guide | left_stick + right_stick"`: alternatives, each of buttons held together; empty text is none.

    Raises:
        ValueError: A name is no button, or the text is not such a list; says which buttons there are.
    """
    _check_length(text)
    if not text.strip():
        return ()
    chords = []
    for alternative in text.split("|"):
        names = tuple(name.strip() for name in alternative.split("+"))
        for name in names:
            if name not in BUTTON_INDEX:
                raise ValueError(f"a gamepad has no button {name!r}; it has {', '.join(BUTTONS)}")
        if len(set(names)) != len(names):
            raise ValueError(f"a button stands twice in {alternative.strip()!r}")
        chords.append(names)
    return tuple(chords)


def _check_length(text: str) -> None:
    if len(text) > LONGEST:
        raise ValueError(f"an expression of {len(text)} characters, allowed {LONGEST}")
