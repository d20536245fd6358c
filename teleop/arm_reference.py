"""The pose that a tool is held to: it moves along with the motion that is commanded, and nowhere else."""

import math

import numpy as np

from robots.ik_kernel import compiled
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
        self._ideal: list[FloatArray] = []

    def correction(self, position: FloatArray, rotation: FloatArray, twist: FloatArray) -> FloatArray:
        """Twist (6,) that brings the tool back.

        Args:
            position: Of the tool, (3,) [m].
            rotation: Of the tool, (3, 3).
            twist: The ideal one of this period, (6,) [m/s, rad/s].
        """
        rotation = np.ascontiguousarray(rotation)
        back, *self._ideal = _brought_back(position, rotation, twist, *(self._pose or (position, rotation)))
        return back

    def move_on(self, twist: FloatArray, dt: float) -> None:
        """A period [s] was gone with the ideal twist (6,)."""
        if self._ideal:
            self._pose = _moved_on(twist, dt, *self._ideal)


@compiled
def _brought_back(
    position: FloatArray, rotation: FloatArray, twist: FloatArray, held: FloatArray, turned: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The twist (6,) that brings a tool back to where it is held, and the position and rotation it is held to now."""
    error, back = np.empty(6), np.empty(6)
    for i in range(3):
        error[i] = held[i] - position[i]
    error[3:] = _rotation_vector(turned, rotation)
    for part, leash in ((0, LEASH[0]), (3, LEASH[1])):
        back[part : part + 3] = _across(error[part : part + 3], twist[part : part + 3], leash)
    ideal = np.empty(3)
    for i in range(3):
        ideal[i] = position[i] + back[i]
    return GAIN * back, ideal, _turned(back[3:], rotation)


@compiled
def _moved_on(
    twist: FloatArray, dt: float, position: FloatArray, rotation: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """A pose after a period [s] of a twist (6,)."""
    return position + twist[:3] * dt, _turned(twist[3:] * dt, rotation)


@compiled
def _across(error: FloatArray, along: FloatArray, leash: float) -> FloatArray:
    """The part of an error (3,) across a direction, no longer than a leash."""
    across = error.copy()
    size = along[0] * along[0] + along[1] * along[1] + along[2] * along[2]
    if size > _MOVING:
        across -= along * ((along[0] * error[0] + along[1] * error[1] + along[2] * error[2]) / size)
    length = math.sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2])
    if length > leash:
        across *= leash / length
    return across


@compiled
def _rotation_vector(one: FloatArray, other: FloatArray) -> FloatArray:
    """Rotation vector (3,) [rad] of the small rotation from `other` to `one`: right to third order."""
    vector = np.zeros(3)
    for k in range(3):
        vector[0] += 0.5 * (one[2, k] * other[1, k] - one[1, k] * other[2, k])
        vector[1] += 0.5 * (one[0, k] * other[2, k] - one[2, k] * other[0, k])
        vector[2] += 0.5 * (one[1, k] * other[0, k] - one[0, k] * other[1, k])
    return vector


@compiled
def _turned(vector: FloatArray, rotation: FloatArray) -> FloatArray:
    """A rotation matrix turned by a rotation vector [rad] (Rodrigues)."""
    x, y, z = vector[0], vector[1], vector[2]
    angle = math.sqrt(x * x + y * y + z * z)
    first, second = 1.0, 0.5
    if angle > 1e-8:
        first, second = math.sin(angle) / angle, (1.0 - math.cos(angle)) / (angle * angle)
    turned = np.empty((3, 3))
    for k in range(3):
        a, b, c = rotation[0, k], rotation[1, k], rotation[2, k]
        # v + first (w x v) + second (w x (w x v)), column by column.
        u, v, w = y * c - z * b, z * a - x * c, x * b - y * a
        turned[0, k] = a + first * u + second * (y * w - z * v)
        turned[1, k] = b + first * v + second * (z * u - x * w)
        turned[2, k] = c + first * w + second * (x * v - y * u)
    return turned
