"""The scripted operator's thumbs: they follow intentions smoothly, late and not quite."""

import math

import numpy as np

from robots.pose import FloatArray

from .gamepad import AXES, AXIS_INDEX, BUTTON_INDEX, BUTTONS, GamepadState
from .gamepad_mapping import GamepadMapping

SMOOTHING = 0.06
"""Time constant of a thumb's motion [s]."""
CLUMSINESS = 0.06
"""Standard deviation of a held deflection, relative to it; it wanders slowly."""
ARM_LAG = 0.035
"""How far the arm is known to follow behind the stick [s]."""
WANDER = 0.25
"""Time in which the wandering forgets [s]."""
TREMOR = 0.004
"""Standard deviation of quick, small motion of the thumbs, in deflections."""


class Hand:
    """Turns wished tool velocities into a gamepad state.

    Attributes:
        expected: The tool velocity that a practised hand expects of what it has done, (3,) [m/s].
    """

    def __init__(self, mapping: GamepadMapping, rng: np.random.Generator) -> None:
        """Take the gamepad.

        Args:
            mapping: The mapping that the operator is used to.
            rng: Source of imprecision.
        """
        self._mapping = mapping
        self._rng = rng
        self._smooth = [0.0, 0.0, 0.0]
        self._wander = [0.0, 0.0, 0.0]
        self.expected = np.zeros(3)

    def act(self, velocity: FloatArray, dt: float, close: bool = False, open_: bool = False) -> GamepadState:
        """Move the thumbs towards a wished tool velocity (3,) [m/s] for `dt` [s]."""
        follow = 1.0 - math.exp(-dt / SMOOTHING)
        keep = math.exp(-dt / WANDER)
        draws = self._rng.standard_normal((2, 3)).tolist()
        deflections = []
        for axis, wish in enumerate(velocity.tolist()):
            smooth = self._smooth[axis] + follow * (wish - self._smooth[axis])
            self._smooth[axis] = smooth
            wander = keep * self._wander[axis] + math.sqrt(1.0 - keep * keep) * CLUMSINESS * draws[0][axis]
            self._wander[axis] = wander
            size = self._mapping.deflection(smooth)
            # A thumb that does not push lies still.
            size = size * (1.0 + wander) + TREMOR * draws[1][axis] if abs(smooth) > 5e-4 else 0.0
            deflections.append(min(max(size, -1.0), 1.0))
        self.expected = self.expected + (1.0 - math.exp(-dt / ARM_LAG)) * (np.array(self._smooth) - self.expected)
        x, y, z = deflections
        reach = math.hypot(x, y)
        if reach > 1.0:  # the stick's gate is round
            x, y = x / reach, y / reach
        axes, buttons = [0.0] * len(AXES), [0.0] * len(BUTTONS)
        axes[AXIS_INDEX["left_x"]], axes[AXIS_INDEX["left_y"]] = -y, -x
        buttons[BUTTON_INDEX["right_trigger"]] = max(z, 0.0)
        buttons[BUTTON_INDEX["left_trigger"]] = max(-z, 0.0)
        buttons[BUTTON_INDEX["a"]] = 1.0 if close else 0.0
        buttons[BUTTON_INDEX["b"]] = 1.0 if open_ else 0.0
        return GamepadState(tuple(axes), tuple(buttons))
