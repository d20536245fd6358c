"""Limits of a tool along a straight line."""

import math
from dataclasses import dataclass, fields

from .errors import MotionError


@dataclass(frozen=True, slots=True)
class ToolLimits:
    """How fast a tool may go.

    Attributes:
        velocity: Speed [m/s].
        acceleration: Acceleration along the line [m/s^2].
        jerk: Jerk along the line [m/s^3].
        angular_velocity: Rate of turning [rad/s].
        angular_acceleration: [rad/s^2].
        angular_jerk: [rad/s^3].
    """

    velocity: float = 0.25
    acceleration: float = 1.0
    jerk: float = 10.0
    angular_velocity: float = 1.0
    angular_acceleration: float = 4.0
    angular_jerk: float = 40.0

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises:
            MotionError: A limit is not positive and finite.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            if not value > 0 or not math.isfinite(value):
                raise MotionError(f"tool limit {field.name} must be positive and finite; got {value}")
