"""What an operator is asked to do."""

from dataclasses import dataclass

from robots.pose import FloatArray, read_only


@dataclass(frozen=True, slots=True)
class Task:
    """Move one object.

    Attributes:
        object_id: The object to take; None takes up with the one that is already in the gripper.
        goal: Where its centre should end, (3,) [m] in the world; None lifts it a little and keeps it.
        release: Whether to let go at the goal; False keeps holding it there (a lone take).
    """

    object_id: int | None
    goal: FloatArray | None
    release: bool = True

    def __post_init__(self) -> None:
        """Freeze the goal."""
        if self.goal is not None:
            object.__setattr__(self, "goal", read_only(self.goal))
