"""What scenes stand on: the board, or a table with the robot beside it on the floor."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.collision import FLOOR, Obstacle
from robots.model import RobotModel
from robots.pose import FloatArray, Pose

from .board import CELL, CELLS
from .physics import Physics, Rgb

_LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
_TABLE_RGB: Rgb = (0.62, 0.56, 0.50)
_LEG_RGB: Rgb = (0.30, 0.31, 0.33)
_FLOOR_RGB: Rgb = (0.52, 0.53, 0.55)
_SQUARES_RGB: tuple[Rgb, Rgb] = ((0.93, 0.92, 0.88), (0.36, 0.40, 0.46))


@dataclass(frozen=True, slots=True)
class Slab:
    """A box that stands still for ever, with its sides along the world's axes.

    Attributes:
        name: What it is.
        lower: Lowest corner, (3,) [m].
        upper: Highest corner, (3,) [m].
        rgb: Colour.
    """

    name: str
    lower: tuple[float, float, float]
    upper: tuple[float, float, float]
    rgb: Rgb

    @property
    def centre(self) -> FloatArray:
        """Its centre, (3,) [m]."""
        return np.asarray((np.array(self.lower) + np.array(self.upper)) / 2)

    @property
    def half_extents(self) -> FloatArray:
        """Half of its sides, (3,) [m]."""
        return np.asarray((np.array(self.upper) - np.array(self.lower)) / 2)

    def obstacle(self) -> Obstacle:
        """The slab as planners see it."""
        size = tuple((2 * self.half_extents).tolist())
        return Obstacle(self.name, "box", size, Pose(self.centre, _LEVEL))


@dataclass(frozen=True, slots=True)
class Ground:
    """Everything that stands still in a scene.

    Attributes:
        slabs: Boxes.
        pictures: Faces that are only drawn: corners (n, 3) [m], triangles (m, 3), colour.
    """

    slabs: tuple[Slab, ...]
    pictures: tuple[tuple[FloatArray, NDArray[np.int64], Rgb], ...] = ()

    def build(self, physics: Physics) -> list[int]:
        """Add it to physics. Returns the bodies of the slabs, in order."""
        bodies = []
        for slab in self.slabs:
            half, centre = slab.half_extents.tolist(), slab.centre.tolist()
            bodies.append(physics.add_box(half, centre, 0.0, slab.rgb))
            physics.set_friction(bodies[-1], -1, 1.0)
        for corners, triangles, rgb in self.pictures:
            physics.add_picture(corners, triangles, rgb)
        return bodies

    def obstacles(self) -> list[Obstacle]:
        """Its boxes, as planners see them."""
        return [slab.obstacle() for slab in self.slabs]


def board_ground(robot: RobotModel) -> Ground:
    """The board: squares painted on a large table, on which the robot stands too, unless it stands on the floor."""
    middle = CELLS * CELL / 2
    near = middle - 0.6 if robot.floor is None else BOARD_EDGE
    slabs = [Slab("table", (near, middle - 0.6, -0.1), (middle + 0.6, middle + 0.6, 0.0), _TABLE_RGB), *_floor(robot)]
    return Ground(tuple(slabs), tuple((*_squares(parity), rgb) for parity, rgb in enumerate(_SQUARES_RGB)))


def beside_board(robot: RobotModel) -> RobotModel:
    """A robot where it stands at the board: one on the floor is drawn back, before the middle of the board."""
    if robot.floor is None:
        return robot
    base = robot.pose_base_in_world
    return robot.placed_at(Pose(base.position + np.array([-DRAWN_BACK, CELLS * CELL / 2, 0.0]), base.orientation_xyzw))


def table_ground(robot: RobotModel, x: tuple[float, float], y: tuple[float, float]) -> Ground:
    """A table whose top is at z = 0, with the robot beside it.

    Args:
        robot: The robot, placed; where it stands on a floor, there is one.
        x: Nearest and farthest edge of the table [m].
        y: Right and left edge of the table [m].
    """
    slabs = [Slab("table", (x[0], y[0], -TABLE_THICKNESS), (x[1], y[1], 0.0), _TABLE_RGB), *_floor(robot)]
    if len(slabs) > 1:
        floor = slabs[1].upper[2]
        inset = 0.04
        slabs += [
            Slab(
                f"leg_{number}",
                (at_x - inset / 2, at_y - inset / 2, floor),
                (at_x + inset / 2, at_y + inset / 2, -TABLE_THICKNESS),
                _LEG_RGB,
            )
            for number, (at_x, at_y) in enumerate(
                (at_x, at_y) for at_x in (x[0] + inset, x[1] - inset) for at_y in (y[0] + inset, y[1] - inset)
            )
        ]
    return Ground(tuple(slabs))


def _floor(robot: RobotModel) -> list[Slab]:
    """The floor that a robot stands on, if it stands on one."""
    if robot.floor is None:
        return []
    floor = float(robot.pose_base_in_world.position[2]) + robot.floor
    return [Slab(FLOOR, (-4.0, -4.0, floor - 0.1), (5.0, 4.0, floor), _FLOOR_RGB)]


TABLE_THICKNESS = 0.03
"""Thickness of the table's top [m]."""
BOARD_EDGE = -0.05
"""Where the board's table begins [m] if the robot stands before it,"""
DRAWN_BACK = 0.30
"""and how far back from its place at a table such a robot then stands [m]."""


def _squares(parity: int) -> tuple[FloatArray, NDArray[np.int64]]:
    """Corners (n, 3) [m] and triangles (m, 3) of the board's light (0) or dark (1) squares, just above the table."""
    cells = [(x, y) for x in range(CELLS) for y in range(CELLS) if (x + y) % 2 == parity]
    corners = [((x + i) * CELL, (y + j) * CELL, 0.0002) for x, y in cells for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    triangles = [[4 * n + a for a in face] for n in range(len(cells)) for face in ((0, 1, 2), (0, 2, 3))]
    return np.array(corners), np.array(triangles)
