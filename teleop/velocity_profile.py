"""The door to Ruckig: joint velocities that change within acceleration and jerk limits."""

from collections.abc import Sequence

from ruckig import ControlInterface, InputParameter, Ruckig, RuckigError, Synchronization, Trajectory

_ANY_PERIOD = 1.0 / 240.0
"""Ruckig wants a control period at construction; profiles are computed offline and read at any time."""


class VelocityProfile:
    """Time-optimal jerk-limited velocity changes of n joints. Keeps nothing between two calls."""

    def __init__(self, max_acceleration: Sequence[float], max_jerk: Sequence[float], *, together: bool = False) -> None:
        """Set the limits, n each [rad/s², rad/s³].

        Args:
            max_acceleration: Of each joint.
            max_jerk: Of each joint.
            together: Whether all reach their targets at once, in proportion where they can; else each on its own.
        """
        n = len(max_acceleration)
        self._otg = Ruckig(n, _ANY_PERIOD)
        self._input = InputParameter(n)
        self._input.control_interface = ControlInterface.Velocity
        self._together = together
        self._input.synchronization = Synchronization.Phase if together else Synchronization.No
        self._input.max_acceleration = list(max_acceleration)
        self._input.max_jerk = list(max_jerk)
        self._input.current_position = [0.0] * n
        self._rest = (0.0,) * n
        self._trajectory = Trajectory(n)
        self._max_acceleration = tuple(max_acceleration)
        self._asked: tuple[Sequence[float], ...] = ()

    def limit(self, max_acceleration: Sequence[float], max_jerk: Sequence[float]) -> None:
        """Set other limits, n each [rad/s², rad/s³]."""
        self._input.max_acceleration = list(max_acceleration)
        self._input.max_jerk = list(max_jerk)
        self._max_acceleration = tuple(max_acceleration)
        self._asked = ()

    def after(
        self, velocity: Sequence[float], acceleration: Sequence[float], target: Sequence[float], dt: float
    ) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Velocity and acceleration `dt` [s] later on the fastest way to the target velocity (then held), n each."""
        self._solve(velocity, acceleration, target)
        _, speeds, rates = self._trajectory.at_time(dt)
        return tuple(speeds), tuple(
            min(max(rate, -limit), limit) for rate, limit in zip(rates, self._max_acceleration, strict=True)
        )

    def travel_to_rest(self, velocity: Sequence[float], acceleration: Sequence[float]) -> list[tuple[float, float]]:
        """How far each joint moves back and ahead [rad] while it brakes: (lowest <= 0, highest >= 0), n pairs."""
        self._solve(velocity, acceleration, self._rest)
        return [(bound.min, bound.max) for bound in self._trajectory.position_extrema]

    def way_to_rest(
        self, velocity: Sequence[float], acceleration: Sequence[float], parts: Sequence[float]
    ) -> tuple[list[list[float]], float]:
        """Where each joint is after parts of the braking time, as it brakes, and the braking time.

        Args:
            velocity: n of them [rad/s].
            acceleration: n of them [rad/s²].
            parts: Parts of the braking time, 0..1, m of them.

        Returns:
            Way from here [rad], m rows of n; time until the last joint rests [s].
        """
        self._solve(velocity, acceleration, self._rest)
        duration = self._trajectory.duration
        return [self._trajectory.at_time(part * duration)[0] for part in parts], duration

    def _solve(self, velocity: Sequence[float], acceleration: Sequence[float], target: Sequence[float]) -> None:
        if self._asked and velocity is self._asked[0] and acceleration is self._asked[1] and target is self._asked[2]:
            return  # the way to rest is asked for twice a step
        # Only what cannot change is known again by being the same.
        self._asked = (velocity, acceleration, target) if type(velocity) is type(acceleration) is tuple else ()
        self._input.current_velocity = list(velocity)
        self._input.current_acceleration = list(acceleration)
        self._input.target_velocity = list(target)
        if not self._together:
            self._otg.calculate(self._input, self._trajectory)
            return
        try:
            self._otg.calculate(self._input, self._trajectory)
        except RuckigError:  # it finds no way that takes all equally long; each on its own there always is one
            self._input.synchronization = Synchronization.No
            try:
                self._otg.calculate(self._input, self._trajectory)
            finally:
                self._input.synchronization = Synchronization.Phase
