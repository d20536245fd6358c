"""What a person sees who describes a demo: what was done, with which thing, among which, and where it went."""

from dataclasses import dataclass
from typing import Literal

from twin.objects import look_of
from twin.objects.tables import ORDERING

TableAction = Literal["pick up", "put down", "move"]
Relation = Literal["left", "right", "front", "behind", "in", "on"]
Row = Literal["top", "middle", "bottom"]
Column = Literal["left", "middle", "right"]
Place = tuple[Row, Column]
"""A part of the table as the robot sees it: top is far from it, left is +y."""

ROWS_AT = (0.58, 0.72)
"""Where the middle row of the table begins and ends [m]: from the robot outwards."""
COLUMNS_AT = 0.12
"""The middle column goes so far to both sides [m]."""
BESIDE = 0.20
"""Things nearer than this are beside each other [m]."""


@dataclass(frozen=True, slots=True)
class OrderingFacts:
    """What there is to say of a demo with one object.

    Attributes:
        action: What was done.
        shape: Class of the object.
        colour: Its colour.
        size: `small` or `large`.
    """

    action: str
    shape: str
    colour: str
    size: str

    @classmethod
    def of_model(cls, action: str, model: str) -> "OrderingFacts":
        """Facts of an action with an object of the ordering catalogue."""
        entry = ORDERING[model]
        return cls(action, entry.shape, entry.colour, entry.size)


@dataclass(frozen=True, slots=True)
class Thing:
    """A thing on the table.

    Attributes:
        id: Its number in the scene.
        shape: Its class.
        colour: Its colour.
        x: Where it is, from the robot outwards [m].
        y: To the left [m].
    """

    id: int
    shape: str
    colour: str
    x: float
    y: float

    @classmethod
    def of_model(cls, identity: int, model: str, x: float, y: float) -> "Thing":
        """A thing of a catalogue."""
        shape, colour = look_of(model)
        return cls(identity, shape, colour, x, y)

    @property
    def place(self) -> Place:
        """The part of the table where it is."""
        return place_at(self.x, self.y)


@dataclass(frozen=True, slots=True)
class Destination:
    """Where a thing went.

    Attributes:
        place: The part of the table, where that is how it was meant.
        relation: How it is to another thing, where that was meant.
        reference: That thing's id.
    """

    place: Place | None = None
    relation: Relation | None = None
    reference: int | None = None


@dataclass(frozen=True, slots=True)
class TableFacts:
    """What there is to say of a demo at a table with several things.

    Attributes:
        action: What was done.
        target: With which thing, where it was before; where it is held, in the middle of nowhere.
        things: All things, the target among them.
        destination: Where it went; None when it was only picked up.
        held: Whether it was in the hand from the start.
    """

    action: TableAction
    target: Thing
    things: tuple[Thing, ...]
    destination: Destination | None = None
    held: bool = False

    def thing(self, identity: int) -> Thing:
        """The thing of a number."""
        return next(each for each in self.things if each.id == identity)


def place_at(x: float, y: float) -> Place:
    """The part of the table at a point [m]."""
    row: Row = "bottom" if x < ROWS_AT[0] else "top" if x > ROWS_AT[1] else "middle"
    column: Column = "left" if y > COLUMNS_AT else "right" if y < -COLUMNS_AT else "middle"
    return row, column
