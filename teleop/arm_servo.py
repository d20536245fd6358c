"""One arm's wishes as joint velocities: smoothed, held to a reference pose, slowed early for what lies ahead."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots import ArmModel, RobotModel
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
        self.rest()
        self.intend(ArmWish((0.01,) * 6), 1.0, arm.home, None, 0.01)
        self.rest()

    def rest(self) -> None:
        """Forget twist and reference."""
        self._twist: FloatArray = np.zeros(6)
        self._rate: tuple[float, ...] = (0.0,) * 6
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
        twist = ratio * np.array(wish.twist)
        asked = np.concatenate((axes @ twist[:3], axes @ twist[3:]))
        if not any(wish.twist) and float(np.abs(self._twist).max()) < ENDED:
            self.rest()
            n = self._n
            return ArmIntent(asked, np.zeros(n), jacobian, np.zeros(n, bool), DriveReason.NONE)
        wanted = asked.copy()
        reason, detail = DriveReason.NONE, ""
        if self._rows == 3:
            wanted[3:] = 0.0
            if asked[3:].any():
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
        return ArmIntent(asked, velocity, jacobian, np.ones(self._n, bool), reason, detail)

    def _jogged(self, joint: int, speed: float, jacobian: FloatArray) -> ArmIntent:
        velocity = np.zeros(self._n)
        velocity[joint] = speed
        self.rest()
        free = np.zeros(self._n, bool)
        free[joint] = True
        return ArmIntent(jacobian @ velocity, velocity, jacobian, free, DriveReason.NONE)

    def _look_ahead(self, wanted: FloatArray, q: FloatArray) -> tuple[float, int, int]:
        """How much of a wanted twist (6,) may be executed, what limits it, and the joint."""
        ends = not wanted.any()
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
        change = wanted - self._twist
        size = float(np.linalg.norm(change))
        if size < _MOVING:
            self._rate = (0.0,) * 6
            return wanted
        way = change / size
        joints = np.maximum(np.abs(self._inverse @ (self._weights * way[: self._rows])), _MOVING)
        if (speed := float(np.linalg.norm(self._twist))) > ENDED:
            # Joints that give way to others move, and have to brake, faster than the tool alone would have them.
            joints = np.maximum(joints, np.abs(self._velocity) * (abs(float(way @ self._twist)) / (speed * speed)))
        acceleration = min(CHANGING * float((self.arm.acceleration / joints).min()), MOST_ACCELERATION)
        jerk = min(JERKING * float((self.arm.jerk / joints).min()), RISE * MOST_ACCELERATION)
        # Axes that do not change now may still have to end a change.
        turning = np.abs(self._rate) / max(float(np.linalg.norm(self._rate)), _MOVING)
        parts = np.maximum(np.maximum(np.abs(way), turning), 0.02)
        limits = acceleration * parts
        self._profile.limit(limits.tolist(), (jerk * parts).tolist())
        rate = np.clip(self._rate, -limits, limits).tolist()
        twist, self._rate = self._profile.after(self._twist.tolist(), rate, wanted.tolist(), dt)
        return np.array(twist)
