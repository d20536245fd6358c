"""A robot's own camera: the noisy picture of a moment, and where the robot knows its own body to be in it."""

import threading
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from robots.model import RobotModel
from robots.pose import FloatArray, Pose
from twin.scene_spec import SceneSpec
from twin.state import ObjectState

if TYPE_CHECKING:
    from learning.perception.table import Table
    from twin.camera import CameraModel, Renderer, SceneGeometry
    from twin.scene_view import RobotState

WIDTH, HEIGHT = 320, 240
"""Usual size of a picture [pixel]."""
SAME_PLACE = 1e-5
"""Links that moved less than this [m] look the same."""


@dataclass(frozen=True, slots=True)
class Look:
    """What the camera and the joints tell at one moment.

    Attributes:
        colour: Red, green, blue, (height, width, 3) uint8.
        depth: Measured distance along the optical axis, (height, width) [m]; 0 where nothing is measured.
        body: Distance of the robot's own body as its joints say, (height, width) [m]; 0 where it is not.
        pose_camera_in_world: The optical frame, from the joints.
    """

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    body: NDArray[np.float32]
    pose_camera_in_world: Pose


class RobotEye:
    """Takes pictures of a scene with a camera that the robot carries. Use `with`, in the thread that made it.

    The true places of objects are used to draw what the camera would see, and for nothing else; which object a pixel
    shows is thrown away.

    Attributes:
        model: Size and intrinsics of the camera.
        name: Its name on the robot.
        table: Where the camera was when somebody found the table with it, and that table; None before.
    """

    def __init__(
        self, spec: SceneSpec, robot: RobotModel, camera: str | None = None, width: int = WIDTH, height: int = HEIGHT
    ) -> None:
        """Mount the camera.

        Args:
            spec: The scene.
            robot: Its robot.
            camera: One of the robot's cameras; None takes its first.
            width: Columns [pixel].
            height: Rows [pixel].

        Raises:
            PerceptionError: The robot has no camera, or none of that name.
        """
        if not robot.cameras:
            raise PerceptionError(
                f"{robot.name} has no camera, so it cannot see a table: add [cameras.NAME] to its robot.toml, or use "
                "the board, which is observed without one"
            )
        self.name = camera or next(iter(robot.cameras))
        if self.name not in robot.cameras:
            raise PerceptionError(f"{robot.name} has no camera {self.name!r}; it has {', '.join(robot.cameras)}")
        from twin.camera import SceneGeometry, make_renderer
        from twin.ground import table_ground
        from twin.scene_view import ROBOT_ID, SceneView
        from twin.world import TABLE_X, TABLE_Y

        self._view = SceneView(spec, robot, table_ground(robot, TABLE_X, TABLE_Y))
        self.model: CameraModel = self._view.camera(self.name, width, height)
        links = tuple(each for each in self._view.geometry.drawables if each.id == ROBOT_ID)
        self._links = len(links)
        self._picture = make_renderer(self._view.geometry, self.model)
        self._body = _body_renderer(robot, SceneGeometry(links), self.model)
        self._last: tuple[FloatArray, Pose, NDArray[np.float32]] | None = None
        self.table: tuple[Pose, Table] | None = None

    def look(self, robot: "RobotState", objects: Iterable[ObjectState], rng: np.random.Generator) -> Look:
        """Take a picture.

        Args:
            robot: Measured joint positions, finger gaps and base.
            objects: Where the objects are, for drawing.
            rng: Source of the sensor's noise.
        """
        from twin.camera import kinect_noise

        poses = self._view.poses(robot, objects)
        camera = self._view.camera_pose(self.name, robot)
        seen = kinect_noise(self._picture.render(poses, camera), rng, self.model)
        return Look(seen.colour, seen.depth, self._own_body(poses[: self._links], camera), camera)

    def _own_body(self, links: FloatArray, camera: Pose) -> NDArray[np.float32]:
        """Depth of the robot alone, drawn anew only when it has moved."""
        if self._last is not None:
            before, where, body = self._last
            still = np.abs(where.position - camera.position).max() < SAME_PLACE
            if still and np.abs(before - links).max() < SAME_PLACE:
                return body
        body = self._body.render(links, camera).depth
        self._last = (links.copy(), camera, body)
        return body

    def close(self) -> None:
        """Free the scene's renderer; that of the body is kept for the robot's next scene."""
        self._picture.close()

    def __enter__(self) -> Self:
        """Give the eye."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()


class _Kept(threading.local):
    """Each thread's renderer of a robot's body, and what it was made for: making one takes as long as ten pictures."""

    made_for: tuple[Path, "CameraModel"] | None = None
    renderer: "Renderer | None" = None


_KEPT = _Kept()


def _body_renderer(robot: RobotModel, links: "SceneGeometry", camera: "CameraModel") -> "Renderer":
    """A renderer of the robot alone: this thread's last one, where that suits."""
    from twin.camera import make_renderer

    wanted = (robot.urdf_path, camera)
    if _KEPT.renderer is None or _KEPT.made_for != wanted:
        if _KEPT.renderer is not None:
            _KEPT.renderer.close()
        _KEPT.made_for, _KEPT.renderer = wanted, make_renderer(links, camera)
    return _KEPT.renderer
