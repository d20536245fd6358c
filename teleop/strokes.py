"""Strokes: what a person who drives a hand over a table does, one after the other (see `table_operator`)."""

from dataclasses import dataclass

from robots.pose import FloatArray, Pose

from .gamepad_mapping import GripperWish


@dataclass(frozen=True, slots=True)
class Reach:
    """Move the tool in a straight line to a pose, turning on the way.

    Attributes:
        pose: Where to, in the world.
        speed: Largest speed [m/s].
        turning: Largest turning speed [rad/s].
        near: Nearer is there [m].
        aligned: Turned by less than this is there [rad].
        onwards: Whether the point is only passed: the hand does not slow down for it.
        push: End when the wrist is pushed against the motion by this force more than at the start [N].
        patience: How much longer than a smooth motion it may take [s].
    """

    pose: Pose
    speed: float
    turning: float = 1.2
    near: float = 0.003
    aligned: float = 0.02
    onwards: bool = False
    push: float | None = None
    patience: float = 5.0


@dataclass(frozen=True, slots=True)
class Grip:
    """Close or open the fingers and wait until they are still.

    Attributes:
        wish: What they do.
        settle: How long to wait then [s].
    """

    wish: GripperWish
    settle: float = 0.15


@dataclass(frozen=True, slots=True)
class Rest:
    """Hold the hand still.

    Attributes:
        seconds: How long [s].
    """

    seconds: float


@dataclass(frozen=True, slots=True)
class Press:
    """Move on slowly until something pushes back more than at the operator's start, and press on it for a while.

    Attributes:
        direction: Where to, (3,), a unit vector in the world.
        force: With what force [N].
        seconds: For how long [s].
        speed: How fast until then [m/s].
        farthest: It gives up when nothing pushed back after this way [m].
    """

    direction: FloatArray
    force: float
    seconds: float
    speed: float = 0.004
    farthest: float = 0.02


Stroke = Reach | Grip | Rest | Press


@dataclass(frozen=True, slots=True)
class Manner:
    """How a person drives.

    Attributes:
        tremble: How much the hand strays [m/s].
        hesitation: Longest pause between two strokes [s].
    """

    tremble: float = 0.004
    hesitation: float = 0.15
