"""The renderers that `showtell bench camera` compares, each from joint positions to colour, depth and mask."""

import importlib.util
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import trimesh

from robots.kinematics import quaternion_xyzw
from robots.pose import FloatArray, Pose
from robots.visuals import RobotVisuals
from twin import TwinError
from twin.camera import NOTHING, CameraModel, Drawable, RgbdFrame, SceneGeometry, make_renderer
from twin.camera.camera_model import pose_matrix
from twin.camera.renderer import AMBIENT, BACKGROUND, LIGHT
from twin.camera.shading import shaded_corners
from twin.scene_view import ROBOT_ID


@dataclass(frozen=True, slots=True)
class Setup:
    """What is drawn.

    Attributes:
        urdf: URDF of the robot with decimated meshes.
        original_urdf: The same robot with its meshes as they are.
        pose_base_in_world: Where the robot stands.
        still: What does not move.
        objects: What moves beside the robot, n of them.
        pose_camera_in_world: The optical frame.
    """

    urdf: Path
    original_urdf: Path
    pose_base_in_world: Pose
    still: tuple[Drawable, ...]
    objects: tuple[Drawable, ...]
    pose_camera_in_world: Pose


@dataclass(frozen=True, slots=True)
class Moment:
    """One frame's state.

    Attributes:
        joints: Joint positions by name [rad or m].
        objects: Poses of the objects, (n, 4, 4).
    """

    joints: Mapping[str, float]
    objects: FloatArray


Show = Callable[[Moment], RgbdFrame]


@contextmanager
def contender(name: str, setup: Setup, camera: CameraModel) -> Iterator[Show]:
    """A renderer by its name in the benchmark.

    Raises:
        TwinError: It does not work on this machine.
        ImportError: Its library is missing.
    """
    if name == "moderngl":
        with _own(setup, camera, "gl") as show:
            yield show
    elif name == "fallback":
        with _own(setup, camera, "tiny") as show:
            yield show
    elif name == "open3d":
        yield _open3d(setup, camera)
    else:
        urdf = setup.original_urdf if name == "tinyrenderer_original" else setup.urdf
        with _pybullet(setup, camera, urdf, hardware=name == "pybullet_egl") as show:
            yield show


@contextmanager
def _own(setup: Setup, camera: CameraModel, kind: str) -> Iterator[Show]:
    """Ours."""
    robot = RobotVisuals(setup.urdf, None)
    with make_renderer(SceneGeometry(_all_drawables(setup, robot)), camera, kind) as renderer:

        def show(moment: Moment) -> RgbdFrame:
            links = robot.placements(moment.joints, setup.pose_base_in_world)
            return renderer.render(np.concatenate((links, moment.objects)), setup.pose_camera_in_world)

        yield show


def _all_drawables(setup: Setup, robot: RobotVisuals) -> tuple[Drawable, ...]:
    """What stands, the robot's links, the objects."""
    links = [
        Drawable(ROBOT_ID, each.mesh.vertices, each.mesh.faces, _colours(each.mesh.colours)) for each in robot.visuals
    ]
    return (*setup.still, *links, *setup.objects)


def _colours(colours: FloatArray | None) -> FloatArray:
    return np.full(3, 0.8) if colours is None else colours


@contextmanager
def _pybullet(setup: Setup, camera: CameraModel, urdf: Path, *, hardware: bool) -> Iterator[Show]:
    """PyBullet's renderers, used as one would: the robot from its URDF, joints reset, one picture."""
    import pybullet
    import pybullet_data

    client = pybullet.connect(pybullet.DIRECT)
    pybullet.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=client)
    try:
        if hardware:
            plugin = importlib.util.find_spec("eglRenderer")
            number = -1
            if plugin is not None and plugin.origin is not None:
                number = pybullet.loadPlugin(plugin.origin, "_eglRendererPlugin", physicsClientId=client)
            if number < 0:
                raise TwinError("PyBullet's EGL plug-in does not load here")
        base = setup.pose_base_in_world
        robot = pybullet.loadURDF(
            str(urdf), base.position, base.orientation_xyzw, useFixedBase=True, physicsClientId=client
        )
        count = pybullet.getNumJoints(robot, physicsClientId=client)
        joints = {pybullet.getJointInfo(robot, each, physicsClientId=client)[1].decode(): each for each in range(count)}
        owners = {robot: ROBOT_ID}
        with TemporaryDirectory(prefix="showtell-bench-") as folder:
            for each in setup.still:
                owners[_add(client, each, Path(folder))] = each.id
            objects = [_add(client, each, Path(folder)) for each in setup.objects]
        owners.update(zip(objects, (each.id for each in setup.objects), strict=True))
        ids = np.full(max(owners) + 2, NOTHING, dtype=np.int32)
        ids[list(owners)] = list(owners.values())
        # TinyRenderer looks through the corners of pixels, OpenGL through their centres.
        seen_from = camera if hardware else replace(camera, cx=camera.cx - 0.5, cy=camera.cy + 0.5)
        flip = np.diag((1.0, -1.0, -1.0, 1.0))
        projection = (np.diag((1.0, -1.0, 1.0, 1.0)) @ seen_from.clip_matrix() @ flip).T.reshape(-1).tolist()
        view = (flip @ np.linalg.inv(pose_matrix(setup.pose_camera_in_world))).T.reshape(-1).tolist()
        size = (camera.height, camera.width)

        def show(moment: Moment) -> RgbdFrame:
            for name, position in moment.joints.items():
                pybullet.resetJointState(robot, joints[name], position, physicsClientId=client)
            for body, pose in zip(objects, moment.objects, strict=True):
                pybullet.resetBasePositionAndOrientation(
                    body, pose[:3, 3], quaternion_xyzw(pose[:3, :3]), physicsClientId=client
                )
            image = pybullet.getCameraImage(
                camera.width,
                camera.height,
                view,
                projection,
                shadow=0,
                lightDirection=LIGHT,
                renderer=pybullet.ER_BULLET_HARDWARE_OPENGL if hardware else pybullet.ER_TINY_RENDERER,
                physicsClientId=client,
            )
            colour = np.reshape(np.asarray(image[2], dtype=np.uint8), (*size, 4))[:, :, :3]
            buffer = np.reshape(np.asarray(image[3], dtype=np.float32), size)
            mask = ids[np.reshape(np.asarray(image[4], dtype=np.int32), size)]
            depth = camera.far * camera.near / (camera.far - (camera.far - camera.near) * buffer)
            depth[mask == NOTHING] = 0.0
            return RgbdFrame(colour, depth.astype(np.float32), mask)

        yield show
    finally:
        pybullet.disconnect(client)


