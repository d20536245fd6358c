"""What a step notes on the way: why each arm, and the base, does not do what it was asked."""

from collections.abc import Iterable

from .servo_reason import DriveReason

BASE = "base"
_ORDER = list(DriveReason)


class ServoNotes:
    """Reasons by arm and for the base, of which the first in the order of `DriveReason` counts.

    Attributes:
        slid: Arms that were turned off their way, not only slowed on it.
        always: Arms whose reason is said even where the arm itself does what it was asked: it concerns the fingers.
    """

    def __init__(self, names: Iterable[str]) -> None:
        """Nothing noted yet, of these and of the base."""
        self._notes: dict[str, tuple[DriveReason, str]] = dict.fromkeys((*names, BASE), (DriveReason.NONE, ""))
        self.slid: set[str] = set()
        self.always: set[str] = set()

    def __getitem__(self, name: str) -> tuple[DriveReason, str]:
        """The reason and what is behind it."""
        return self._notes[name]

    def note(self, name: str, reason: DriveReason, detail: str, *, slides: bool = False, always: bool = False) -> None:
        """Note a reason and what is behind it, whether the arm leaves its way for it, and whether to say it always."""
        before = self._notes[name][0]
        if reason is not DriveReason.NONE and (
            before is DriveReason.NONE or _ORDER.index(reason) < _ORDER.index(before)
        ):
            self._notes[name] = reason, detail
        if slides:
            self.slid.add(name)
        if always:
            self.always.add(name)
