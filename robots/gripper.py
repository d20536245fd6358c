"""Two fingers: how far apart they are for given joint positions, and the other way round."""

from dataclasses import dataclass, field

import numpy as np

from .pose import FloatArray, read_only

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True, slots=True)
class Gripper:
    """Two fingers that move together, from `closed` to `open`.

    Attributes:
        joints: The two finger joints.
        min_opening: Gap when closed [m]; above 0 where the fingers are mounted wide.
        max_opening: Gap when open [m].
        force: Closing force [N], or torque [Nm] of revolute fingers, of each finger.
        closing_speed: Speed of each finger joint [m/s or rad/s].
        spinning: Arm of the pads' friction against turning about their normal [m].
        closed: Joint positions when closed, (2,) [m or rad].
        open: Joint positions when open, (2,).
        approach: Unit vector in the tool frame along which the hand points, (3,).
        closing: Unit vector in the tool frame along which the fingers close, (3,).
        ways: Part of the way from closed to open, rising from 0 to 1, (k,), at which
        gaps: these gaps [m] were measured, rising too, (k,).
        touching: Links that are made to touch what is held; the rest of the hand is not.
    """

    joints: tuple[str, str]
    min_opening: float
    max_opening: float
    force: float
    closing_speed: float
    spinning: float
    closed: FloatArray
    open: FloatArray
    approach: FloatArray
    closing: FloatArray
    ways: FloatArray = field(repr=False)
    gaps: FloatArray = field(repr=False)
    touching: frozenset[str] = frozenset()

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        for name in ("closed", "open", "approach", "closing", "ways", "gaps"):
            object.__setattr__(self, name, read_only(getattr(self, name)))

    def joints_at(self, opening: float) -> tuple[float, float]:
        """Finger joint positions for a gap [m], which is held to what the fingers can do."""
        way = float(np.interp(opening, self.gaps, self.ways))
        first, second = self.closed + way * (self.open - self.closed)
        return float(first), float(second)

    def opening_at(self, first: float, second: float) -> float:
        """Gap [m] for the two joint positions; each finger counts for half of it."""
        (closed_1, closed_2), (open_1, open_2) = self.closed.tolist(), self.open.tolist()
        way = 0.5 * ((first - closed_1) / (open_1 - closed_1) + (second - closed_2) / (open_2 - closed_2))
        if len(self.ways) == 2:  # a straight line, also a little beyond its ends
            return float(self.gaps[0] + way * (self.gaps[1] - self.gaps[0]))
        return float(np.interp(way, self.ways, self.gaps))


def unit_axis(name: str) -> FloatArray:
    """Unit vector (3,) of an axis name such as `-z`."""
    vector = np.array(_AXES[name[-1]])
    return -vector if name.startswith("-") else vector
