"""Whether the robot's own arm hides a thing from its camera: a person who shows something lets it be seen."""

import numpy as np

from robots.collision import CollisionModel, Obstacle
from robots.kinematics import quaternion_xyzw
from robots.pose import FloatArray, Pose
from twin import World
from twin.scene_view import SceneView, robot_state

THICK = 0.004
"""Radius of a line of sight [m]."""
FROM_CAMERA = 0.12
"""A line begins so far from the camera [m]: what carries it does not hide anything."""
BEFORE = 0.012
"""It ends so far before the thing [m]."""
SIDES = ((0.0, 0.0), (0.6, 0.0), (-0.6, 0.0), (0.0, 0.7), (0.0, -0.4))
"""Where lines end: parts of the thing's half width and half height, as the camera sees them."""


class SightLines:
    """Lines from a robot's first camera to a thing.

    Attributes:
        arm: Name of the arm that may be in the way.
    """

    def __init__(self, world: World, arm: str, object_id: int) -> None:
        """Take the world as it stands."""
        self.arm = arm
        self._robot = world.placed_robot
        view = SceneView(world.spec, world.robot, world.ground)
        state = world.state()
        self._eye = view.camera_pose(next(iter(world.robot.cameras)), robot_state(world.robot, state)).position
        self._centre = next(each.pose_object_in_world.position for each in state.objects if each.id == object_id)
        self._half: FloatArray = world.model_of(object_id).half_extents
        self._whole = world.commanded_positions
        self._joints = self._robot.slice_of(arm)
        self._openings = dict(zip(self._robot.arms, world.commanded_openings, strict=True))
        self._here = self._models(np.zeros(3))

    def seen(self, q: FloatArray, opening: float | None = None, shift: FloatArray | None = None) -> float:
        """How much of the thing is seen, 0..1.

        Args:
            q: Posture of the arm, (n,) [rad].
            opening: Gap of the fingers [m]; None for what they were told.
            shift: By which the thing has moved, (3,) [m].
        """
        self._whole[self._joints] = q
        openings = self._openings if opening is None else {**self._openings, self.arm: opening}
        models = self._here if shift is None else self._models(shift)
        return sum(model.free(self._whole, openings) for model in models) / len(models)

    def _models(self, shift: FloatArray) -> list[CollisionModel]:
        centre = self._centre + shift
        ahead = (centre - self._eye) / np.linalg.norm(centre - self._eye)
        right = np.cross(ahead, (0.0, 0.0, 1.0))
        right /= np.linalg.norm(right)
        width = float(min(self._half[:2]))
        models = []
        for sideways, up in SIDES:
            end = centre + sideways * width * right + [0.0, 0.0, up * float(self._half[2])]
            line = end - self._eye
            length = float(np.linalg.norm(line))
            ahead = line / length
            first, last = FROM_CAMERA, length - width - BEFORE
            middle = self._eye + 0.5 * (first + last) * ahead
            sight = Obstacle("sight", "cylinder", (THICK, last - first), Pose(middle, _along(ahead)))
            models.append(CollisionModel(self._robot, [sight], moving=[self.arm]))
        return models


def _along(direction: FloatArray) -> FloatArray:
    """An orientation (xyzw) whose z axis points along a unit vector."""
    side = np.cross(direction, (1.0, 0.0, 0.0) if abs(direction[0]) < 0.9 else (0.0, 1.0, 0.0))
    side /= np.linalg.norm(side)
    return quaternion_xyzw(np.column_stack((side, np.cross(direction, side), direction)))
