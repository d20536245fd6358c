"""Blocks in physics: cubes and prisms, their masses, friction and resting."""

import numpy as np

from robots.pose import FloatArray, Pose

from .board import BLOCK, COLOURS_RGB
from .physics import Physics, RawPose
from .scene_spec import ObjectSpec
from .state import ObjectState

CUBE_MASS = 0.050
PRISM_MASS = 0.025
"""Masses [kg]; a prism has half of a cube's volume."""
FRICTION = 1.0
HULL_MARGIN = 0.001
"""Bullet puts this much [m] around a convex hull; ours is made smaller by as much, so that its surface is true."""

_HALF = BLOCK / 2
# The ridge lies along y above the middle; the two triangles are the end faces, which stand upright and face -y and +y.
_PRISM_CORNERS = np.array(
    [[x, y, -_HALF] for y in (-_HALF, _HALF) for x in (-_HALF, _HALF)] + [[0, -_HALF, _HALF], [0, _HALF, _HALF]]
)
_PRISM_FACES = np.array([[0, 1, 4], [3, 2, 5], [0, 2, 3], [0, 3, 1], [2, 0, 4], [2, 4, 5], [1, 3, 5], [1, 5, 4]])
_PRISM_MASS_CENTRE = np.array([0.0, 0.0, -_HALF + BLOCK / 3])


def _shrunk_prism() -> FloatArray:
    """Corners (6, 3) of the prism with every face moved inwards by the hull margin, around the block's centre."""
    margin = HULL_MARGIN
    slope = np.array([BLOCK, _HALF]) / np.hypot(BLOCK, _HALF)  # normal (x, z) of a roof face
    reach = slope @ [0.0, _HALF] - margin  # its distance from the centre
    bottom = -_HALF + margin
    width = (reach - slope[1] * bottom) / slope[0]
    top = reach / slope[1]
    ends = (-_HALF + margin, _HALF - margin)
    return np.array([[x, y, bottom] for y in ends for x in (-width, width)] + [[0, y, top] for y in ends])


class Block:
    """One block in physics.

    Attributes:
        id: The object's id in the scene.
        body: Its body in the physics client.
    """

    def __init__(self, physics: Physics, spec: ObjectSpec, centre: FloatArray) -> None:
        """Place a block with its centre (3,) [m] in the world."""
        self._physics = physics
        self.id = spec.id
        rgb = COLOURS_RGB[spec.colour]
        if spec.shape == "cube":
            self._offset = np.zeros(3)
            self.body = physics.add_box([_HALF] * 3, centre.tolist(), CUBE_MASS, rgb)
        else:
            self._offset = _PRISM_MASS_CENTRE
            self.body = physics.add_hull(
                _shrunk_prism() - self._offset,
                _PRISM_FACES,
                _PRISM_CORNERS - self._offset,
                (centre + self._offset).tolist(),
                PRISM_MASS,
                rgb,
            )
        physics.set_friction(self.body, -1, FRICTION)
        physics.let_sleep(self.body)
        self._raw: RawPose | None = None
        self._state: ObjectState | None = None

    def state(self) -> ObjectState:
        """True pose of the block's centre in the world; the same object as before while the block has not moved."""
        raw = self._physics.base_pose(self.body)
        if self._state is None or raw != self._raw:
            position = np.array(raw[0])
            if self._offset[2]:
                position -= self._offset[2] * _third_axis(raw[1])
            self._raw, self._state = raw, ObjectState(self.id, Pose(position, np.array(raw[1])))
        return self._state


def _third_axis(orientation_xyzw: tuple[float, float, float, float]) -> FloatArray:
    """Where a rotated frame's z axis points, (3,)."""
    x, y, z, w = orientation_xyzw
    return np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
