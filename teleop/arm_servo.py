"""One arm's wishes as joint velocities: smoothed, held to a reference pose, slowed near singular postures."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots import ArmModel, RobotModel
from robots.kinematics import Kinematics
from robots.pose import FloatArray

from .drive_command import ArmWish
from .servo_reason import DriveReason
from .velocity_profile import VelocityProfile

LENGTH = 0.3
"""So many metres of the tool's motion weigh as much as a radian [m]."""
SLOW_ABOVE, STOP_AT = 17.0, 30.0
"""Condition numbers between which motion towards singular postures slows down, as in MoveIt Servo."""
CLEAR_BELOW = 15.0
"""Once slowed, an arm counts as near a singular posture down to this condition number: no flicker in what is shown."""
WORSENS = 0.5
"""Condition numbers a second from which motion counts as leading in; below, the slow-down sets in smoothly [1/s]."""
GAIN = 5.0
"""How fast the tool comes back to its reference [1/s]."""
LEASH = (0.003, 0.02)
"""The reference is never farther ahead than this [m, rad]."""
NULL_WEIGHT = 2e-3
"""Weight of motion that does not move the tool, beside 1 for motion that does [m²/rad²]: the elbow gives way first."""
FASTEST = 0.98
"""Part of the joints' speed limits that wishes may use; the rest is for coming back to the reference."""
SHARE = 0.8
"""Part of the joints' acceleration limits that changes of the twist use."""
MOST_ACCELERATION = 3.0
"""However quick the joints are, the tool is not jerked about [m/s² or rad/s²]."""
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
        inverse_weight: Of joints in avoiding things, (n, n).
        free: Which joints may move, (n,).
        reason: Why `velocity` does not give `asked`.
        detail: What is behind it.
    """

    asked: FloatArray
    velocity: FloatArray
    jacobian: FloatArray
    inverse_weight: FloatArray
    free: NDArray[np.bool_]
    reason: DriveReason
    detail: str = ""


class ArmServo:
    """Keeps an arm's smoothed twist and reference pose from step to step, in the frame of the base."""

    def __init__(self, robot: RobotModel, arm: ArmModel) -> None:
        """Start at rest."""
        self.arm = arm
        self._n = len(arm.joint_names)
        self._rows = 3 if self._n < 6 else 6
        self._kinematics = Kinematics(robot.urdf_path, arm.joint_names, arm.mimic, arm.tool_frame, robot.locked)
        self._weights = np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])[: self._rows]
        self._near_singular = False
        self._profile = VelocityProfile((1.0,) * 6, (1.0,) * 6, together=True)
        self.rest()

    def rest(self) -> None:
        """Forget twist and reference."""
        self._twist: FloatArray = np.zeros(6)
        self._reference: tuple[FloatArray, FloatArray] | None = None
        self._ideal: tuple[FloatArray, FloatArray] | None = None
        self._rate: tuple[float, ...] = (0.0,) * 6

    def follow(self, jacobian: FloatArray, velocity: FloatArray) -> None:
        """The arm was held back: go on from what it does, and let the reference come along."""
        self._twist = jacobian @ velocity
        if self._rows == 3:
            self._twist[3:] = 0.0
        self._reference = None

    def proceed(self, dt: float) -> None:
        """The step was taken as intended: move the reference on."""
        if self._ideal is not None:
            position, rotation = self._ideal
            self._reference = position + self._twist[:3] * dt, _turned_by(self._twist[3:] * dt) @ rotation

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
        twist = ratio * np.array(wish.twist)
        asked = np.concatenate((axes @ twist[:3], axes @ twist[3:]))
        if not any(wish.twist) and float(np.abs(self._twist).max()) < ENDED:
            self.rest()
            return self._still(asked, jacobian)
        inverse, damped, factor = self._inverse(asked, q, jacobian)
        reason, detail = DriveReason.NONE, ""
        if damped or factor < 1.0:
            reason, detail = DriveReason.SINGULARITY, f"arm {self.arm.name} is nearly stretched or folded"
        wanted = factor * asked
        if self._rows == 3:
            wanted[3:] = 0.0
            if asked[3:].any() and reason is DriveReason.NONE:
                reason, detail = DriveReason.UNREACHABLE, f"arm {self.arm.name} cannot turn its tool"
        over = np.abs(inverse @ (self._weights * wanted[: self._rows])) / (FASTEST * self.arm.velocity)
        if (ratio := float(over.max())) > 1.0:
            wanted = wanted / ratio
            if reason is not DriveReason.SINGULARITY:
                reason, detail = DriveReason.VELOCITY_LIMIT, self.arm.joint_names[int(np.argmax(over))]
        self._twist = self._smoothed(wanted, inverse, dt)
        corrected = self._twist + self._correction(rotation, position)
        velocity = inverse @ (self._weights * corrected[: self._rows])
        rows = self._weights[:, None] * jacobian[: self._rows]
        inverse_weight = np.asarray(np.linalg.inv(rows.T @ rows + NULL_WEIGHT * np.eye(self._n)))
        return ArmIntent(asked, velocity, jacobian, inverse_weight, np.ones(self._n, bool), reason, detail)

    def _jogged(self, joint: int, speed: float, jacobian: FloatArray) -> ArmIntent:
        velocity = np.zeros(self._n)
        velocity[joint] = speed
        self.rest()
        free = np.zeros(self._n, bool)
        free[joint] = True
        return ArmIntent(jacobian @ velocity, velocity, jacobian, np.eye(self._n), free, DriveReason.NONE)

    def _still(self, asked: FloatArray, jacobian: FloatArray) -> ArmIntent:
        n = self._n
        return ArmIntent(asked, np.zeros(n), jacobian, np.eye(n), np.zeros(n, bool), DriveReason.NONE)

    def _inverse(self, asked: FloatArray, q: FloatArray, jacobian: FloatArray) -> tuple[FloatArray, bool, float]:
        """Inverse of the weighted Jacobian (n, rows), whether it is damped, and how much of the twist is good."""
        left, values, right = np.linalg.svd(self._weights[:, None] * jacobian[: self._rows], full_matrices=False)
        largest, smallest = float(values[0]), float(values[-1])
        damped = smallest * STOP_AT < largest
        # Damping begins at the condition number where motion towards it ends (Nakamura and Hanafusa 1986).
        damping = (largest / STOP_AT) ** 2 - smallest**2 if damped else 0.0
        inverse = (right.T * (values / (values * values + damping))) @ left.T
        condition = min(largest / max(smallest, 1e-9), 1e6)
        if condition < (CLEAR_BELOW if self._near_singular else SLOW_ABOVE):
            self._near_singular = False
            return inverse, False, 1.0
        self._near_singular = True
        velocity = inverse @ (self._weights * asked[: self._rows])
        speed = float(np.abs(velocity).max())
        if speed < _MOVING:
            return inverse, damped, 1.0
        ahead = self._kinematics.placement_and_jacobian(q + velocity * (1e-4 / speed))[2]
        there = np.linalg.svd(self._weights[:, None] * ahead[: self._rows], compute_uv=False)
        worsening = (min(float(there[0]) / max(float(there[-1]), 1e-9), 1e6) - condition) * speed / 1e-4
        # What counts is where it gets to before it can stop. There, the smallest singular value falls about evenly.
        present = np.abs(inverse @ (self._weights * self._twist[: self._rows]))
        braking = float((present / self.arm.acceleration + self.arm.acceleration / self.arm.jerk).max())
        ahead_by = max(worsening, 0.0) * min(float(present.max()) / speed, 1.0) * 0.5 / SHARE * braking
        condition = condition / max(1.0 - ahead_by / condition, 1e-3)
        share = min(max((STOP_AT - condition) / (STOP_AT - SLOW_ABOVE), 0.0), 1.0)
        leading_in = min(max(worsening / WORSENS, 0.0), 1.0)
        return inverse, damped and leading_in > 0.0, 1.0 - leading_in * (1.0 - share)

    def _smoothed(self, wanted: FloatArray, inverse: FloatArray, dt: float) -> FloatArray:
        """The ideal twist (6,) a period later, on a straight line to the wanted one that the joints can follow."""
        change = wanted - self._twist
        size = float(np.linalg.norm(change))
        if size < _MOVING:
            self._rate = (0.0,) * 6
            return wanted
        way = change / size
        joints = np.maximum(np.abs(inverse @ (self._weights * way[: self._rows])), _MOVING)
        acceleration = min(SHARE * float((self.arm.acceleration / joints).min()), MOST_ACCELERATION)
        jerk = 0.5 * SHARE * min(float((self.arm.jerk / joints).min()), 15.0 * MOST_ACCELERATION)
        # Axes that do not change now may still have to end a change.
        turning = np.abs(self._rate) / max(float(np.linalg.norm(self._rate)), _MOVING)
        parts = np.maximum(np.maximum(np.abs(way), turning), 0.02)
        limits = acceleration * parts
        self._profile.limit(limits.tolist(), (jerk * parts).tolist())
        rate = np.clip(self._rate, -limits, limits).tolist()
        twist, self._rate = self._profile.after(self._twist.tolist(), rate, wanted.tolist(), dt)
        return np.array(twist)

    def _correction(self, rotation: FloatArray, position: FloatArray) -> FloatArray:
        """Twist (6,) that brings the tool back to its reference, across its motion.

        The reference moves on with the ideal twist. Along that, it is where the tool is: what joints lag behind when
        they speed up is not made up for, only what they leave the line by.
        """
        reference, twist = self._reference, self._twist
        off, turned = np.zeros(3), np.zeros(3)
        if reference is not None:
            off = _across(reference[0] - position, twist[:3], LEASH[0])
            turned = _across(_rotation_vector(reference[1] @ rotation.T), twist[3:], LEASH[1])
        self._ideal = position + off, _turned_by(turned) @ rotation
        return GAIN * np.concatenate((off, turned))


def _across(error: FloatArray, along: FloatArray, leash: float) -> FloatArray:
    """The part of an error (3,) across a direction, no longer than a leash."""
    size = float(along @ along)
    if size > _MOVING:
        error = error - along * (float(along @ error) / size)
    length = float(np.linalg.norm(error))
    return np.asarray(error * (leash / length) if length > leash else error)


def _rotation_vector(rotation: FloatArray) -> FloatArray:
    """Rotation vector (3,) [rad] of a small rotation: right to third order."""
    (_, xy, xz), (yx, _, yz), (zx, zy, _) = rotation.tolist()
    return np.asarray(0.5 * np.array([zy - yz, xz - zx, yx - xy]))


def _turned_by(vector: Sequence[float] | FloatArray) -> FloatArray:
    """Rotation matrix (3, 3) of a rotation vector [rad] (Rodrigues)."""
    x, y, z = (float(value) for value in vector)
    angle = (x * x + y * y + z * z) ** 0.5
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    if angle < 1e-8:
        return np.asarray(np.eye(3) + skew)
    first, second = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    return np.asarray(np.eye(3) + first * skew + second * (skew @ skew))
