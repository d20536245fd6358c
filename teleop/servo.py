"""The servo: a commanded tool twist becomes joint velocities that never leave any limit.

Every step is judged by what could follow it: the next velocity is taken only if braking from there, at the joint's own
acceleration and jerk limits, ends before the position limit. Since braking itself stays within the limits, there is
always a step that may be taken, and a motion that leads away from a limit is never held back.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from robots import RobotModel
from robots.pose import FloatArray, read_only

from .damped_inverse import damped_inverse
from .errors import ServoError
from .gamepad_mapping import TwistCommand
from .velocity_profile import VelocityProfile

POSITION_MARGIN = 2e-3
"""Joints keep this far from their position limits [rad]: room for the difference between a smooth braking ramp and one
that is executed in steps of the control period, at most acceleration * dt² / 2."""
AGREE_WITHIN = 1e-6
"""Asked and executed twists that differ by less are the same [m/s]."""
MAX_COMMANDED_SPEED = 2.0
"""Commands above this are faults of the input, not wishes [m/s or rad/s]."""


class ServoReason(StrEnum):
    """Why the executed twist is not the asked one; the first that applies, in this order."""

    NONE = ""
    BAD_INPUT = "bad input"
    POSITION_LIMIT = "position limit"
    VELOCITY_LIMIT = "velocity limit"
    SINGULARITY = "singularity"
    UNREACHABLE = "unreachable direction"
    ACCELERATION_LIMIT = "acceleration or jerk limit"


@dataclass(frozen=True, slots=True)
class ServoState:
    """What a servo remembers between two steps: the velocity and acceleration it last commanded.

    Attributes:
        velocity: (n,) [rad/s].
        acceleration: (n,) [rad/s²].
    """

    velocity: tuple[float, ...]
    acceleration: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ServoResult:
    """One step's outcome.

    Attributes:
        asked: The commanded twist along the axes of the world, (6,) [m/s, rad/s]; zero for a fault.
        executed: The twist that the returned joint velocity gives at this posture, (6,), along the axes of the world.
        joint_velocity: To be executed during the step, (n,) [rad/s].
        reason: Why the two twists differ.
        detail: The joint or the fault behind the reason, for people.
    """

    asked: FloatArray
    executed: FloatArray
    joint_velocity: FloatArray
    reason: ServoReason
    detail: str = ""


class Servo:
    """Turns commanded twists into joint velocities within position, velocity, acceleration and jerk limits.

    `step` depends on its arguments and on `state` alone. Arms with fewer than six joints follow the linear rows only.
    """

    def __init__(self, robot: RobotModel, state: ServoState | None = None) -> None:
        """Make a servo for a robot.

        Args:
            robot: Its joints, limits and Jacobian.
            state: What was commanded last; None takes the measured velocity at the first step.
        """
        self.robot = robot
        self.state = state
        self._n = len(robot.joint_names)
        self._rows = slice(0, 3) if self._n < 6 else slice(0, 6)
        self._velocity = robot.velocity.tolist()
        self._lower = (robot.lower + POSITION_MARGIN).tolist()
        self._upper = (robot.upper - POSITION_MARGIN).tolist()
        self._acceleration = robot.acceleration.tolist()
        self._profile = VelocityProfile(robot.acceleration.tolist(), robot.jerk.tolist())
        # Towards a position limit at distance d, speed is held to min(gain * d, sqrt(acceleration * d)): half of the
        # acceleration limit at speed, and a jerk of gain² * v at the end, which this gain keeps well inside its limit.
        self._gain = (0.4 * robot.jerk / robot.acceleration).tolist()

    def reset(self, state: ServoState | None = None) -> None:
        """Forget what was commanded, or take it from elsewhere."""
        self.state = state

    def step(self, command: TwistCommand, q: FloatArray, dq: FloatArray, dt: float) -> ServoResult:
        """Choose the joint velocity for the next control period.

        Args:
            command: What is wanted; a fault, NaN or an absurd speed brings the arm smoothly to rest.
            q: Measured positions of the driven joints, (n,) [rad].
            dq: Measured velocities, (n,) [rad/s]; used at the first step only.
            dt: Control period [s].

        Returns:
            The velocity to execute, with asked and executed twist and the reason for a difference.

        Raises:
            ServoError: `q` or `dq` is not n finite values, or `dt` is not positive.
        """
        positions = self._checked(q, "q")
        if not 0.0 < dt < 1.0:
            raise ServoError(f"dt is {dt}, allowed above 0 up to 1 s")
        if self.state is None:
            measured = self._checked(dq, "dq")
            speeds = [min(max(v, -limit), limit) for v, limit in zip(measured, self._velocity, strict=True)]
            self.state = ServoState(tuple(speeds), (0.0,) * self._n)
        jacobian = self.robot.jacobian(q)
        fault = command.fault or _fault_of(command.twist)
        if fault:
            asked, wanted = np.zeros(6), [0.0] * self._n
            reason, detail = ServoReason.BAD_INPUT, fault
        elif not any(command.twist):
            asked, wanted = np.zeros(6), [0.0] * self._n
            reason, detail = ServoReason.NONE, ""
        else:
            asked = self._in_world(command, q)
            wanted, damped = damped_inverse(jacobian[self._rows], asked[self._rows])
            reason = ServoReason.SINGULARITY if damped else ServoReason.NONE
            wanted, reason, detail = self._limit(wanted, positions, reason)
        velocity, acceleration, braked = self._advance(self.state, wanted, positions, dt)
        if braked is not None and reason is not ServoReason.BAD_INPUT:
            reason, detail = ServoReason.POSITION_LIMIT, self.robot.joint_names[braked]
        self.state = ServoState(velocity, acceleration)
        joint_velocity = np.array(velocity)
        executed = jacobian @ joint_velocity
        if reason is not ServoReason.BAD_INPUT:
            if max(map(abs, (executed - asked).tolist())) <= AGREE_WITHIN:
                reason, detail = ServoReason.NONE, ""
            elif reason is ServoReason.NONE:
                follows = all(abs(w - v) <= AGREE_WITHIN for w, v in zip(wanted, velocity, strict=True))
                reason = ServoReason.UNREACHABLE if follows else ServoReason.ACCELERATION_LIMIT
        return ServoResult(read_only(asked), read_only(executed), read_only(joint_velocity), reason, detail)

    def _checked(self, values: FloatArray, name: str) -> list[float]:
        """Return measured joint values as floats, or raise ServoError."""
        listed: list[float] = np.asarray(values, dtype=float).tolist()
        if np.shape(values) != (self._n,) or not all(map(math.isfinite, listed)):
            raise ServoError(f"{name} must be {self._n} finite values for {self.robot.name}, got {values!r}")
        return listed

    def _in_world(self, command: TwistCommand, q: FloatArray) -> FloatArray:
        """Return the commanded twist (6,) along the axes of the world."""
        twist = np.array(command.twist)
        if command.frame == "world":
            return twist
        from robots.kinematics import rotation_matrix

        rotation = rotation_matrix(self.robot.forward_kinematics(q).orientation_xyzw)
        return np.concatenate((rotation @ twist[:3], rotation @ twist[3:]))

    def _limit(
        self, wanted: list[float], positions: list[float], reason: ServoReason
    ) -> tuple[list[float], ServoReason, str]:
        """Scale velocities into their limits along the asked direction; slow down towards position limits."""
        detail = ""
        ratio, worst = max((abs(v) / limit, i) for i, (v, limit) in enumerate(zip(wanted, self._velocity, strict=True)))
        if ratio > 1.0:
            wanted = [v / ratio for v in wanted]
            reason, detail = ServoReason.VELOCITY_LIMIT, self.robot.joint_names[worst]
        for i, v in enumerate(wanted):
            distance = max(self._upper[i] - positions[i] if v > 0.0 else positions[i] - self._lower[i], 0.0)
            allowed = min(self._gain[i] * distance, math.sqrt(self._acceleration[i] * distance))
            if abs(v) > allowed:
                wanted[i] = allowed if v > 0.0 else -allowed
                reason, detail = ServoReason.POSITION_LIMIT, self.robot.joint_names[i]
        return wanted, reason, detail

    def _advance(
        self, state: ServoState, wanted: list[float], positions: list[float], dt: float
    ) -> tuple[tuple[float, ...], tuple[float, ...], int | None]:
        """Next velocity and acceleration, and the joint that had to brake for its position limit, if one had to."""
        velocity, acceleration = self._profile.after(state.velocity, state.acceleration, wanted, dt)
        if not any(velocity) and not any(acceleration):
            return velocity, acceleration, None
        braked = None
        extrema = self._profile.travel_to_rest(velocity, acceleration)
        target = list(wanted)
        for i, (back, ahead) in enumerate(extrema):
            step = velocity[i] * dt
            at = positions[i] + step
            if (at + ahead > self._upper[i] and ahead + max(step, 0.0) > 0.0 and wanted[i] > 0.0) or (
                at + back < self._lower[i] and back + min(step, 0.0) < 0.0 and wanted[i] < 0.0
            ):
                target[i], braked = 0.0, i
        if braked is not None:
            velocity, acceleration = self._profile.after(state.velocity, state.acceleration, target, dt)
        return velocity, acceleration, braked


def _fault_of(twist: tuple[float, ...]) -> str:
    """Name what is wrong with a commanded twist, or return an empty string."""
    for name, value in zip(("x", "y", "z", "roll", "pitch", "yaw"), twist, strict=True):
        if not abs(value) <= MAX_COMMANDED_SPEED:  # NaN fails every comparison
            return f"commanded {name} speed is {value!r}, allowed -{MAX_COMMANDED_SPEED}..{MAX_COMMANDED_SPEED}"
    return ""
