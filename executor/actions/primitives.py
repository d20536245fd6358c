"""Motion primitives: what one arm does between two states of an action graphlet."""

from dataclasses import dataclass

from learning.graphs.graphlet_state import Side


@dataclass(frozen=True, slots=True)
class Shape:
    """Open or close the hand away from the object."""

    closed: bool


@dataclass(frozen=True, slots=True)
class Reach:
    """Bring the open hand around the object; from there it must be possible to lift it by `lift` [m]."""

    lift: float


@dataclass(frozen=True, slots=True)
class Close:
    """Close the fingers on the object."""


@dataclass(frozen=True, slots=True)
class Lift:
    """Lift the held object straight up by a height [m]."""

    height: float


@dataclass(frozen=True, slots=True)
class Carry:
    """Carry the held object above its destination; stay where it is if there is none."""


@dataclass(frozen=True, slots=True)
class Lower:
    """Lower the held object until the wrist feels that it is borne."""


@dataclass(frozen=True, slots=True)
class Release:
    """Open the fingers around the object."""


@dataclass(frozen=True, slots=True)
class Retreat:
    """Draw the hand back the way it came."""


@dataclass(frozen=True, slots=True)
class Touch:
    """Bring the closed hand against the object until the wrist feels a force [N].

    Attributes:
        side: From where.
        force: How much is felt then [N].
        onwards: How far the object will be pushed on from there [m]; 0 for a touch that leaves it where it is.
    """

    side: Side
    force: float
    onwards: float = 0.0


@dataclass(frozen=True, slots=True)
class Push:
    """Push the object on, away from the hand, by a way [m]."""

    way: float


@dataclass(frozen=True, slots=True)
class Stay:
    """Keep everything as it is for a time [s]."""

    seconds: float


Primitive = Shape | Reach | Close | Lift | Carry | Lower | Release | Retreat | Touch | Push | Stay
