"""The pose that a tool is held to: it moves along with the motion that is commanded, and nowhere else."""

from collections.abc import Sequence

import numpy as np

from robots.pose import FloatArray

GAIN = 8.0
"""How fast the tool comes back to its reference [1/s]."""
LEASH = (0.003, 0.02)
"""The reference is never farther away than this [m, rad]."""
_MOVING = 1e-9


class ReferencePose:
    """Where the tool of an arm should be, in the frame of the base.

    It moves on with the ideal twist. Along that, it is where the tool is: what joints lag behind when they speed up is
    not made up for, only what they leave the line by. So where a motion is slowed, its line stays.
    """

    def __init__(self) -> None:
        """Begin where the tool is."""
        self.forget()

    def forget(self) -> None:
        """Begin anew where the tool is at the next correction."""
        self._pose: tuple[FloatArray, FloatArray] | None = None
        self._ideal: tuple[FloatArray, FloatArray] | None = None

    def correction(self, position: FloatArray, rotation: FloatArray, twist: FloatArray) -> FloatArray:
        """Twist (6,) that brings the tool back.

        Args:
            position: Of the tool, (3,) [m].
            rotation: Of the tool, (3, 3).
            twist: The ideal one of this period, (6,) [m/s, rad/s].
        """
        off, turned = np.zeros(3), np.zeros(3)
        if self._pose is not None:
            off = _across(self._pose[0] - position, twist[:3], LEASH[0])
            turned = _across(_rotation_vector(self._pose[1] @ rotation.T), twist[3:], LEASH[1])
        self._ideal = position + off, _turned_by(turned) @ rotation
        return GAIN * np.concatenate((off, turned))

    def move_on(self, twist: FloatArray, dt: float) -> None:
        """A period [s] was gone with the ideal twist (6,)."""
        if self._ideal is not None:
            position, rotation = self._ideal
            self._pose = position + twist[:3] * dt, _turned_by(twist[3:] * dt) @ rotation


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
