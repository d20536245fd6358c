"""Motion primitives: what one arm does between two states of an action graphlet."""

from dataclasses import dataclass

from learning.graphs.graphlet_state import Side


@dataclass(frozen=True, slots=True)
class Shape:
    """Open or close the hand away from the object."""

    closed: bool

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "close the hand" if self.closed else "open the hand"


@dataclass(frozen=True, slots=True)
class Reach:
    """Bring the open hand around the object; from there it must be possible to lift it by `lift` [m]."""

    lift: float

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "bring the open hand around it"


@dataclass(frozen=True, slots=True)
class Close:
    """Close the fingers on the object."""

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "close the fingers on it"


@dataclass(frozen=True, slots=True)
class Lift:
    """Lift the held object straight up by a height [m]."""

    height: float

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return f"lift it by {100 * self.height:.0f} cm"


@dataclass(frozen=True, slots=True)
class Carry:
    """Carry the held object above its destination; stay where it is if there is none."""

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "carry it above its place"


@dataclass(frozen=True, slots=True)
class Lower:
    """Lower the held object until the wrist feels that it is borne."""

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "lower it until it stands"


@dataclass(frozen=True, slots=True)
class Release:
    """Open the fingers around the object."""

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "let it go"


@dataclass(frozen=True, slots=True)
class Retreat:
    """Draw the hand back the way it came."""

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return "draw the hand back"


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

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return f"touch it from {self.side.name.lower()} with the closed hand"


@dataclass(frozen=True, slots=True)
class Push:
    """Push the object on, away from the hand, by a way [m]."""

    way: float

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return f"push it on by {100 * self.way:.0f} cm"


@dataclass(frozen=True, slots=True)
class Stay:
    """Keep everything as it is for a time [s]."""

    seconds: float

    def __str__(self) -> str:
        """What the hand does, in plain words."""
        return f"stay for {self.seconds:.1f} s"


Primitive = Shape | Reach | Close | Lift | Carry | Lower | Release | Retreat | Touch | Push | Stay
