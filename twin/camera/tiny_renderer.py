"""PyBullet's own software renderer, in a client of its own: the fall-back that needs no OpenGL."""

import weakref
from dataclasses import replace
from types import TracebackType
from typing import Self

import numpy as np
import pybullet

from robots.kinematics import quaternion_xyzw
from robots.pose import FloatArray, Pose

from ..errors import TwinError
from .camera_model import CameraModel, pose_matrix
from .frame import NOTHING, RgbdFrame
from .renderer import AMBIENT, BACKGROUND, LIGHT
from .scene_geometry import Drawable, SceneGeometry
from .shading import shaded_corners

_FACES_AT_ONCE = 20_000
"""Faces of one visual shape: PyBullet takes up to 131,072 corners at a time."""


class TinyRenderer:
    """Draws with PyBullet's TinyRenderer: about 20 ms for Baxter and a table at 320 x 240.

    Attributes:
        name: "tinyrenderer".
        note: Why it was chosen, if not on request.
    """

    name = "tinyrenderer"

    def __init__(self, geometry: SceneGeometry, camera: CameraModel, note: str | None = None) -> None:
        """Send the geometry to a client of its own.

        Raises:
            TwinError: PyBullet has no client left.
        """
        self.note = note
        self._geometry = geometry
        self._camera = camera
        self._client = pybullet.connect(pybullet.DIRECT)
        if self._client < 0:
            raise TwinError("PyBullet gives no further client: close worlds and renderers that are no longer used")
        self._closer = weakref.finalize(self, _disconnect, self._client)
        owners: dict[int, int] = {}
        self._moving: list[list[int]] = []
        for each in geometry.drawables:
            bodies = self._add(each)
            owners.update(dict.fromkeys(bodies, each.id))
            if each.moving:
                self._moving.append(bodies)
        # The last place is what body -1, nothing, is looked up as.
        self._ids = np.full(max(owners) + 2, NOTHING, dtype=np.int32)
        self._ids[list(owners)] = list(owners.values())
        # TinyRenderer looks through the lower left corner of each pixel (measured), and we through its centre.
        clip = replace(camera, cx=camera.cx - 0.5, cy=camera.cy + 0.5).clip_matrix()
        # OpenGL's camera looks along -z with y up, and its picture's top row is at y = 1.
        self._projection = (np.diag((1.0, -1.0, 1.0, 1.0)) @ clip @ np.diag((1.0, -1.0, -1.0, 1.0))).T

    def _add(self, drawable: Drawable) -> list[int]:
        """Add the bodies of a drawable: one for each colour, as PyBullet's shapes have one."""
        colours = np.broadcast_to(drawable.rgb, drawable.vertices.shape)
        shades, which = np.unique(colours[drawable.faces[:, 0]], axis=0, return_inverse=True)
        bodies = []
        for index, shade in enumerate(shades):
            faces = drawable.faces[which.reshape(-1) == index]
            points, normals, _, triangles = shaded_corners(drawable.vertices, faces, colours)
            # It does not draw the backs of faces, and meshes of the field turn some inside out: every face has two.
            triangles = np.concatenate((triangles, triangles[:, ::-1] + len(points)))
            points, normals = np.concatenate((points, points)), np.concatenate((normals, -normals))
            for start in range(0, len(triangles), _FACES_AT_ONCE):
                used, numbers = np.unique(triangles[start : start + _FACES_AT_ONCE], return_inverse=True)
                shape = pybullet.createVisualShape(
                    pybullet.GEOM_MESH,
                    vertices=points[used].tolist(),
                    indices=numbers.reshape(-1).tolist(),
                    normals=normals[used].tolist(),
                    rgbaColor=[*shade.tolist(), 1.0],
                    physicsClientId=self._client,
                )
                bodies.append(pybullet.createMultiBody(0, -1, shape, physicsClientId=self._client))
        return bodies

    def render(self, poses: FloatArray, pose_camera_in_world: Pose) -> RgbdFrame:
        """Draw; see `Renderer.render`."""
        if not self._closer.alive:
            raise TwinError("this renderer is closed: make another")
        for bodies, pose in zip(self._moving, self._geometry.checked_poses(poses), strict=True):
            position, orientation = pose[:3, 3].tolist(), quaternion_xyzw(pose[:3, :3]).tolist()
            for body in bodies:
                pybullet.resetBasePositionAndOrientation(body, position, orientation, physicsClientId=self._client)
        camera = self._camera
        view = np.diag((1.0, -1.0, -1.0, 1.0)) @ np.linalg.inv(pose_matrix(pose_camera_in_world))
        image = pybullet.getCameraImage(
            camera.width,
            camera.height,
            view.T.reshape(-1).tolist(),
            self._projection.reshape(-1).tolist(),
            lightDirection=LIGHT,
            lightColor=(1, 1, 1),
            lightDistance=10.0,
            shadow=0,
            lightAmbientCoeff=AMBIENT,
            lightDiffuseCoeff=1.0 - AMBIENT,
            lightSpecularCoeff=0.0,
            renderer=pybullet.ER_TINY_RENDERER,
            physicsClientId=self._client,
        )
        size = (camera.height, camera.width)
        colour = np.ascontiguousarray(np.reshape(np.asarray(image[2], dtype=np.uint8), (*size, 4))[:, :, :3])
        buffer = np.reshape(np.asarray(image[3], dtype=np.float64), size)
        mask = self._ids[np.reshape(np.asarray(image[4], dtype=np.int32), size)]
        depth = camera.far * camera.near / (camera.far - (camera.far - camera.near) * buffer)
        depth[mask == NOTHING] = 0.0
        colour[mask == NOTHING] = np.round(255 * np.asarray(BACKGROUND))
        return RgbdFrame(colour, depth.astype(np.float32), mask)

    def close(self) -> None:
        """Disconnect the client."""
        self._closer()

    def __enter__(self) -> Self:
        """Give the renderer."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()


def _disconnect(client: int) -> None:
    """Close one client; the interpreter may already have taken it down."""
    if pybullet.isConnected(client):
        pybullet.disconnect(client)
