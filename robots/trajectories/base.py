"""Motion of a wheeled base: turns on the spot and straight drives, which two wheels can do without slipping."""

import math
from dataclasses import asdict, dataclass, fields

import numpy as np

from robots.pose import FloatArray, read_only

from .errors import check_positive
from .joints import JointTrajectory
from .limits import JointLimits
from .trajectory import sample_times


@dataclass(frozen=True, slots=True)
class BaseLimits:
    """Limits of the base; the defaults are the Segway's, with jerks that reach full acceleration in 0.1 s.

    Attributes:
        speed: [m/s].
        acceleration: [m/s^2].
        jerk: [m/s^3].
        yaw_rate: [rad/s].
        yaw_acceleration: [rad/s^2].
        yaw_jerk: [rad/s^3].
    """

    speed: float = 0.5
    acceleration: float = 0.5
    jerk: float = 5.0
    yaw_rate: float = 1.0
    yaw_acceleration: float = 1.5
    yaw_jerk: float = 15.0

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises:
            MotionError: A limit is not positive and finite.
        """
        check_positive("base", asdict(self))

    @property
    def drive(self) -> JointLimits:
        """Of the way along the heading."""
        return _free(self.speed, self.acceleration, self.jerk)

    @property
    def turn(self) -> JointLimits:
        """Of the yaw."""
        return _free(self.yaw_rate, self.yaw_acceleration, self.yaw_jerk)


def _free(velocity: float, acceleration: float, jerk: float) -> JointLimits:
    bound = np.array([np.inf])
    return JointLimits(-bound, bound, np.array([velocity]), np.array([acceleration]), np.array([jerk]))


@dataclass(frozen=True, slots=True)
class BasePhase:
    """One turn on the spot or one straight drive.

    Attributes:
        pose: At its begin, (3,) [m, m, rad].
        drives: Whether it is a drive along the heading; else a turn.
        motion: Of the way along the heading [m] or of the yaw's change [rad], from 0.
    """

    pose: FloatArray
    drives: bool
    motion: JointTrajectory

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "pose", read_only(self.pose))

    def states(self, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Poses (k, 3), twists (v, w) (k, 2) and their changes (k, 2) at times since its begin, (k,) [s]."""
        moved, rate, change, _ = self.motion.curve.derivatives(times)
        drives = np.array([1.0, 0.0] if self.drives else [0.0, 1.0])
        return self._moved(moved), rate * drives, change * drives

    def along(self, step: float, turn: float) -> FloatArray:
        """Poses from its begin to its end, no further from each other than `step` [m] or `turn` [rad], (k, 3)."""
        whole = float(self.motion.at(self.motion.duration)[0][0])
        count = math.ceil(abs(whole) / (step if self.drives else turn)) + 1
        return self._moved(np.linspace(0.0, whole, count)[:, None])

    def _moved(self, moved: FloatArray) -> FloatArray:
        """Poses after driving or turning by `moved`, (k, 1)."""
        yaw = float(self.pose[2])
        way = [math.cos(yaw), math.sin(yaw), 0.0] if self.drives else [0.0, 0.0, 1.0]
        return np.asarray(self.pose + moved * np.array(way))


@dataclass(frozen=True, slots=True)
class BaseSamples:
    """A trajectory of the base, sampled.

    Attributes:
        time: Since the start, (k,) [s].
        pose: x, y, yaw in the world, yaw without jumps, (k, 3) [m, m, rad].
        twist: Speed along the heading and yaw rate, (k, 2) [m/s, rad/s].
        acceleration: Their changes, (k, 2) [m/s^2, rad/s^2].
    """

    time: FloatArray
    pose: FloatArray
    twist: FloatArray
    acceleration: FloatArray

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for field in fields(self):
            object.__setattr__(self, field.name, read_only(getattr(self, field.name)))


@dataclass(frozen=True, slots=True)
class BaseTrajectory:
    """Turns and drives one after the other, at rest between them.

    Attributes:
        phases: In order.
        goal: Where it ends; yaw may differ by whole turns from what was asked for, (3,) [m, m, rad].
    """

    phases: tuple[BasePhase, ...]
    goal: FloatArray

    def __post_init__(self) -> None:
        """Freeze the array."""
        object.__setattr__(self, "goal", read_only(self.goal))

    @property
    def duration(self) -> float:
        """Time it takes [s]."""
        return float(np.sum([phase.motion.duration for phase in self.phases]))

    def at(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Pose (x, y, yaw), twist (v, w) and its change at `time` [s]: (3,), (2,), (2,)."""
        pose, twist, change = self._states(np.array([max(time, 0.0)]))
        return pose[0], twist[0], change[0]

    def sample(self, period: float) -> BaseSamples:
        """States at every `period` [s] and at the end."""
        times = sample_times(self.duration, period)
        return BaseSamples(times, *self._states(times))

    def _states(self, times: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Poses (k, 3), twists (k, 2) and their changes (k, 2) at increasing times, (k,)."""
        ends = np.cumsum([phase.motion.duration for phase in self.phases])
        # Exactly the goal from the end on, whatever rounding does to the sum of the phases' times.
        which = np.where(times >= self.duration, len(self.phases), np.searchsorted(ends, times, side="right"))
        poses, twists, changes = (
            np.tile(self.goal, (times.size, 1)),
            np.zeros((times.size, 2)),
            np.zeros((times.size, 2)),
        )
        for index, phase in enumerate(self.phases):
            here = which == index
            if here.any():
                since = times[here] - (ends[index] - phase.motion.duration)
                poses[here], twists[here], changes[here] = phase.states(since)
        return poses, twists, changes
