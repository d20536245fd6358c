"""What driving remembers between two looks at the gamepad, and what it tells."""

from dataclasses import dataclass
from typing import Literal

from .drive_command import TwistFrame

SPEED_STEPS = (0.1, 0.2, 0.35, 0.5, 0.75, 1.0)
"""Speed ratios that the speed buttons step through."""

EventName = Literal[
    "stop",
    "release",
    "arms",
    "mode",
    "frame",
    "jog",
    "joint",
    "speed",
    "record",
    "discard",
    "redo",
    "success",
    "failure",
    "trim",
]
RECORDING: tuple[EventName, ...] = ("record", "discard", "redo", "success", "failure", "trim")
"""Events that driving itself does not act on."""


@dataclass(frozen=True, slots=True)
class DriveEvent:
    """Something that a button did.

    Attributes:
        name: What happened.
        detail: To what it was changed: arms, mode, frame, joint or speed ratio.
    """

    name: EventName
    detail: str = ""


@dataclass(frozen=True, slots=True)
class DriveState:
    """Everything that a `DriveMapping` remembers; a new one stands for a gamepad just taken up.

    Attributes:
        arms: The arms that the sticks move.
        mode: Whether the sticks move arms or the wheels.
        frame: The frame whose axes the sticks follow.
        jogging: Whether they move a single joint.
        joint: Which one, counted from the base of the arm.
        speed_ratio: 0..1, scales everything.
        stopped: Whether the emergency stop holds.
        armed: Whether the sticks have been seen at rest since the start, since a fault, since a stop and since what
            they move was changed; until then they move nothing, so that nothing starts by surprise.
        held: Buttons that were pressed at the last look.
        spent: Of these, those that took part in a chord; they do nothing alone when they are released.
        seen: Whether `held` and `spent` are of the last look; False since the input was lost, until it is back.
    """

    arms: tuple[str, ...]
    mode: Literal["arm", "base"] = "arm"
    frame: TwistFrame = "world"
    jogging: bool = False
    joint: int = 0
    speed_ratio: float = 1.0
    stopped: bool = False
    armed: bool = False
    held: frozenset[str] = frozenset()
    spent: frozenset[str] = frozenset()
    seen: bool = True
