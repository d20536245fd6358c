"""A motion plan: what the tool and the gripper do, one after the other."""

from dataclasses import dataclass
from typing import Literal

from robots.pose import FloatArray, read_only

Purpose = Literal["approach", "descend", "lift", "carry", "lower", "retreat"]


@dataclass(frozen=True, slots=True)
class MoveTool:
    """Move the tool frame on a straight line.

    Attributes:
        position: Where the tool frame stops, in the world, (3,) [m].
        purpose: Which part of the action this is.
        state: Index of the graphlet state that asked for it.
    """

    position: FloatArray
    purpose: Purpose
    state: int

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "position", read_only(self.position))

    def __str__(self) -> str:
        """Purpose and target, in metres."""
        x, y, z = self.position
        return f"{self.purpose} to ({x:.3f}, {y:.3f}, {z:.3f}) m"


@dataclass(frozen=True, slots=True)
class MoveGripper:
    """Open or close the gripper and wait until the fingers have settled.

    Attributes:
        closed: Whether the fingers close.
        state: Index of the graphlet state that asked for it.
    """

    closed: bool
    state: int

    def __str__(self) -> str:
        """What the fingers do."""
        return "close the gripper" if self.closed else "open the gripper"


Step = MoveTool | MoveGripper


@dataclass(frozen=True, slots=True)
class MotionPlan:
    """Tool waypoints and gripper moves in order.

    Attributes:
        steps: What to do, in order.
        object_id: Which object the plan moves.
        goal: Where the object's centre ends in the world, (3,) [m]; None where it stays in the gripper.
    """

    steps: tuple[Step, ...]
    object_id: int
    goal: FloatArray | None

    @property
    def ends_closed(self) -> bool | None:
        """Whether the last gripper move closes it; None when the plan moves no finger."""
        closed = [step.closed for step in self.steps if isinstance(step, MoveGripper)]
        return closed[-1] if closed else None

    def lines(self) -> tuple[str, ...]:
        """One line a step, for people."""
        return tuple(str(step) for step in self.steps)
