"""Which of the six axes of a tool pose a task controls."""

from dataclasses import dataclass, field
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from .errors import RobotError

AXES = ("x", "y", "z", "rx", "ry", "rz")
"""Axes of a twist: along x, y, z, then about them."""

Frame = Literal["tool", "base"]


@dataclass(frozen=True, slots=True)
class TaskMask:
    """The axes that count; the arm is free along and about the others.

    Translation is measured along the axes of the target's tool frame, or of the base. With two controlled rotations
    the tool may turn freely about the third axis (`tool`: its own axis points where the target's does; `base`: its
    tilt against that axis of the base is the target's). With one, that component of the rotation vector from tool to
    target counts. Three of a kind are the same in either frame.

    Attributes:
        axes: Controlled axes, of `AXES`, in that order.
        frame: Whose axes they are.
        linear: Indices of the controlled translations, 0 to 2.
        angular: Indices of the controlled rotations, 0 to 2.
        codes: The same for `ik_kernel`, (7,): 1 for each controlled axis, then 1 for the tool's axes.
    """

    FULL: ClassVar["TaskMask"]
    POSITION: ClassVar["TaskMask"]

    axes: tuple[str, ...] = AXES
    frame: Frame = "tool"
    linear: tuple[int, ...] = field(init=False, repr=False, compare=False)
    angular: tuple[int, ...] = field(init=False, repr=False, compare=False)

    codes: NDArray[np.int64] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the names and bring them into order.

        Raises:
            RobotError: There is no axis, an axis is named twice, or a name is wrong.
        """
        if not self.axes or len(set(self.axes)) != len(self.axes) or not set(self.axes) <= set(AXES):
            raise RobotError(f"axes must be one or more different ones of {', '.join(AXES)}, got {self.axes!r}")
        if self.frame not in ("tool", "base"):
            raise RobotError(f"frame must be 'tool' or 'base', got {self.frame!r}")
        object.__setattr__(self, "axes", tuple(axis for axis in AXES if axis in self.axes))
        object.__setattr__(self, "linear", tuple(index for index in range(3) if AXES[index] in self.axes))
        object.__setattr__(self, "angular", tuple(index for index in range(3) if AXES[index + 3] in self.axes))
        codes = np.array([axis in self.axes for axis in AXES] + [self.frame == "tool"], dtype=np.int64)
        codes.setflags(write=False)
        object.__setattr__(self, "codes", codes)

    @classmethod
    def pointing(cls, axis: str = "z", frame: Frame = "tool") -> "TaskMask":
        """Position, and the direction of one axis, about which the tool may turn: five controlled axes.

        Args:
            axis: `x`, `y` or `z`.
            frame: Whose axis it is.

        Raises:
            RobotError: There is no such axis.
        """
        if axis not in AXES[:3]:
            raise RobotError(f"axis must be x, y or z, got {axis!r}")
        return cls(tuple(each for each in AXES if each != f"r{axis}"), frame)


TaskMask.FULL = TaskMask()
TaskMask.POSITION = TaskMask(("x", "y", "z"))
