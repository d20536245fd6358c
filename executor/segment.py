"""One straight Cartesian segment from rest to rest, within velocity, acceleration and jerk limits (Ruckig)."""

from dataclasses import dataclass

import numpy as np
from ruckig import InputParameter, Result, Ruckig, RuckigError, Trajectory

from executor.errors import ExecutorError
from robots.pose import FloatArray


@dataclass(frozen=True, slots=True)
class ToolLimits:
    """Limits of the tool along its path.

    Attributes:
        velocity: Speed [m/s].
        acceleration: Acceleration along the path [m/s^2].
        jerk: Jerk along the path [m/s^3].
    """

    velocity: float
    acceleration: float
    jerk: float

    def scaled(self, slower: float) -> "ToolLimits":
        """Limits of the same motion played `slower` times as slowly."""
        return ToolLimits(self.velocity / slower, self.acceleration / slower**2, self.jerk / slower**3)


class Segment:
    """The time-optimal motion along the line from `start` to `end`, both at rest.

    Attributes:
        start: First point, (3,) [m].
        end: Last point, (3,) [m].
        duration: Time it takes [s].
    """

    def __init__(self, start: FloatArray, end: FloatArray, limits: ToolLimits) -> None:
        """Plan the segment.

        Raises:
            ExecutorError: Ruckig found no trajectory (a coordinate is not a number, or a limit not positive).
        """
        self.start = np.asarray(start, dtype=np.float64)
        self.end = np.asarray(end, dtype=np.float64)
        length = float(np.linalg.norm(self.end - self.start))
        self._along = (self.end - self.start) / max(length, 1e-12)
        asked = InputParameter(1)
        asked.current_position, asked.target_position = [0.0], [length]
        asked.max_velocity, asked.max_acceleration = [limits.velocity], [limits.acceleration]
        asked.max_jerk = [limits.jerk]
        self._path = Trajectory(1)
        try:
            outcome = Ruckig(1).calculate(asked, self._path)
        except RuckigError as error:
            raise ExecutorError(
                f"no motion from {self.start} to {self.end} m: {' '.join(str(error).split())}"
            ) from error
        if outcome not in (Result.Working, Result.Finished):
            raise ExecutorError(f"no motion from {self.start} to {self.end} m: {outcome}")
        self.duration = float(self._path.duration)

    def at(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position [m], velocity [m/s] and acceleration [m/s^2] of the tool at `time` [s], each (3,)."""
        position, velocity, acceleration = self._path.at_time(min(max(time, 0.0), self.duration))
        return (
            self.start + position[0] * self._along,
            velocity[0] * self._along,
            acceleration[0] * self._along,
        )
