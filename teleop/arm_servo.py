"""One arm's wishes as joint velocities: smoothed, held to a reference pose, slowed early for what lies ahead."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots import ArmModel, RobotModel
from robots.ik_kernel import compiled
from robots.kinematics import Kinematics
from robots.pose import FloatArray

from .arm_lookahead import (
    BENDS,
    FREE,
    JERKING,
    POSITION,
    SINGULARITY,
    SLOW_ABOVE,
    STOP_AT,
    joint_velocities,
    look_ahead,
)
from .arm_reference import ReferencePose
from .drive_command import ArmWish
from .servo import POSITION_MARGIN
from .servo_reason import DriveReason
from .velocity_profile import VelocityProfile

__all__ = ["LENGTH", "SLOW_ABOVE", "STOP_AT", "ArmIntent", "ArmServo"]

LENGTH = 0.3
"""So many metres of the tool's motion weigh as much as a radian [m]."""
CLEAR_BELOW = 15.0
"""Once slowed, an arm counts as near a singular posture down to this condition number: no flicker in what is shown."""
NULL_WEIGHT = 2e-3
"""Weight of motion that does not move the tool, beside 1 for motion that does [m²/rad²]: the elbow gives way first."""
CHANGING = 0.5
"""Part of the joints' acceleration limits that changes of the twist use; braking ahead counts on less."""
MOST_ACCELERATION = 3.0
"""However quick the joints are, the tool is not jerked about [m/s² or rad/s²]."""
RISE = 6.0
"""Jerk over acceleration of the tool [1/s]."""
ENDED = 2e-3
"""A motion that was let go and is slower than this has ended [m/s or rad/s]."""
_MOVING = 1e-9


@dataclass(frozen=True, slots=True)
class ArmIntent:
    """What an arm would do if nothing were in the way.

    Attributes:
        asked: The tool's twist, (6,) [m/s, rad/s], along the axes of the base.
        velocity: Joint velocities, (n,) [rad/s].
        jacobian: Of the tool, (6, n), along the axes of the base.
        free: Which joints may move, (n,).
        reason: Why `velocity` does not give `asked`.
        detail: What is behind it.
    """

    asked: FloatArray
    velocity: FloatArray
    jacobian: FloatArray
    free: NDArray[np.bool_]
    reason: DriveReason
    detail: str = ""


