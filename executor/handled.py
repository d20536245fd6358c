"""Outcome of a step of handling."""

from dataclasses import dataclass

from twin.slip import Slip


@dataclass(frozen=True, slots=True)
class Handled:
    """Outcome of a step of handling.

    Attributes:
        success: Whether it was done.
        reason: Why not, in plain words; its first word or two name the kind of failure.
        slip: How the object moved in the hand, where it was held.
    """

    success: bool
    reason: str = ""
    slip: Slip | None = None
