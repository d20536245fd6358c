"""Pictures of robots, by themselves or at work, with smooth edges."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from robots.model import RobotModel
from robots.pose import FloatArray, Pose
from twin import World
from twin.camera import CameraModel, looking_at, make_renderer
from twin.ground import Ground, Slab
from twin.scene_spec import SceneSpec
from twin.scene_view import RobotState, SceneView, robot_state

_TIMES = 3
"""Drawn this much larger and averaged, so that edges are smooth."""
_FLOOR_RGB = (0.80, 0.81, 0.82)


def portrait(robot: RobotModel, width: int = 800, height: int = 600) -> NDArray[np.uint8]:
    """Draw a robot in its home posture, from its front left, (height, width, 3) RGB.

    Args:
        robot: The robot.
        width: Width [pixel].
        height: Height [pixel].
    """
    openings = {name: arm.gripper.max_opening for name, arm in robot.arms.items()}
    state = RobotState(robot.home, openings, robot.pose_base_in_world)
    bare = SceneView(SceneSpec(name="portrait", kind="table", robot=robot.name), robot, Ground(()))
    points = _points(bare, bare.poses(state, ()))
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = (low + high) / 2, float(np.linalg.norm(high - low))
    floor = Slab(
        "floor", (low[0] - 9, low[1] - 9, low[2] - 0.05), (high[0] + 9, high[1] + 9, low[2] - 0.001), _FLOOR_RGB
    )
    view = SceneView(SceneSpec(name="portrait", kind="table", robot=robot.name), robot, Ground((floor,)))
    eye = middle + 1.75 * size * np.array([0.80, 0.47, 0.36])
    return _draw(view, view.poses(state, ()), looking_at(eye, middle), 1.95, width, height)


def at_work(
    world: World,
    eye: Sequence[float],
    target: Sequence[float],
    zoom: float = 1.6,
    width: int = 640,
    height: int = 480,
) -> NDArray[np.uint8]:
    """Draw a world as it is now, (height, width, 3) RGB.

    Args:
        world: The world.
        eye: Where the camera is [m].
        target: What it looks at [m].
        zoom: Focal length in parts of the picture's shorter side.
        width: Width [pixel].
        height: Height [pixel].
    """
    state = world.state()
    view = SceneView(world.spec, world.robot, world.ground)
    poses = view.poses(robot_state(world.robot, state), state.objects)
    return _draw(view, poses, looking_at(eye, target), zoom, width, height)


def _draw(
    view: SceneView, poses: FloatArray, pose_camera_in_world: Pose, zoom: float, width: int, height: int
) -> NDArray[np.uint8]:
    """Draw larger than asked for, and average."""
    large = (_TIMES * width, _TIMES * height)
    focal = zoom * min(large)
    camera = CameraModel(*large, focal, focal, (large[0] - 1) / 2, (large[1] - 1) / 2, 0.05, 60.0)
    with make_renderer(view.geometry, camera) as renderer:
        drawn = renderer.render(poses, pose_camera_in_world).colour
    blocks = drawn.reshape(height, _TIMES, width, _TIMES, 3).mean(axis=(1, 3))
    return np.asarray(np.rint(blocks), dtype=np.uint8)


def _points(view: SceneView, poses: FloatArray) -> FloatArray:
    """Corners of everything that moves, in the world, (n, 3) [m]."""
    moving = [each for each in view.geometry.drawables if each.moving]
    return np.concatenate(
        [each.vertices @ pose[:3, :3].T + pose[:3, 3] for each, pose in zip(moving, poses, strict=True)]
    )
