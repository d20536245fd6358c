"""Limits of a tool along a straight line."""

from dataclasses import asdict, dataclass

from .errors import check_positive


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
        check_positive("tool", asdict(self))
