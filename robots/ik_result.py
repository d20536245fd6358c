"""What inverse kinematics answers."""

from dataclasses import dataclass

from .pose import FloatArray, read_only


@dataclass(frozen=True, slots=True)
class IkResult:
    """Outcome of inverse kinematics.

    Attributes:
        success: Whether both errors are within the tolerances asked for.
        q: The posture found, else the nearest, (n,) [rad or m], always inside the joint limits.
        error: Distance of its tool position from the one asked for, along the axes that the task controls [m].
        iterations: Steps taken over all starts.
        orientation_error: Angle of its tool orientation from the one asked for, about the axes that the task controls
            [rad]; zero where it controls none.
        restarts: Starts that were tried after the first one.
        reason: Why there is no success, in plain words; empty after success.
    """

    success: bool
    q: FloatArray
    error: float
    iterations: int
    orientation_error: float = 0.0
    restarts: int = 0
    reason: str = ""

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "q", read_only(self.q))

    @property
    def position_error(self) -> float:
        """The same as `error` [m]."""
        return self.error
