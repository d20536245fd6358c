"""Touching with a given force: the wrist's feeling steers the hand along one direction (admittance control)."""

import numpy as np

from executor.arm_motions import ArmMotions
from robots.pose import FloatArray
from twin import JointCommand, World

GAIN = 1.2e-4
"""Speed of the hand for each newton that is lacking [m/s/N]: arm and object give way by about a micrometre in 0.07 N,
so that what is lacking is halved in some 0.08 s."""
EASE = 4.0
"""So many times as fast it gives way to what is too much: what tilts under a hand jams, and pushes it harder."""
TOO_MUCH = 1.8
"""So many times the wanted force tells that something jams: the hand leaves it,"""
JAMMED = 0.05
"""if it lasts so long [s]: not when it touches."""
FASTEST = 0.004
"""Speed until something is felt, and largest speed then [m/s]."""
TOUCHED = 0.5
"""Something is felt from this force on [N]."""
ACCELERATION = 0.25
"""Largest change of speed [m/s^2]."""
SMOOTHING = 0.3
"""Part of a new reading in the smoothed force."""
ENOUGH = 0.8
"""The force is reached with this part of it."""
DAMPING = 1e-6
"""Of the inverse Jacobian [m^2]: near a singular posture the arm slows down."""


class Feeling:
    """What the wrist feels against a direction, beyond what it felt when this was made.

    Args:
        motions: The arm.
        direction: Of the motion, (3,) unit.
    """

    def __init__(self, motions: ArmMotions, direction: FloatArray) -> None:
        self._motions = motions
        self._direction = direction
        self._before = motions.wrist_force

    @property
    def force(self) -> float:
        """Force against the motion [N]."""
        return float(-(self._motions.wrist_force - self._before) @ self._direction)


class ForceTouch:
    """A hand that leans on something in a direction, as hard as it is told.

    Args:
        motions: The arm, which touches nothing yet.
        direction: In which it leans, (3,) unit.
        force: How hard [N].
    """

    def __init__(self, motions: ArmMotions, direction: FloatArray, force: float) -> None:
        self._motions = motions
        self._direction = direction
        self._wanted = force
        self._feeling = Feeling(motions, direction)
        self._felt = 0.0
        self._speed = 0.0

    @property
    def felt(self) -> float:
        """Smoothed force [N]."""
        return self._felt

    def come(self, way: float) -> bool:
        """Go on until the force is felt, at most by a way [m]; whether it was."""
        gone = 0.0
        while gone < way:
            gone += self._step() * World.DT
            if self._felt >= ENOUGH * self._wanted:
                return True
        self.end()
        return False

    def keep(self, seconds: float) -> None:
        """Keep leaning for a time [s], or until something jams."""
        jammed = 0.0
        for _ in range(round(seconds / World.DT)):
            self._step()
            jammed = jammed + World.DT if self._felt > TOO_MUCH * self._wanted else 0.0
            if jammed > JAMMED:
                break

    def end(self) -> None:
        """Come to rest."""
        while abs(self._speed) > 1e-6:
            self._step(0.0)

    def _step(self, speed: float | None = None) -> float:
        """One control step at a speed [m/s], or at that which the force asks for; returns the speed."""
        if speed is None:
            lacking = GAIN * (self._wanted - self._felt)
            lacking = float(np.clip(lacking if lacking > 0.0 else EASE * lacking, -EASE * FASTEST, FASTEST))
            speed = lacking if self._felt > TOUCHED else FASTEST
        most = ACCELERATION * World.DT
        self._speed += float(np.clip(speed - self._speed, -most, most))
        motions = self._motions
        jacobian = motions.arm.jacobian(motions.q)
        twist = np.concatenate((self._speed * self._direction, np.zeros(3)))
        if jacobian.shape[1] < 6:  # an arm that cannot choose its orientation
            jacobian, twist = jacobian[:3], twist[:3]
        rate = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + DAMPING * np.eye(len(jacobian)), twist)
        velocity: FloatArray = np.zeros(len(motions.world.robot.joint_names))
        velocity[motions.joints] = rate
        motions.world.step(JointCommand(velocity, motions.fingers.openings))
        self._felt += SMOOTHING * (self._feeling.force - self._felt)
        return self._speed
