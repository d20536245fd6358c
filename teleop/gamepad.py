"""What a gamepad says at one instant, in the layout that W3C calls "standard"."""

from dataclasses import dataclass

AXES = ("left_x", "left_y", "right_x", "right_y")
"""Axes in order; -1 is left and up, +1 right and down, as browsers report them."""
BUTTONS = (
    "a",
    "b",
    "x",
    "y",
    "left_bumper",
    "right_bumper",
    "left_trigger",
    "right_trigger",
    "back",
    "start",
    "left_stick",
    "right_stick",
    "up",
    "down",
    "left",
    "right",
    "guide",
)
"""Buttons in order; 0 is released, 1 fully pressed, triggers in between."""

AXIS_INDEX = {name: index for index, name in enumerate(AXES)}
BUTTON_INDEX = {name: index for index, name in enumerate(BUTTONS)}


@dataclass(frozen=True, slots=True)
class GamepadState:
    """Four axes and seventeen buttons of a W3C standard gamepad (https://www.w3.org/TR/gamepad/#remapping).

    Plain tuples, not arrays: they are made, sent and written 240 times a second. Values are kept as they came, even
    when a broken device sends NaN or 7.0; `GamepadMapping` answers those with a named fault, on which the servo stops.

    Attributes:
        axes: `AXES`, (4,), each in -1..1.
        buttons: `BUTTONS`, (17,), each in 0..1.
    """

    axes: tuple[float, ...] = (0.0,) * len(AXES)
    buttons: tuple[float, ...] = (0.0,) * len(BUTTONS)

    def __post_init__(self) -> None:
        """Refuse another layout.

        Raises:
            ValueError: If there are not four axes and seventeen buttons.
        """
        if len(self.axes) != len(AXES) or len(self.buttons) != len(BUTTONS):
            raise ValueError(
                f"a standard gamepad has {len(AXES)} axes and {len(BUTTONS)} buttons, "
                f"got {len(self.axes)} and {len(self.buttons)}"
            )

    def fault(self) -> str:
        """Name the first value that no gamepad can send, or return an empty string."""
        for name, value in zip(AXES, self.axes, strict=True):
            if not -1.0 <= value <= 1.0:  # NaN fails every comparison
                return f"gamepad axis {name} is {value!r}, allowed -1..1"
        for name, value in zip(BUTTONS, self.buttons, strict=True):
            if not 0.0 <= value <= 1.0:
                return f"gamepad button {name} is {value!r}, allowed 0..1"
        return ""

    @classmethod
    def from_controls(cls, **values: float) -> "GamepadState":
        """Make a state from named axes and buttons; the others rest.

        Raises:
            ValueError: If a name is neither an axis nor a button.
        """
        axes, buttons = [0.0] * len(AXES), [0.0] * len(BUTTONS)
        for name, value in values.items():
            if name in AXIS_INDEX:
                axes[AXIS_INDEX[name]] = value
            elif name in BUTTON_INDEX:
                buttons[BUTTON_INDEX[name]] = value
            else:
                raise ValueError(f"a gamepad has no {name!r}; it has {', '.join(AXES + BUTTONS)}")
        return cls(tuple(axes), tuple(buttons))


RESTING = GamepadState()
"""Nothing touched."""
