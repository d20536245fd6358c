"""What cameras see of a scene: its geometry, and where everything is for a state, live or recorded.

Nothing here needs physics: a recorded state is enough, so that pictures are made in other processes than control.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from robots.kinematics import frame_pose, quaternion_xyzw, rotation_matrix
from robots.model import CameraMount, RobotModel
from robots.pose import FloatArray, Pose
from robots.visuals import RobotVisuals

from .camera import CameraModel, Drawable, SceneGeometry
from .camera.camera_model import pose_matrix
from .errors import TwinError
from .ground import Ground, Slab
from .scene_spec import SceneSpec
from .state import ObjectState, WorldState

ROBOT_ID = 2_000_000_000
"""What the mask says where the robot is seen; objects have their own ids."""
GROUND_ID = 2_000_000_001
"""What the mask says where table, board or floor is seen."""
_BOX_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_BOX_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4],
     [1, 5, 7], [1, 7, 3]],
    dtype=np.int32,
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class RobotState:
    """What of a robot's state decides how it looks; a demo records it.

    Attributes:
        q: Driven positions of all arms, (n,) [rad].
        openings: Gap of the fingers by arm [m].
        pose_base_in_world: Where its base is.
    """

    q: FloatArray
    openings: Mapping[str, float]
    pose_base_in_world: Pose


class SceneView:
    """Geometry of a scene, and poses of what moves in it.

    Attributes:
        geometry: For `make_renderer` and `render_states`.
        robot: The robot.
    """

    def __init__(self, spec: SceneSpec, robot: RobotModel, ground: Ground) -> None:
        """Gather what is drawn.

        Args:
            spec: The scene.
            robot: Its robot.
            ground: What it stands on.
        """
        self.robot = robot
        self._ids = [each.id for each in spec.objects]
        for each in self._ids:
            if not 0 <= each < ROBOT_ID:
                raise TwinError(f"object id {each} cannot be seen: a camera's ids are in 0..{ROBOT_ID - 1}")
        self._visuals = RobotVisuals(robot.urdf_path, None)  # its meshes were decimated when the URDF was prepared
        drawables = [_slab(slab) for slab in ground.slabs]
        drawables += [
            Drawable(GROUND_ID, corners, faces.astype(np.int32), np.array(rgb), False)
            for corners, faces, rgb in ground.pictures
        ]
        for shape in self._visuals.visuals:
            mesh = shape.mesh
            colours = np.full(mesh.vertices.shape, 0.8) if mesh.colours is None else mesh.colours
            drawables.append(Drawable(ROBOT_ID, mesh.vertices, mesh.faces, colours))
        self._parts: list[int] = []
        for number, thing in enumerate(spec.objects):
            for visual in thing.object_model().visuals:
                faces = visual.faces.astype(np.int32)
                drawables.append(Drawable(thing.id, visual.vertices, faces, np.array(visual.rgb)))
                self._parts.append(number)
        self.geometry = SceneGeometry(tuple(drawables))

    def poses(self, robot: RobotState, objects: Iterable[ObjectState]) -> FloatArray:
        """Poses of what moves, (N, 4, 4), for a renderer.

        Raises:
            TwinError: An object of the scene is missing.
        """
        links = self._visuals.placements(self.robot.expand(robot.q, robot.openings), robot.pose_base_in_world)
        where = {each.id: pose_matrix(each.pose_object_in_world) for each in objects}
        if missing := [each for each in self._ids if each not in where]:
            raise TwinError(f"the state has no object {missing[0]}; the scene's are {', '.join(map(str, self._ids))}")
        if not self._parts:
            return links
        return np.concatenate((links, np.stack([where[self._ids[number]] for number in self._parts])))

    def camera(self, name: str, width: int = 320, height: int = 240) -> CameraModel:
        """Intrinsics of a camera that the robot carries.

        Raises:
            TwinError: It carries no such camera.
        """
        sensor = self._mount(name).sensor
        return CameraModel.kinect2(width, height) if sensor == "kinect2" else CameraModel.xtion(width, height)

    def camera_pose(self, name: str, robot: RobotState) -> Pose:
        """Pose of a carried camera's optical frame in the world, for a state.

        Raises:
            TwinError: The robot carries no such camera.
        """
        mount = self._mount(name)
        joints = self.robot.expand(robot.q, robot.openings)
        link = frame_pose(self.robot.urdf_path, joints, mount.link)
        return _chain(_chain(robot.pose_base_in_world, link), mount.pose_camera_in_link)

    def _mount(self, name: str) -> CameraMount:
        if name not in self.robot.cameras:
            known = ", ".join(self.robot.cameras) or "none"
            raise TwinError(f"{self.robot.name} has no camera {name!r}; it has {known}")
        return self.robot.cameras[name]


def robot_state(robot: RobotModel, state: WorldState) -> RobotState:
    """What of a live state decides how the robot looks."""
    openings = {name: arm.gripper_opening for name, arm in zip(robot.arms, state.arms, strict=True)}
    return RobotState(state.q, openings, state.pose_base_in_world or robot.pose_base_in_world)


def _slab(slab: Slab) -> Drawable:
    corners = slab.centre + _BOX_CORNERS * slab.half_extents
    return Drawable(GROUND_ID, corners, _BOX_FACES, np.array(slab.rgb), False)


def _chain(first: Pose, second: Pose) -> Pose:
    """The pose `second`, given in the frame `first`, in the frame of `first`."""
    turn = rotation_matrix(first.orientation_xyzw)
    return Pose(
        first.position + turn @ second.position, quaternion_xyzw(turn @ rotation_matrix(second.orientation_xyzw))
    )