class ArmServo:
    """Keeps an arm's smoothed twist and reference pose from step to step, in the frame of the base."""

    def __init__(self, robot: RobotModel, arm: ArmModel) -> None:
        """Start at rest; compiles or loads what is compiled."""
        self.arm = arm
        self._n = len(arm.joint_names)
        self._rows = 3 if self._n < 6 else 6
        self._kinematics = Kinematics(robot.urdf_path, arm.joint_names, arm.mimic, arm.tool_frame, robot.locked)
        self._weights = np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])[: self._rows]
        chain = self._kinematics.chain()
        limits = (arm.velocity, arm.acceleration, arm.jerk, arm.lower + POSITION_MARGIN, arm.upper - POSITION_MARGIN)
        mask = np.array([1] * self._rows + [0] * (7 - self._rows))
        self._model = chain.joints, chain.tool, mask, self._weights, np.array(limits)
        self._profile = VelocityProfile((1.0,) * 6, (1.0,) * 6, together=True)
        self._reference = ReferencePose()
        self._inverse = np.zeros((self._n, self._rows))
        self._all = np.ones(self._n, dtype=np.bool_)
        self.rest()
        self.intend(ArmWish((0.01,) * 6), 1.0, arm.home, None, 0.01)
        self.rest()

    def rest(self) -> None:
        """Forget twist and reference."""
        self._twist: FloatArray = np.zeros(6)
        self._rate: FloatArray = np.zeros(6)
        self._velocity: FloatArray = np.zeros(self._n)
        self._near_singular = False
        self._vectors = np.eye(self._rows)[[0, -1]]
        self._reference.forget()

    def follow(self, jacobian: FloatArray, velocity: FloatArray) -> None:
        """The arm was held back: go on from what it does, and let the reference come along."""
        self._twist = jacobian @ velocity
        if self._rows == 3:
            self._twist[3:] = 0.0
        self._reference.forget()

    def proceed(self, velocity: FloatArray, dt: float) -> None:
        """The step is taken with joint velocities (n,): move the reference on."""
        self._velocity = velocity
        self._reference.move_on(self._twist, dt)

    def inverse_weight(self, jacobian: FloatArray) -> FloatArray:
        """Of joints in avoiding things, (n, n): what does not move the tool is cheap."""
        rows = self._weights[:, None] * jacobian[: self._rows]
        return np.asarray(np.linalg.inv(rows.T @ rows + NULL_WEIGHT * np.eye(self._n)))

    def intend(self, wish: ArmWish, ratio: float, q: FloatArray, axes: FloatArray | None, dt: float) -> ArmIntent:
        """Turn a wish into joint velocities.

        Args:
            wish: What is wanted; checked before.
            ratio: 0..1, scales it.
            q: Positions of the arm's joints, (n,) [rad].
            axes: Rotation matrix of the wish's frame in the base frame, (3, 3); None for the tool's own.
            dt: Control period [s].
        """
        rotation, position, jacobian = self._kinematics.placement_and_jacobian(q)
        if wish.jog is not None:
            return self._jogged(wish.jog[0], wish.jog[1] * ratio, jacobian)
        axes = rotation if axes is None else axes
        asked = _along(np.ascontiguousarray(axes), np.array(wish.twist), ratio)
        if not any(wish.twist) and float(np.abs(self._twist).max()) < ENDED:
            self.rest()
            n = self._n
            return ArmIntent(asked, np.zeros(n), jacobian, ~self._all, DriveReason.NONE)
        wanted = asked.copy()
        reason, detail = DriveReason.NONE, ""
        if self._rows == 3:
            wanted[3:] = 0.0
            if any(wish.twist[3:]):
                reason, detail = DriveReason.UNREACHABLE, f"arm {self.arm.name} cannot turn its tool"
        part, limit, joint = self._look_ahead(wanted, q)
        if part < 1.0:
            wanted *= part
            if self._near_singular:
                reason, detail = DriveReason.SINGULARITY, f"arm {self.arm.name} is nearly stretched or folded"
            elif limit == POSITION:
                reason, detail = DriveReason.POSITION_LIMIT, self.arm.joint_names[joint]
            elif limit == BENDS:
                reason, detail = DriveReason.ACCELERATION_LIMIT, self.arm.joint_names[joint]
            else:
                reason, detail = DriveReason.VELOCITY_LIMIT, self.arm.joint_names[joint]
        self._twist = self._smoothed(wanted, dt)
        twist = self._twist + self._reference.correction(position, rotation, self._twist)
        # In the middle of the way that the period leads over, so that nothing is left by its bending.
        velocity = joint_velocities(*self._model, q + (0.5 * dt) * self._velocity, twist[: self._rows])
        return ArmIntent(asked, velocity, jacobian, self._all, reason, detail)

    def _jogged(self, joint: int, speed: float, jacobian: FloatArray) -> ArmIntent:
        velocity = np.zeros(self._n)
        velocity[joint] = speed
        self.rest()
        free = np.zeros(self._n, bool)
        free[joint] = True
        return ArmIntent(jacobian @ velocity, velocity, jacobian, free, DriveReason.NONE)

    def _look_ahead(self, wanted: FloatArray, q: FloatArray) -> tuple[float, int, int]:
        """How much of a wanted twist (6,) may be executed, what limits it, and the joint."""
        size = float(wanted @ wanted)
        ends = size == 0.0
        way = self._twist if ends else wanted
        size = float(way @ way)
        if size < _MOVING * _MOVING:
            return 1.0, FREE, -1
        now, growing = float(self._twist @ way) / size, float(np.dot(self._rate, way)) / size
        most = MOST_ACCELERATION / size**0.5
        part, limit, joint, condition = look_ahead(
            *self._model, q, way[: self._rows], max(now, 0.0), growing, most, most * RISE, self._vectors, self._inverse
        )
        if part < 1.0 and limit == SINGULARITY:
            self._near_singular = True
        elif condition < CLEAR_BELOW or part >= 1.0:
            self._near_singular = False
        return (1.0, FREE, -1) if ends else (part, limit, joint)

    def _smoothed(self, wanted: FloatArray, dt: float) -> FloatArray:
        """The ideal twist (6,) a period later, on a straight line to the wanted one that the joints can follow."""
        limits, jerks, rate = _changes(
            wanted,
            self._twist,
            self._rate,
            self._velocity,
            self._inverse,
            self._weights,
            self.arm.acceleration,
            self.arm.jerk,
        )
        if not limits[0]:
            self._rate = np.zeros(6)
            return wanted
        self._profile.limit(limits.tolist(), jerks.tolist())
        twist, rates = self._profile.after(self._twist.tolist(), rate.tolist(), wanted.tolist(), dt)
        self._rate = np.array(rates)
        return np.array(twist)


