"""Which stick moves the tool which way."""

from dataclasses import asdict, dataclass
from typing import Literal

from .gamepad import BUTTON_INDEX, GamepadState

GripperWish = Literal["close", "open", "keep"]

_LEFT_TRIGGER, _RIGHT_TRIGGER = BUTTON_INDEX["left_trigger"], BUTTON_INDEX["right_trigger"]
_LEFT_BUMPER, _RIGHT_BUMPER = BUTTON_INDEX["left_bumper"], BUTTON_INDEX["right_bumper"]
_A, _B = BUTTON_INDEX["a"], BUTTON_INDEX["b"]
_PRESSED = 0.5


@dataclass(frozen=True, slots=True)
class TwistCommand:
    """What the person wants of the tool now.

    Attributes:
        twist: Linear [m/s] then angular [rad/s] velocity of the tool frame's origin, (6,), expressed in `frame`.
        frame: The frame whose axes the twist is expressed in.
        gripper: What the gripper should do from now on.
        fault: Why the input cannot be trusted; empty when it can. The servo stops on a fault.
    """

    twist: tuple[float, float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    frame: Literal["world", "tool"] = "world"
    gripper: GripperWish = "keep"
    fault: str = ""


@dataclass(frozen=True, slots=True)
class GamepadMapping:
    """Gamepad to twist: a pure function with its settings, which are saved in every demo.

    Left stick up is +x (away from the robot) and left is +y; the left trigger lowers, the right one raises; A or the
    right bumper closes the gripper, B or the left bumper opens it (both at once change nothing).

    Attributes:
        top_speed: Speed of the tool at full deflection of one control [m/s].
        dead_zone: Deflection of a stick or trigger below which it counts as resting; what is above is rescaled, so that
            speed starts from zero at its edge.
        expo: 0 is linear; 1 is cubic, finer around the centre.
    """

    top_speed: float = 0.3
    dead_zone: float = 0.08
    expo: float = 0.4

    def __post_init__(self) -> None:
        """Check the settings.

        Raises:
            ValueError: If one is out of range.
        """
        if not 0.0 < self.top_speed <= 10.0:
            raise ValueError(f"top_speed is {self.top_speed}, allowed above 0 up to 10 m/s")
        if not 0.0 <= self.dead_zone < 1.0 or not 0.0 <= self.expo <= 1.0:
            raise ValueError(f"dead_zone is {self.dead_zone} and expo {self.expo}, allowed 0..1 (dead_zone below 1)")

    def command(self, state: GamepadState) -> TwistCommand:
        """Map what the gamepad says to what the tool should do; never raises, faults are named in the command."""
        if fault := state.fault():
            return TwistCommand(fault=fault)
        axes, buttons = state.axes, state.buttons
        x = -self.top_speed * self._shape(axes[1])
        y = -self.top_speed * self._shape(axes[0])
        z = self.top_speed * (self._shape(buttons[_RIGHT_TRIGGER]) - self._shape(buttons[_LEFT_TRIGGER]))
        close = buttons[_A] > _PRESSED or buttons[_RIGHT_BUMPER] > _PRESSED
        open_ = buttons[_B] > _PRESSED or buttons[_LEFT_BUMPER] > _PRESSED
        wish: GripperWish = "keep" if close == open_ else "close" if close else "open"
        return TwistCommand((x, y, z, 0.0, 0.0, 0.0), gripper=wish)

    def deflection(self, speed: float) -> float:
        """Deflection in -1..1 that asks for a speed [m/s] along one control: the inverse of what `command` does."""
        wanted = min(abs(speed) / self.top_speed, 1.0)
        if wanted < 1e-6:
            return 0.0
        low, high = 0.0, 1.0
        for _ in range(20):  # monotone: bisection to 1e-6 of full deflection, finer than any hand
            middle = 0.5 * (low + high)
            if middle * (1.0 - self.expo + self.expo * middle * middle) < wanted:
                low = middle
            else:
                high = middle
        size = self.dead_zone + (1.0 - self.dead_zone) * high
        return size if speed > 0.0 else -size

    def to_dict(self) -> dict[str, float]:
        """Return the settings, for a demo's metadata."""
        return asdict(self)

    def _shape(self, deflection: float) -> float:
        """Dead zone, rescaling and expo, -1..1 to -1..1."""
        size = abs(deflection)
        if size <= self.dead_zone:
            return 0.0
        size = (size - self.dead_zone) / (1.0 - self.dead_zone)
        size *= 1.0 - self.expo + self.expo * size * size
        return size if deflection > 0.0 else -size
