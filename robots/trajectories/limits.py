"""Limits of joints: position, velocity, acceleration and jerk."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from robots.pose import FloatArray, read_only

from .errors import MotionError, listed


@dataclass(frozen=True, slots=True)
class JointLimits:
    """Limits of n joints, which may be of several arms; units are rad (or m) and seconds.

    Attributes:
        lower: Least position, (n,); minus infinity for a continuous joint.
        upper: Greatest position, (n,); infinity for a continuous joint.
        velocity: Greatest speed, (n,) [rad/s].
        acceleration: Greatest acceleration, (n,) [rad/s^2].
        jerk: Greatest jerk, (n,) [rad/s^3].
    """

    lower: FloatArray
    upper: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    jerk: FloatArray

    def __post_init__(self) -> None:
        """Freeze and check the arrays.

        Raises:
            MotionError: Sizes differ, a range is empty, or a limit is not positive and finite.
        """
        for field in fields(self):
            object.__setattr__(self, field.name, read_only(getattr(self, field.name)))
        shape = self.lower.shape
        if len(shape) != 1 or not shape[0] or any(getattr(self, field.name).shape != shape for field in fields(self)):
            shapes = ", ".join(f"{field.name} {getattr(self, field.name).shape}" for field in fields(self))
            raise MotionError(f"joint limits must be arrays of one length; got {shapes}")
        if not np.all(self.lower < self.upper):
            raise MotionError(f"lower limits {listed(self.lower)} must be below the upper ones {listed(self.upper)}")
        for name in ("velocity", "acceleration", "jerk"):
            values = getattr(self, name)
            if not np.all((values > 0) & np.isfinite(values)):
                raise MotionError(f"{name} limits must be positive and finite; got {listed(values)}")

    @property
    def count(self) -> int:
        """Number of joints."""
        return int(self.lower.size)

    def scaled(self, slower: float) -> "JointLimits":
        """Limits of the same motion played `slower` times as slowly."""
        return JointLimits(
            self.lower, self.upper, self.velocity / slower, self.acceleration / slower**2, self.jerk / slower**3
        )

    @staticmethod
    def stacked(parts: Sequence["JointLimits"]) -> "JointLimits":
        """Limits of several arms as of one with all their joints, in the order given."""
        return JointLimits(
            *(np.concatenate([getattr(part, field.name) for part in parts]) for field in fields(JointLimits))
        )

    def check_inside(self, name: str, q: FloatArray) -> FloatArray:
        """Return `q` as float64 (n,) if it has n finite values within the position limits.

        Raises:
            MotionError: It has not; names the joint.
        """
        q = np.asarray(q, dtype=np.float64)
        if problem := self.problem(q):
            raise MotionError(f"{name} {problem}")
        return q

    def problem(self, q: FloatArray) -> str:
        """What is wrong with the posture `q`, (n,), or nothing. Rounding errors of 1e-9 are let pass."""
        if q.shape != self.lower.shape:
            return f"has shape {q.shape}; these limits are for {self.count} joints"
        if not np.all(np.isfinite(q)):
            return f"{listed(q)} is not finite"
        outside = (q < self.lower - 1e-9) | (q > self.upper + 1e-9)
        if outside.any():
            joint = int(np.argmax(outside))
            return f"is out of limits: joint {joint} at {q[joint]:.6g}, allowed {self.lower[joint]:.6g} to " + (
                f"{self.upper[joint]:.6g}"
            )
        return ""

    def nearest_turn(self, q: FloatArray, near: FloatArray) -> FloatArray:
        """`q` with each continuous joint turned by whole turns to within pi of `near`, (n,) [rad]."""
        continuous = np.isinf(self.lower) & np.isinf(self.upper)
        turns = np.where(continuous, np.round((near - q) / (2 * np.pi)), 0.0)
        return np.asarray(q + 2 * np.pi * turns)
