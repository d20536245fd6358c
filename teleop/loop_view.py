"""What the page draws, as bytes: the geometry of a scene once, then poses.

Layouts (little-endian; every block starts at a multiple of four bytes):

- geometry: `G`, 3 bytes of padding, uint32 number of the world, uint32 length of the header, uint32 zero; the header
  (JSON, filled up with spaces); corners float32 (V, 3) [m]; normals int8 (V, 4), times 127; colours uint8 (V, 4);
  the drawable of each corner uint16 (V), filled up; corner numbers of each triangle uint32 (T, 3).
- poses: `P`, 3 bytes of padding, uint32 number of the world, float64 simulated time [s]; float32 (N, 3, 4): upper rows
  of the matrices of the moving drawables and then of the robot's cameras, in the world.
"""

import itertools
import math
import struct

import numpy as np

from robots.pose import FloatArray
from twin.camera.camera_model import pose_matrix
from twin.camera.shading import shaded_corners
from twin.scene_view import GROUND_ID, SceneView, robot_state
from twin.world import World

_OVERVIEW = {"board": (-0.55, -0.62, 0.80), "table": (0.80, -0.60, 0.60)}
"""From where the overview looks: over the board arm's right shoulder; robots behind a table would hide it."""
_BELOW = 0.1
"""Parts of the robot lower than this under the table's top are not what one looks at [m]."""


class SceneStream:
    """Geometry and poses of one world.

    Attributes:
        number: Which world it is; poses of another are not drawn with its geometry.
    """

    def __init__(self, world: World, number: int) -> None:
        """Gather what is drawn."""
        self.number = number
        self._world = world
        self._view = SceneView(world.spec, world.robot, world.ground)
        self._cameras = list(world.robot.cameras)

    def geometry(self) -> bytes:
        """The geometry message."""
        import orjson

        corners, normals, colours, owners, faces = [], [], [], [], []
        drawables = self._view.geometry.drawables
        count, slots = 0, itertools.count()
        for number, each in enumerate(drawables):
            rgb = np.broadcast_to(each.rgb, each.vertices.shape)
            at, normal, colour, triangles = shaded_corners(each.vertices, each.faces, rgb)
            corners.append(at)
            normals.append(normal)
            colours.append(colour)
            owners.append(np.full(len(at), number))
            faces.append(triangles + count)
            count += len(at)
        centre, radius = self._extent()
        header = {
            "corners": count,
            "triangles": sum(map(len, faces)),
            "drawables": [
                {"slot": next(slots) if each.moving else -1, "ground": each.id == GROUND_ID} for each in drawables
            ],
            "cameras": [self._camera(name) for name in self._cameras],
            "centre": centre.tolist(),
            "radius": radius,
            "overview": _OVERVIEW[self._world.spec.kind],
        }
        text = orjson.dumps(header)
        text += b" " * (-len(text) % 4)
        blocks = (
            np.concatenate(corners).astype("<f4"),
            _four(np.round(127 * np.concatenate(normals)).astype("i1")),
            _four(np.round(255 * np.concatenate(colours)).astype("u1")),
            np.pad(np.concatenate(owners), (0, count % 2)).astype("<u2"),
            np.concatenate(faces).astype("<u4"),
        )
        start = struct.pack("<c3xIII", b"G", self.number, len(text), 0)
        return start + text + b"".join([block.tobytes() for block in blocks])

    def poses(self) -> bytes:
        """The poses message for the world as it is now."""
        state = self._world.state()
        robot = robot_state(self._world.robot, state)
        matrices = self._view.poses(robot, state.objects)[:, :3]
        if self._cameras:
            cameras = [pose_matrix(self._view.camera_pose(name, robot))[:3] for name in self._cameras]
            matrices = np.concatenate((matrices, np.stack(cameras)))
        return struct.pack("<c3xId", b"P", self.number, state.time) + matrices.astype("<f4").tobytes()

    def _camera(self, name: str) -> dict[str, object]:
        model = self._view.camera(name)
        return {"name": name, "height": 2 * math.atan(model.height / (2 * model.fy))}

    def _extent(self) -> tuple[FloatArray, float]:
        """Middle (3,) and radius [m] of what one looks at: where the robot works, and the robot above the table."""
        state = self._world.state()
        points = [np.asarray(each.position) for each in self._world.spec.objects]
        points += [arm.pose_tool_in_world.position for arm in state.arms]
        work = np.stack(points)
        links = self._view.poses(robot_state(self._world.robot, state), state.objects)[:, :3, 3]
        everything = np.concatenate((work, links[links[:, 2] > -_BELOW]))
        middles = [(each.min(axis=0) + each.max(axis=0)) / 2 for each in (work, everything)]
        return (middles[0] + middles[1]) / 2, float(np.linalg.norm(np.ptp(everything, axis=0))) / 2


def _four(rows: "np.ndarray[tuple[int, ...], np.dtype[np.int8]]") -> "np.ndarray[tuple[int, ...], np.dtype[np.int8]]":
    """Rows of three with a zero at the end, so that they start at multiples of four bytes."""
    return np.pad(rows, ((0, 0), (0, 1)))