def _add(client: int, drawable: Drawable, folder: Path) -> int:
    """Add a drawable as a body of one colour, through a file: the EGL plug-in draws no meshes from memory."""
    import pybullet

    colours = np.broadcast_to(drawable.rgb, drawable.vertices.shape)
    points, normals, _, faces = shaded_corners(drawable.vertices, drawable.faces, colours)
    file = folder / f"{len(list(folder.iterdir()))}.obj"
    mesh = trimesh.Trimesh(points, faces, vertex_normals=normals, process=False)
    mesh.export(file, include_normals=True)
    shape = pybullet.createVisualShape(
        pybullet.GEOM_MESH,
        fileName=str(file),
        rgbaColor=[*colours.mean(axis=0).tolist(), 1.0],
        physicsClientId=client,
    )
    return int(pybullet.createMultiBody(0, -1, shape, physicsClientId=client))


def _open3d(setup: Setup, camera: CameraModel) -> Show:
    """Open3D's ray casting: everything as one mesh, whose tree is built anew for each frame."""
    import open3d

    tensor: Any = open3d.core.Tensor  # its stubs know no numpy arrays
    robot = RobotVisuals(setup.urdf, None)
    drawables = _all_drawables(setup, robot)
    counts = [len(each.vertices) for each in drawables]
    starts = np.cumsum([0, *counts])[:-1]
    local = np.concatenate([each.vertices for each in drawables]).astype(np.float32)
    owner = np.repeat(np.arange(len(drawables)), counts)
    faces = np.concatenate([each.faces + start for each, start in zip(drawables, starts, strict=True)]).astype(
        np.uint32
    )
    owners = np.repeat([each.id for each in drawables], [len(each.faces) for each in drawables])
    ids = np.append(owners, NOTHING).astype(np.int32)
    backdrop = np.round(255 * np.asarray(BACKGROUND))[None]
    colours = np.concatenate([np.broadcast_to(each.rgb, each.vertices.shape) for each in drawables])
    face_colours = (255 * colours[faces].mean(axis=1)).astype(np.float32)
    at = pose_matrix(setup.pose_camera_in_world)
    directions = camera.rays() @ at[:3, :3].T
    rays = tensor(np.concatenate((np.broadcast_to(at[:3, 3], directions.shape), directions), axis=2).astype(np.float32))
    light = (np.asarray(LIGHT) / np.linalg.norm(LIGHT)).astype(np.float32)
    still = np.tile(np.eye(4), (len(setup.still), 1, 1))

    def show(moment: Moment) -> RgbdFrame:
        links = robot.placements(moment.joints, setup.pose_base_in_world)
        poses = np.concatenate((still, links, moment.objects)).astype(np.float32)[owner]
        points = np.einsum("nij,nj->ni", poses[:, :3, :3], local) + poses[:, :3, 3]
        scene = open3d.t.geometry.RaycastingScene()
        scene.add_triangles(tensor(points), tensor(faces))
        hits = scene.cast_rays(rays)
        depth = hits["t_hit"].numpy()
        sides = points[faces]
        normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        # Both sides are lit alike here: a cheaper light than ours.
        lit = AMBIENT + (1 - AMBIENT) * np.abs(normals @ light) / np.maximum(np.linalg.norm(normals, axis=1), 1e-12)
        # Open3D's number for no face is the largest: the last row, that of nothing.
        face = np.minimum(hits["primitive_ids"].numpy(), len(faces))
        colour = np.concatenate((face_colours * lit[:, None], backdrop)).astype(np.uint8)
        return RgbdFrame(colour[face], np.where(face == len(faces), np.float32(0.0), depth), ids[face])

    return show
