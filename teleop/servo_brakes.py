"""Limits of all joints and of the base together: how speeds change, and what braking takes."""

import math
from collections.abc import Sequence

import numpy as np

from robots import RobotModel
from robots.ik_kernel import compiled
from robots.pose import FloatArray

from .servo import POSITION_MARGIN
from .servo_guard import PARTS
from .velocity_profile import VelocityProfile

State = tuple[tuple[float, ...], tuple[float, ...]]
"""Speeds and accelerations."""
ROUNDING = 1e-9
"""Speeds and accelerations below this are rounding errors."""
BASE_NAMES = ("base speed", "base turning")


class ServoBrakes:
    """The limits of a robot's n joints, and of its base if it has one: d speeds in all.

    Attributes:
        names: Names of what moves, d of them.
        velocity: Limits of the speeds, (d,).
    """

    def __init__(self, robot: RobotModel) -> None:
        """Take the limits of a robot."""
        drive = robot.drive
        self.names = robot.joint_names + (BASE_NAMES if drive is not None else ())
        limits = [robot.velocity, robot.acceleration, robot.jerk]
        lower, upper = robot.lower + POSITION_MARGIN, robot.upper - POSITION_MARGIN
        if drive is not None:
            base = [
                (drive.speed, drive.yaw_rate),
                (drive.acceleration, drive.yaw_acceleration),
                (drive.jerk, drive.yaw_jerk),
            ]
            limits = [np.concatenate((joints, own)) for joints, own in zip(limits, base, strict=True)]
            lower, upper = np.append(lower, [-np.inf] * 2), np.append(upper, [np.inf] * 2)
        self.velocity, self._acceleration, self._jerk = limits
        self._lower, self._upper = lower, upper
        self._profile = VelocityProfile(self._acceleration.tolist(), self._jerk.tolist())
        groups = [robot.slice_of(arm) for arm in robot.arms]
        if drive is not None:
            groups.append(slice(len(robot.joint_names), len(self.names)))
        self._groups = [
            (each, VelocityProfile(self._acceleration[each].tolist(), self._jerk[each].tolist(), together=True))
            for each in groups
        ]
        self._limits = self.velocity.tolist(), self._acceleration.tolist(), self._jerk.tolist()
        self._gain = 0.4 * self._jerk / self._acceleration
        self._at_rest = ((0.0,) * len(self.names),) * 2

    def first(self, velocity: Sequence[float]) -> State:
        """The state for measured speeds; those above their limits are taken as at them."""
        held = np.clip(velocity, -self.velocity, self.velocity)
        return tuple(held.tolist()), (0.0,) * len(self.names)

    def half_times(self, wanted: FloatArray) -> FloatArray:
        """Distance to rest over speed, (d,) [s], for speeds (d,)."""
        return np.asarray(0.5 * (np.abs(wanted) / self._acceleration + self._acceleration / self._jerk))

    def room(self, q: FloatArray) -> tuple[FloatArray, FloatArray]:
        """How fast each joint may move down and up so near to its position limits, (d,) each, both >= 0.

        Towards a limit at distance r, speed is held to min(gain r, sqrt(acceleration r)): half of the acceleration
        limit at speed, and at the end a jerk of gain² v, which is well inside its limit.
        """
        return _room(q, self._lower, self._upper, self._gain, self._acceleration, self.velocity)

    def after(self, state: State, target: Sequence[float], dt: float) -> State:
        """The state after a control period on the fastest way to target speeds, each on its own."""
        return _settled(*self._profile.after(*state, target, dt))

    def together(self, state: State, target: Sequence[float], dt: float) -> State:
        """As `after`, at once where a target is that near, and else with the joints of an arm in proportion.

        A target that moves along is met exactly, as it would not be by changes that each end in steady speed.
        """
        rates = self._rates_along(state, target, dt)
        if rates is not None:
            return tuple(target), rates
        velocity: list[float] = []
        acceleration: list[float] = []
        for where, profile in self._groups:
            speeds, rates = profile.after(state[0][where], state[1][where], target[where], dt)
            velocity += speeds
            acceleration += rates
        return _settled(velocity, acceleration)

    def _rates_along(self, state: State, target: Sequence[float], dt: float) -> tuple[float, ...] | None:
        """Accelerations with which target speeds are met at once, if they may be."""
        rates = []
        for speed, before, rate_before, top, most, jerk in zip(target, *state, *self._limits, strict=True):
            rate = (speed - before) / dt
            # Half of the jerk limit, since the last period's mean acceleration lags half a period behind its end.
            near = abs(rate - rate_before) <= 0.45 * dt * jerk
            ends = abs(speed + rate * abs(rate) / (2.0 * jerk)) <= top
            if not (near and ends and abs(rate) <= most and abs(speed) <= top):
                return None
            rates.append(rate)
        return tuple(rates)

    def overrun(self, state: State, target: Sequence[float] | None, q: Sequence[float], dt: float) -> list[int]:
        """Joints that would pass a position limit if they went on to a state and braked from there.

        Args:
            state: The state after the control period.
            target: What they are on the way to as fast as they can: those that turn back do better than to brake. None
                takes all.
            q: Where they are now.
            dt: Control period [s].
        """
        if state == self._at_rest:
            return []
        found = []
        for i, (back, ahead) in enumerate(self._profile.travel_to_rest(*state)[: len(q)]):
            step = state[0][i] * dt
            at = q[i] + step
            up, down = (True, True) if target is None else (target[i] > 0.0, target[i] < 0.0)
            over = up and at + ahead > self._upper[i] and ahead + max(step, 0.0) > 0.0
            under = down and at + back < self._lower[i] and back + min(step, 0.0) < 0.0
            if over or under:
                found.append(i)
        return found

    def way(self, state: State, dt: float) -> FloatArray | None:
        """Where everything gets to if it goes on to a state and brakes from there, (m, d); None for rest.

        Each period, what is executed is the speed at its end. Summed up while braking, that is half a period's way
        less than the smooth ramp, so that half of the first period's way is left.
        """
        if state == self._at_rest:
            return None
        rows, _ = self._profile.way_to_rest(*state, PARTS)
        return np.asarray(np.array(rows) + np.array(state[0]) * (0.5 * dt))

    def is_rest(self, state: State) -> bool:
        """Whether nothing moves or is about to."""
        return state == self._at_rest

    @staticmethod
    def finite(values: Sequence[float]) -> bool:
        """Whether all values are numbers."""
        return all(map(math.isfinite, values))


def _settled(velocity: Sequence[float], acceleration: Sequence[float]) -> State:
    """A state in which what rests but for rounding errors is at rest."""
    if max(map(abs, velocity)) < ROUNDING and max(map(abs, acceleration)) < ROUNDING:
        return (0.0,) * len(velocity), (0.0,) * len(velocity)
    return tuple(velocity), tuple(acceleration)


@compiled
def _room(
    q: FloatArray,
    lower: FloatArray,
    upper: FloatArray,
    gain: FloatArray,
    acceleration: FloatArray,
    velocity: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """See `ServoBrakes.room`; what has no position keeps its speed limit."""
    down, up = velocity.copy(), velocity.copy()
    for i in range(q.size):
        for distance, allowed in ((q[i] - lower[i], down), (upper[i] - q[i], up)):
            distance = max(distance, 0.0)
            allowed[i] = min(gain[i] * distance, math.sqrt(acceleration[i] * distance))
    return down, up
