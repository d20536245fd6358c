"""What a step notes on the way: why each arm, and the base, does not do what it was asked."""

from collections.abc import Iterable

from .servo_reason import DriveReason

BASE = "base"
_ORDER = list(DriveReason)


class ServoNotes:
    """Reasons by arm and for the base, of which the first in the order of `DriveReason` counts.

    Attributes:
        slid: Arms that were turned off their way, not only slowed on it.
    """

    def __init__(self, names: Iterable[str]) -> None:
        """Nothing noted yet, of these and of the base."""
        self._notes: dict[str, tuple[DriveReason, str]] = dict.fromkeys((*names, BASE), (DriveReason.NONE, ""))
        self.slid: set[str] = set()

    def __getitem__(self, name: str) -> tuple[DriveReason, str]:
        """The reason and what is behind it."""
        return self._notes[name]

    def note(self, name: str, reason: DriveReason, detail: str, *, slides: bool = False) -> None:
        """Note a reason, with what is behind it, and whether the arm leaves its way for it."""
        before = self._notes[name][0]
        if reason is not DriveReason.NONE and (
            before is DriveReason.NONE or _ORDER.index(reason) < _ORDER.index(before)
        ):
            self._notes[name] = reason, detail
        if slides:
            self.slid.add(name)