@compiled
def _along(axes: FloatArray, twist: FloatArray, ratio: float) -> FloatArray:
    """A twist (6,), scaled, from a frame whose axes are the columns of a matrix (3, 3)."""
    found = np.zeros(6)
    for i in range(3):
        for k in range(3):
            found[i] += ratio * axes[i, k] * twist[k]
            found[3 + i] += ratio * axes[i, k] * twist[3 + k]
    return found


@compiled
def _changes(
    wanted: FloatArray,
    twist: FloatArray,
    rate: FloatArray,
    velocity: FloatArray,
    inverse: FloatArray,
    weights: FloatArray,
    acceleration: FloatArray,
    jerk: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Limits of how a twist (6,) changes to a wanted one so that joints can follow, and its rate inside them.

    Args:
        wanted: Twist, (6,).
        twist: The ideal one now, (6,).
        rate: Its rate, (6,).
        velocity: Of the n joints [rad/s].
        inverse: Of the weighted Jacobian, (n, m).
        weights: Of its rows, (m,).
        acceleration: Limits, (n,) [rad/s²].
        jerk: Limits, (n,) [rad/s³].

    Returns:
        Limits of acceleration and jerk of each part, (6,) each, zeros where there is no change; the rate, (6,).
    """
    limits, jerks, held = np.zeros(6), np.zeros(6), np.zeros(6)
    size = speed = turning = along = 0.0
    for i in range(6):
        size += (wanted[i] - twist[i]) ** 2
        speed += twist[i] ** 2
        turning += rate[i] ** 2
        along += (wanted[i] - twist[i]) * twist[i]
    size, speed, turning = math.sqrt(size), math.sqrt(speed), max(math.sqrt(turning), _MOVING)
    if size < _MOVING:
        return limits, jerks, held
    way = (wanted - twist) / size
    most, roughest = MOST_ACCELERATION, RISE * MOST_ACCELERATION
    for k in range(velocity.size):
        joint = 0.0
        for i in range(weights.size):
            joint += inverse[k, i] * weights[i] * way[i]
        joint = max(abs(joint), _MOVING)
        if speed > ENDED:
            # Joints that give way to others move, and have to brake, faster than the tool alone would have them.
            joint = max(joint, abs(velocity[k]) * abs(along / size) / (speed * speed))
        most = min(most, CHANGING * acceleration[k] / joint)
        roughest = min(roughest, JERKING * jerk[k] / joint)
    for i in range(6):
        # Axes that do not change now may still have to end a change.
        part = max(abs(way[i]), abs(rate[i]) / turning, 0.02)
        limits[i], jerks[i] = most * part, roughest * part
        held[i] = min(max(rate[i], -limits[i]), limits[i])
    return limits, jerks, held
