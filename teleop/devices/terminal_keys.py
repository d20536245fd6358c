"""Bytes that a terminal sends for keys, and for how long each key counts as held."""

import math
import re

HELD_FOR = 0.35
"""A key counts as held this long after it was pressed [s]: terminals tell repeats, never releases."""
REPEATS_WITHIN = 0.1
"""The same key again after no more than this [s] is a repeat of one that is held; nobody taps so fast."""
REPEATED_FOR = 0.095
"""A key that repeats counts as held this long after it last came [s]: a terminal that freezes then stops the robot as
soon as any other lost input does (`drive_command.MAX_AGE`, less a control period)."""
LONE_ESCAPE = 0.03
"""An escape that nothing follows for this long is the escape key [s]; in a sequence bytes follow at once."""

_NAMED = {" ": "space", "\r": "enter", "\n": "enter", "\t": "tab", "\x7f": "backspace", "\x08": "backspace"}
_ARROWS = {"A": "arrowup", "B": "arrowdown", "C": "arrowright", "D": "arrowleft"}
_SEQUENCE = re.compile(r"\x1b(?:\[(?P<rest>[0-9;?]*)(?P<final>[@-~])|O(?P<keypad>[A-Z]))")
_SHIFTED = "1;2"
_UNFINISHED = re.compile(r"\x1b(?:\[[0-9;?]*|O)?")
LONGEST_SEQUENCE = 16
"""Bytes after which an unfinished sequence is given up."""


class TerminalKeys:
    """Which keys are held, from the bytes that came and when; knows no terminal, so that it can be tested by itself.

    A terminal repeats only the key that was pressed last, and starts to repeat it after about half a second: two keys
    that were just pressed are held together for `HELD_FOR`, and a single one may pause once before its first repeat.
    """

    def __init__(self) -> None:
        """Nothing is held."""
        self._until: dict[str, float] = {}
        self._came: dict[str, float] = {}
        self._rest = ""
        self._rest_since = 0.0

    def feed(self, data: bytes, now: float) -> None:
        """Take bytes that came at a time [s]."""
        if data:
            if not self._rest:
                self._rest_since = now
            self._rest += data.decode("utf-8", errors="replace")
        text, self._rest = self._rest, ""
        place = 0
        while place < len(text):
            if text[place] != "\x1b":
                self._press_character(text[place], now)
                place += 1
            elif match := _SEQUENCE.match(text, place):
                self._press_sequence(match, now)
                place = match.end()
            elif (
                _UNFINISHED.fullmatch(text, place)
                and now - self._rest_since < LONE_ESCAPE
                and len(text) - place < LONGEST_SEQUENCE
            ):
                self._rest = text[place:]
                return
            else:
                self._press("escape", now)
                place += 1

    def held(self, now: float) -> frozenset[str]:
        """Return the keys that count as held at a time [s]."""
        self._until = {key: until for key, until in self._until.items() if until > now}
        self._came = {key: came for key, came in self._came.items() if now - came <= REPEATS_WITHIN}
        return frozenset(self._until)

    def _press_character(self, character: str, now: float) -> None:
        if character in _NAMED:
            self._press(_NAMED[character], now)
        elif character.isprintable() and character != "\ufffd":
            self._press(character.lower(), now, shift=character.isupper())

    def _press_sequence(self, match: re.Match[str], now: float) -> None:
        key = _ARROWS.get(match["keypad"] or match["final"])
        if key:
            self._press(key, now, shift=(match["rest"] or "") == _SHIFTED)

    def _press(self, key: str, now: float, shift: bool = False) -> None:
        repeats = now - self._came.get(key, -math.inf) <= REPEATS_WITHIN
        self._came[key] = now
        self._until[key] = now + (REPEATED_FOR if repeats else HELD_FOR)
        if shift:
            self._until["shift"] = self._until[key]
        elif "shift" in self._until and len(key) == 1 and key.isalpha():
            del self._until["shift"]  # a small letter says that shift was let go
