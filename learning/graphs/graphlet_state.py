"""One state of an action graphlet: what the gripper does with the object, qualitatively (thesis 3.3.4, figure 3.14)."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any


class Side(IntEnum):
    """From where a hand that is closed on nothing touches an object.

    It abstracts the directions of the direction space: all whose altitude is steep are one, all that are level are one,
    whatever their azimuth, as an action is the same in whichever way it points along the table.
    """

    BESIDE = 0
    ABOVE = 1


@dataclass(frozen=True, slots=True)
class GraphletState:
    """One qualitative state of the gripper and the object it manipulates.

    The first three attributes are all that is seen on the board, where a closed gripper that touches a block holds it.
    Cameras and the hand's own sense tell more, and the further attributes keep their defaults where nothing is told.

    Attributes:
        gripper_closed: State of the gripper: what it was told.
        touching: Whether the distance between gripper and object is the *at it* concept.
        object_location: Location variable of the object, numbered in order of appearance; any place can fill it in. An
            object in the air is at a place of its own until it is set down.
        raised: Whether the object's underside is clear of what bears it (the table, another object).
        side: From where the hand touches, if it is closed on nothing: the fingers are then not around the object and
            push or press it from outside. None where the hand is open, holds the object, or is apart from it.
    """

    gripper_closed: bool
    touching: bool
    object_location: int
    raised: bool = False
    side: Side | None = None

    @property
    def holds(self) -> bool:
        """Whether the object is between the closed fingers."""
        return self.gripper_closed and self.touching and self.side is None

    def at(self, object_location: int) -> "GraphletState":
        """The same state with another location variable."""
        return GraphletState(self.gripper_closed, self.touching, object_location, self.raised, self.side)

    def __str__(self) -> str:
        """Write the state as `C touch 1`, `C touch raised 1` or `C touch above 0`."""
        words = ["C" if self.gripper_closed else "O", "touch" if self.touching else "apart"]
        if self.side is not None:
            words.append(self.side.name.lower())
        if self.raised:
            words.append("raised")
        return " ".join([*words, str(self.object_location)])

    def to_json(self) -> list[int]:
        """`[closed, touching, location]`, then `raised` and `side` up to the last that is not the default."""
        row = [int(self.gripper_closed), int(self.touching), self.object_location]
        if self.raised or self.side is not None:
            row.append(int(self.raised))
        if self.side is not None:
            row.append(int(self.side))
        return row

    @classmethod
    def from_json(cls, row: Sequence[Any]) -> "GraphletState":
        """Rebuild a state.

        Raises:
            ValueError, TypeError: `row` is not what `to_json` wrote.
        """
        closed, touching, location, *more = row
        if closed not in (0, 1) or touching not in (0, 1) or int(location) < 0:
            raise ValueError(f"graphlet state {row} must be [closed 0 or 1, touching 0 or 1, location 0 or more]")
        raised = more[0] if more else 0
        side = more[1] if len(more) > 1 else None
        if len(more) > 2 or raised not in (0, 1) or side not in (None, *Side):
            raise ValueError(f"graphlet state {row} may go on with raised 0 or 1 and side 0 or 1, and nothing else")
        found = None if side is None else Side(side)
        return cls(bool(closed), bool(touching), int(location), bool(raised), found)
