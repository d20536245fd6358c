"""Time-optimal motion from one state to a posture at rest (Ruckig): the door to Ruckig in this package.

Ruckig is only asked for motions between two states; intermediate waypoints would be sent to a cloud service.
"""

from dataclasses import dataclass

import numpy as np
from ruckig import InputParameter, Result, Ruckig, RuckigError, Synchronization
from ruckig import Trajectory as RuckigTrajectory

from robots.pose import FloatArray

from .errors import MotionError, listed
from .limits import JointLimits
from .piecewise import PiecewisePolynomial
from .trajectory import Samples, sample_times


@dataclass(frozen=True, slots=True)
class JointTrajectory:
    """Joint positions as piecewise polynomials of time.

    Attributes:
        curve: q(t), breaks in [s] from 0.
    """

    curve: PiecewisePolynomial

    @property
    def duration(self) -> float:
        """Time it takes [s]."""
        return self.curve.length

    def at(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position, velocity, acceleration at `time` [s], each (n,)."""
        position, velocity, acceleration, _ = self.curve.derivatives(np.array([time]))[:, 0]
        return position, velocity, acceleration

    def sample(self, period: float) -> Samples:
        """States at every `period` [s] and at the end."""
        times = sample_times(self.duration, period)
        return Samples(times, *self.curve.derivatives(times)[:3])


def move_joints(
    start: FloatArray,
    end: FloatArray,
    limits: JointLimits,
    start_velocity: FloatArray | None = None,
    start_acceleration: FloatArray | None = None,
) -> JointTrajectory:
    """Plan the fastest motion whose joints all arrive at `end` together, at rest.

    It is a straight line in joint space only where one course of speed is the fastest for all joints; for a line use
    `follow_waypoints`. If moving together would carry a joint that starts in motion over its position limit, each
    joint moves as fast as it can instead.

    Args:
        start: Posture, (n,) [rad].
        end: Posture, (n,) [rad].
        limits: Of the joints.
        start_velocity: (n,) [rad/s]; zero if not given.
        start_acceleration: (n,) [rad/s^2]; zero if not given.

    Raises:
        MotionError: A posture is not finite or out of limits, or the start moves so fast that a limit cannot be kept.
    """
    start, end = limits.check_inside("start", start), limits.check_inside("end", end)
    velocity = _rate("start velocity", start_velocity, limits.velocity)
    acceleration = _rate("start acceleration", start_acceleration, limits.acceleration)
    # Jerk needs a / j to end an acceleration, which adds a^2 / 2 j to the speed.
    peak = np.abs(velocity + np.sign(acceleration) * acceleration**2 / (2 * limits.jerk))
    if np.any(peak > limits.velocity * (1 + 1e-9)):
        joint = int(np.argmax(peak / limits.velocity))
        raise MotionError(
            f"joint {joint} starts so that it reaches {peak[joint]:.6g} rad/s, allowed {limits.velocity[joint]:.6g}"
        )
    asked = InputParameter(limits.count)
    asked.current_position, asked.target_position = start.tolist(), end.tolist()
    asked.current_velocity, asked.current_acceleration = velocity.tolist(), acceleration.tolist()
    asked.max_velocity, asked.max_acceleration = limits.velocity.tolist(), limits.acceleration.tolist()
    asked.max_jerk = limits.jerk.tolist()
    least, most = start, end
    for asked.synchronization in (Synchronization.Phase, Synchronization.No):
        curve = _curve(_calculate(asked), end)
        least, most = _extremes(curve)
        if np.all(least >= limits.lower - 1e-9) and np.all(most <= limits.upper + 1e-9):
            return JointTrajectory(curve)
    joint = int(np.argmax(np.maximum(limits.lower - least, most - limits.upper)))
    raise MotionError(
        f"joint {joint} starts at {start[joint]:.6g} rad with {velocity[joint]:.6g} rad/s and would swing to "
        f"{least[joint]:.6g} to {most[joint]:.6g}, allowed {limits.lower[joint]:.6g} to {limits.upper[joint]:.6g}; "
        "start slower"
    )


def _rate(name: str, values: FloatArray | None, bound: FloatArray) -> FloatArray:
    rate = np.zeros(bound.size) if values is None else np.asarray(values, dtype=np.float64)
    if rate.shape != bound.shape or not np.all(np.abs(rate) <= bound * (1 + 1e-9)):  # NaN compares false
        raise MotionError(f"{name} {listed(rate)} must be {bound.size} values within {listed(bound)}")
    return rate


def _calculate(asked: InputParameter) -> RuckigTrajectory:
    found = RuckigTrajectory(asked.degrees_of_freedom)
    problem = "no solution"
    try:
        outcome = Ruckig(asked.degrees_of_freedom).calculate(asked, found)
        if outcome in (Result.Working, Result.Finished):
            return found
        problem = str(outcome)
    except RuckigError as error:
        problem = " ".join(str(error).split())
    raise MotionError(f"no motion from {listed(asked.current_position)} to {listed(asked.target_position)}: {problem}")


def _extremes(curve: PiecewisePolynomial) -> tuple[FloatArray, FloatArray]:
    """Least and greatest positions, (n,): Ruckig's own leave out turning points between its phases."""
    _, first, second, third = curve.coefficients.transpose(1, 0, 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(second**2 - 3 * first * third)
        # Roots of first + 2 second x + 3 third x^2 in the form that stays finite when third is zero.
        pivot = -(second + np.copysign(root, second))
        turning = np.stack([first / pivot, pivot / (3 * third)])
    ends = np.diff(curve.breaks)[:, None]
    turning = np.where((turning > 0) & (turning < ends), turning, 0.0)  # NaN compares false
    begin = curve.coefficients[:, 0]
    positions = begin + turning * (first + turning * (second + turning * third))
    last = curve.derivatives(curve.breaks[-1:])[0]
    return (
        np.minimum(positions.min(axis=(0, 1)), last[0]),
        np.maximum(positions.max(axis=(0, 1)), last[0]),
    )


def _curve(found: RuckigTrajectory, end: FloatArray) -> PiecewisePolynomial:
    """Cubic pieces between all times at which the jerk of any joint changes."""
    times = [0.0, found.duration]
    for profile in found.profiles[0]:
        times.extend(np.cumsum([*profile.brake.t, *profile.t]))
    breaks = np.unique(np.clip(times, 0.0, found.duration))
    # Rounding leaves pieces of no length, over which the change of acceleration says nothing.
    breaks = breaks[np.append(np.diff(breaks) > 1e-9, True)]
    breaks[0] = 0.0
    if breaks.size == 1:
        return PiecewisePolynomial(np.zeros(2), np.stack([end, *np.zeros((3, end.size))])[None])
    states = np.array([found.at_time(time) for time in breaks])
    jerk = np.diff(states[:, 2], axis=0) / np.diff(breaks)[:, None]
    pieces = np.stack([states[:-1, 0], states[:-1, 1], states[:-1, 2] / 2, jerk / 6], axis=1)
    return PiecewisePolynomial(breaks, pieces)
