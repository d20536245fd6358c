"""An object in physics: made of its model, or of a block's shape and colour."""

from functools import cache

import numpy as np
from scipy.spatial.transform import Rotation

from robots.collision import Obstacle
from robots.pose import FloatArray, Pose

from .blocks import add_block
from .board import SHAPES
from .objects import ObjectModel, Part
from .objects.files import object_files
from .physics import Physics, RawPose
from .scene_spec import ObjectSpec
from .state import ObjectState

Quaternion = tuple[float, float, float, float]
Vector3 = tuple[float, float, float]

_LEVEL: Quaternion = (0.0, 0.0, 0.0, 1.0)


class ObjectBody:
    """One object in physics.

    Attributes:
        id: The object's id in the scene.
        body: Its body in the physics client.
    """

    def __init__(self, physics: Physics, spec: ObjectSpec, centre: FloatArray) -> None:
        """Place an object with the centre of its bounding box (3,) [m] in the world, turned by its own yaw."""
        self._physics = physics
        self._spec = spec
        self.id = spec.id
        if spec.model is None and spec.shape in SHAPES and spec.yaw == 0.0:
            self.body, mass_centre = add_block(physics, spec.shape, centre, spec.rgb)
            self._axes_xyzw = _LEVEL
        else:
            model = spec.object_model()
            mass_centre = model.centre_of_mass
            self._axes_xyzw, moments = _principal_axes(model)
            files = object_files(model)
            self.body = physics.add_parts(
                model.parts,
                files.hulls,
                [(path, visual.rgb) for path, visual in zip(files.drawn, model.visuals, strict=True)],
                (tuple(centre.tolist()), (0.0, 0.0, float(np.sin(spec.yaw / 2)), float(np.cos(spec.yaw / 2)))),
                model.mass,
                (tuple(mass_centre.tolist()), self._axes_xyzw),
                moments.tolist(),
            )
            physics.set_friction(
                self.body,
                -1,
                model.lateral_friction,
                spinning=model.spinning_friction,
                rolling=model.rolling_friction,
            )
        self._offset: Vector3 = tuple(mass_centre.tolist())
        physics.let_sleep(self.body)
        self._raw: RawPose | None = None
        self._state: ObjectState | None = None

    def state(self) -> ObjectState:
        """True pose of the object frame in the world; the same object as before while nothing has moved."""
        raw = self._physics.base_pose(self.body)
        if self._state is None or raw != self._raw:
            self._raw, self._state = raw, ObjectState(self.id, self._object_frame(raw))
        return self._state

    def obstacles(self, *, whole: bool = False) -> list[Obstacle]:
        """Its convex parts where they are now, as planners see them; each is named by the object's id.

        Args:
            whole: Take the convex hull around all parts instead: nothing reaches into it, and there is less to check.
        """
        pose = self.state().pose_object_in_world
        turn = Rotation.from_quat(pose.orientation_xyzw)
        parts = self.model.parts
        if whole and len(parts) > 1:
            return [Obstacle(str(self.id), "hull", (), pose, np.concatenate([part.vertices for part in parts]))]
        return [_obstacle(str(self.id), part, pose, turn) for part in parts]

    @property
    def model(self) -> ObjectModel:
        """What the object is."""
        return self._spec.object_model()

    def _object_frame(self, raw: RawPose) -> Pose:
        """The object frame, of the pose of the centre of mass and principal axes in the world."""
        orientation = raw[1] if self._axes_xyzw == _LEVEL else _turned_back(raw[1], self._axes_xyzw)
        position = np.array(raw[0])
        x, y, z = self._offset
        if x or y:
            position -= _rotated(orientation, (x, y, z))
        elif z:
            position -= z * _third_axis(orientation)
        return Pose(position, np.array(orientation))


@cache
def _principal_axes(model: ObjectModel) -> tuple[Quaternion, FloatArray]:
    """Principal axes of inertia in the object frame, as a quaternion xyzw, and the moments (3,) about them."""
    if np.abs(model.inertia - np.diag(np.diag(model.inertia))).max() < 1e-6 * np.trace(model.inertia):
        return _LEVEL, np.diag(model.inertia)
    moments, axes = np.linalg.eigh(model.inertia)
    axes[:, 2] *= np.linalg.det(axes)  # right-handed
    x, y, z, w = Rotation.from_matrix(axes).as_quat().tolist()
    return (x, y, z, w), moments


def _obstacle(name: str, part: Part, pose: Pose, turn: Rotation) -> Obstacle:
    """A part of an object that stands at a pose."""
    if part.kind == "hull":
        return Obstacle(name, "hull", (), pose, part.vertices)
    there = Pose(
        pose.position + turn.apply(part.pose.position.copy()),
        (turn * Rotation.from_quat(part.pose.orientation_xyzw)).as_quat(),
    )
    x, y, z = (2 * part.size).tolist()
    if part.kind == "box":
        return Obstacle(name, "box", (x, y, z), there)
    return (
        Obstacle(name, "sphere", (x / 2,), there)
        if part.kind == "sphere"
        else Obstacle(name, "cylinder", (x / 2, z), there)
    )


def _turned_back(orientation: Quaternion, by: Quaternion) -> Quaternion:
    """The rotation (xyzw) that, followed by `by` in its own axes, gives an orientation."""
    ax, ay, az, aw = orientation
    bx, by_, bz, bw = -by[0], -by[1], -by[2], by[3]
    return (
        aw * bx + ax * bw + ay * bz - az * by_,
        aw * by_ - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by_ - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by_ - az * bz,
    )


def _rotated(orientation_xyzw: Quaternion, vector: Vector3) -> FloatArray:
    """A vector (3,) of a rotated frame in the axes of the other frame."""
    x, y, z, w = orientation_xyzw
    a, b, c = vector
    # Twice the cross product of the quaternion's vector with it; then that once more.
    p, q, r = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return np.array([a + w * p + y * r - z * q, b + w * q + z * p - x * r, c + w * r + x * q - y * p])


def _third_axis(orientation_xyzw: Quaternion) -> FloatArray:
    """Where a rotated frame's z axis points, (3,)."""
    x, y, z, w = orientation_xyzw
    return np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
