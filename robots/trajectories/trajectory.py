"""What a trajectory is, and how far it goes into its limits."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from robots.pose import FloatArray, read_only

from .errors import MotionError
from .limits import JointLimits


class Trajectory(Protocol):
    """Motion of n joints over time."""

    @property
    def duration(self) -> float:
        """Time it takes [s]."""
        ...

    def at(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Position [rad], velocity [rad/s], acceleration [rad/s^2], each (n,); `time` [s] is clipped to the motion."""
        ...

    def sample(self, period: float) -> "Samples":
        """States at every `period` [s] and at the end."""
        ...


@dataclass(frozen=True, slots=True)
class Samples:
    """A trajectory, sampled.

    Attributes:
        time: Since the start, (k,) [s].
        position: (k, n) [rad].
        velocity: (k, n) [rad/s].
        acceleration: (k, n) [rad/s^2].
    """

    time: FloatArray
    position: FloatArray
    velocity: FloatArray
    acceleration: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("time", "position", "velocity", "acceleration"):
            object.__setattr__(self, name, read_only(getattr(self, name)))


def sample_times(duration: float, period: float) -> FloatArray:
    """Every `period` from 0, and the end itself, (k,) [s].

    Raises:
        MotionError: The period is not positive.
    """
    if not period > 0 or not math.isfinite(period):
        raise MotionError(f"the sampling period must be positive; got {period} s")
    times = np.arange(math.floor(duration / period + 1e-9) + 1) * period
    return np.asarray(times if duration - times[-1] < 1e-9 else np.append(times, duration), dtype=np.float64)


@dataclass(frozen=True, slots=True)
class LimitReport:
    """How much of each limit a sampled trajectory uses: 1 is exactly at the limit of some joint.

    Attributes:
        position: How far the worst joint is from the middle of its range, over half the range; 0 if all are continuous.
        velocity: Largest speed over its limit.
        acceleration: Largest acceleration over its limit.
        jerk: Largest change of acceleration between samples over what the limit allows in that time.
    """

    position: float
    velocity: float
    acceleration: float
    jerk: float

    @property
    def worst(self) -> float:
        """The largest of the ratios."""
        return max(self.position, self.velocity, self.acceleration, self.jerk)


def check_limits(trajectory: Trajectory, limits: JointLimits, period: float = 0.001) -> LimitReport:
    """Sample a trajectory and compare with the limits.

    Jerk is measured by differences of the sampled acceleration, from and to rest included: a jump of acceleration, at
    either end too if the trajectory begins or ends at rest, shows as a large ratio.
    """
    samples = trajectory.sample(period)
    bounded = np.isfinite(limits.lower) & np.isfinite(limits.upper)
    lower, upper = limits.lower[bounded], limits.upper[bounded]
    steps = np.diff(samples.time)
    # The last step can be a tiny remainder, over which rounding would be all that is measured.
    long = steps > 0.01 * period
    jerk = np.diff(samples.acceleration, axis=0)[long] / steps[long, None]
    return LimitReport(
        position=_largest(samples.position[:, bounded] - (lower + upper) / 2, (upper - lower) / 2),
        velocity=_largest(samples.velocity, limits.velocity),
        acceleration=_largest(samples.acceleration, limits.acceleration),
        jerk=_largest(jerk, limits.jerk),
    )


def _largest(values: FloatArray, bounds: FloatArray) -> float:
    return float(np.max(np.abs(values) / bounds, initial=0.0))
