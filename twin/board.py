"""Geometry of the 8 x 8 board: cells, columns of blocks, and what blocks there are.

The board lies in the world's x-y plane, its surface at z = 0. Cell (0, 0) has its corner at the world's origin; the
robot stands at x < 0 and looks along +x; left is +y. Blocks are smaller than cells so that fingers fit between
neighbours.
"""

import numpy as np

from robots.pose import FloatArray

CELLS = 8
"""Cells along each side, and the highest stack."""
CELL = 0.050
"""Side of a cell [m]."""
BLOCK = 0.038
"""Side and height of a block [m]."""

COLOURS_RGB: dict[str, tuple[float, float, float]] = {
    "blue": (0.10, 0.20, 0.85),
    "cyan": (0.10, 0.80, 0.85),
    "red": (0.85, 0.10, 0.10),
    "yellow": (0.95, 0.85, 0.10),
    "green": (0.10, 0.65, 0.15),
    "magenta": (0.90, 0.25, 0.75),
    "gray": (0.50, 0.50, 0.50),
    "white": (0.95, 0.95, 0.95),
}
"""Surface colour, red green blue in 0..1: the colours of the public release."""
ALL_COLOURS_RGB: dict[str, tuple[float, float, float]] = {**COLOURS_RGB, "black": (0.06, 0.06, 0.07)}
"""All colours that a block may have."""
SHAPES = ("cube", "prism")
"""The shapes of the public release."""
ALL_SHAPES = (*SHAPES, "sphere", "cylinder")
"""All shapes that a block may have; all of them are `BLOCK` wide and high."""
FLAT_TOPPED = ("cube", "cylinder")
"""The shapes that another block can stand on."""

CUBE_MASS = 0.050
PRISM_MASS = 0.025
"""Masses [kg]; a prism has half of a cube's volume."""
_HALF = BLOCK / 2
# The ridge lies along y above the middle; the two triangles are the end faces, which stand upright and face -y and +y.
PRISM_CORNERS = np.array(
    [[x, y, -_HALF] for y in (-_HALF, _HALF) for x in (-_HALF, _HALF)] + [[0, -_HALF, _HALF], [0, _HALF, _HALF]]
)
"""Corners of a prism around the centre of its bounding box, (6, 3) [m]."""
PRISM_FACES = np.array([[0, 1, 4], [3, 2, 5], [0, 2, 3], [0, 3, 1], [2, 0, 4], [2, 4, 5], [1, 3, 5], [1, 5, 4]])
"""Its faces, (8, 3) corner numbers."""
PRISM_MASS_CENTRE = np.array([0.0, 0.0, -_HALF + BLOCK / 3])
"""Its centre of mass, (3,) [m]."""


def cell_centre(x: int, y: int, z: int) -> FloatArray:
    """Centre [m] in the world of a block in cell (x, y) on level z (0 = on the board), (3,)."""
    return np.array([(x + 0.5) * CELL, (y + 0.5) * CELL, (z + 0.5) * BLOCK])


def nearest_cell(position: FloatArray) -> tuple[int, int, int]:
    """Cell (x, y, z) whose centre is nearest to a block centre [m]; not clipped to the board."""
    x, y = np.floor(np.asarray(position[:2]) / CELL).astype(int)
    return int(x), int(y), round(float(position[2]) / BLOCK - 0.5)
