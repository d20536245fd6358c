"""Buttons to actions: what is held, what was just pressed, and chords that keep their members from acting alone."""

from collections.abc import Mapping
from dataclasses import dataclass

from .control_expression import Chord
from .gamepad import BUTTONS, GamepadState

PRESSED = 0.5
"""A button or trigger pressed further than this counts as pressed."""


@dataclass(frozen=True, slots=True)
class Presses:
    """What the buttons say at one look.

    Attributes:
        pressed: Buttons that are pressed.
        spent: Of these, those that took part in a chord since they were pressed; they do nothing else until they are
            released.
        held: Actions whose buttons are held.
        fired: Actions whose buttons were pressed since the last look.
    """

    pressed: frozenset[str]
    spent: frozenset[str]
    held: frozenset[str]
    fired: frozenset[str]


class ButtonReader:
    """Reads the actions of one robot's mapping; keeps no state."""

    def __init__(self, chords: Mapping[str, tuple[Chord, ...]]) -> None:
        """Take the buttons of each action.

        Args:
            chords: Alternatives of each action, each of buttons that are held together.
        """
        self._alone = tuple(
            (action, chord[0]) for action, chords_ in chords.items() for chord in chords_ if len(chord) == 1
        )
        self._together = tuple(
            (action, chord, frozenset(chord))
            for action, chords_ in chords.items()
            for chord in chords_
            if len(chord) > 1
        )
        self._leaders = frozenset(chord[0] for _, chord, _ in self._together)

    def read(self, gamepad: GamepadState, before: frozenset[str], spent: frozenset[str]) -> Presses:
        """Read the buttons.

        Args:
            gamepad: What the gamepad says now.
            before: `pressed` of the last look.
            spent: `spent` of the last look.
        """
        pressed = frozenset(name for name, value in zip(BUTTONS, gamepad.buttons, strict=True) if value > PRESSED)
        if not pressed and not before:
            return _NOTHING
        held: set[str] = set()
        fired: set[str] = set()
        masked = set(spent & pressed)  # whatever was let go first, the rest of a chord stays quiet
        for action, _, members in self._together:
            if members <= pressed:
                held.add(action)
                masked |= members
                if not members <= before:
                    fired.add(action)
        for action, name in self._alone:
            if name in pressed and name not in masked:
                held.add(action)
            if name in self._leaders:  # it may become a chord, so what it does alone waits for its release
                if name in before and name not in pressed and name not in spent:
                    fired.add(action)
            elif name in pressed and name not in before and name not in masked:
                fired.add(action)
        return Presses(pressed, frozenset(masked), frozenset(held), frozenset(fired))


_NOTHING = Presses(frozenset(), frozenset(), frozenset(), frozenset())
