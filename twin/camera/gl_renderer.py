"""The door to moderngl: OpenGL without a screen, everything in one draw call."""

import ctypes.util
from types import TracebackType
from typing import Any, Self

import numpy as np

from robots.pose import FloatArray, Pose

from ..errors import TwinError
from .camera_model import CameraModel, pose_matrix
from .frame import NOTHING, RgbdFrame
from .renderer import AMBIENT, BACKGROUND, LIGHT, RendererUnavailableError
from .scene_geometry import SceneGeometry
from .shading import shaded_corners

_HELP = "install OpenGL and EGL (Debian, Ubuntu: apt-get install libegl1 libgl1 libgl1-mesa-dri)"

_VERTEX = """
#version 430
layout(std430, binding = 0) readonly buffer Poses { mat4 poses[]; };
uniform mat4 clip_from_world;
in vec3 corner;
in vec3 normal;
in vec3 rgb;
in uint drawable;
out vec3 world_point;
out vec3 world_normal;
out vec3 shade;
flat out float number;
void main() {
    vec4 point = poses[drawable] * vec4(corner, 1.0);
    world_point = point.xyz;
    world_normal = mat3(poses[drawable]) * normal;
    shade = rgb;
    number = float(drawable + 1u);  // 0 is nothing; floats are exact to 16 million
    gl_Position = clip_from_world * point;
}
"""

_FRAGMENT = """
#version 430
uniform vec3 eye;
uniform vec3 light;
uniform float ambient;
in vec3 world_point;
in vec3 world_normal;
in vec3 shade;
flat in float number;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth;
layout(location = 2) out float seen;
void main() {
    vec3 n = normalize(world_normal);
    n = dot(n, eye - world_point) < 0.0 ? -n : n;  // meshes of the field turn some faces inside out
    colour = vec4(shade * (ambient + (1.0 - ambient) * max(dot(n, light), 0.0)), 1.0);
    depth = 1.0 / gl_FragCoord.w;  // w in clip space is the depth along the optical axis
    seen = number;
}
"""

_ROW = np.dtype([("corner", "f4", 3), ("normal", "f4", 3), ("rgb", "u1", 4), ("drawable", "u4")])


class GlRenderer:
    """Draws with OpenGL 4.3 through EGL: on Mesa's software driver about 1 ms for Baxter and a table at 320 x 240.

    Attributes:
        name: "moderngl".
        note: None.
    """

    name = "moderngl"

    def __init__(self, geometry: SceneGeometry, camera: CameraModel) -> None:
        """Send the geometry to OpenGL.

        Raises:
            RendererUnavailableError: moderngl, EGL or OpenGL 4.3 is missing.
        """
        self.note: str | None = None
        self._geometry = geometry
        self._camera = camera
        self._ids = np.array([NOTHING, *(each.id for each in geometry.drawables)], dtype=np.int32)
        self._moving = np.array([each.moving for each in geometry.drawables])
        self._poses = np.tile(np.eye(4), (len(geometry.drawables), 1, 1))
        self._context: Any = _context()
        try:
            with self._context:
                self._send()
        except BaseException:
            self._context.release()
            raise

    def _send(self) -> None:
        """Make buffers, program and targets."""
        context, camera = self._context, self._camera
        corners, faces = [], []
        count = 0
        for index, each in enumerate(self._geometry.drawables):
            colours = np.broadcast_to(each.rgb, each.vertices.shape)
            points, normals, rgb, triangles = shaded_corners(each.vertices, each.faces, colours)
            rows = np.zeros(len(points), dtype=_ROW)
            rows["corner"], rows["normal"], rows["drawable"] = points, normals, index
            rows["rgb"][:, :3] = np.round(255 * rgb)
            corners.append(rows)
            faces.append(triangles + count)
            count += len(points)
        self._program = context.program(_VERTEX, _FRAGMENT)
        self._program["light"] = tuple(np.asarray(LIGHT) / np.linalg.norm(LIGHT))
        self._program["ambient"] = AMBIENT
        self._vertex_array = context.vertex_array(
            self._program,
            [(context.buffer(np.concatenate(corners)), "3f4 3f4 3f1 x1 1u4", "corner", "normal", "rgb", "drawable")],
            index_buffer=context.buffer(np.concatenate(faces).astype("u4")),
        )
        self._pose_buffer = context.buffer(reserve=64 * len(self._poses))
        size = (camera.width, camera.height)
        colour = context.texture(size, 4, dtype="f1")
        depth, seen = (context.texture(size, 1, dtype="f4") for _ in range(2))
        self._target = context.framebuffer([colour, depth, seen], context.depth_renderbuffer(size))
        # Clearing gives all parts of a target one value; colour needs another than depth.
        self._backdrop = context.framebuffer([colour])
        self._clip = camera.clip_matrix()

    def render(self, poses: FloatArray, pose_camera_in_world: Pose) -> RgbdFrame:
        """Draw; see `Renderer.render`."""
        if self._context is None:
            raise TwinError("this renderer is closed: make another")
        self._poses[self._moving] = self._geometry.checked_poses(poses)
        height, width = self._camera.height, self._camera.width
        colour = np.empty((height, width, 3), dtype=np.uint8)
        depth = np.empty((height, width), dtype=np.float32)
        seen = np.empty((height, width), dtype=np.float32)
        clip_from_world = self._clip @ np.linalg.inv(pose_matrix(pose_camera_in_world))
        # `with`: several contexts may live in a process, and calls go to the one that is current.
        with self._context as context:
            # OpenGL wants columns first.
            self._pose_buffer.write(np.ascontiguousarray(self._poses.transpose(0, 2, 1), dtype=np.float32))
            self._pose_buffer.bind_to_storage_buffer(0)
            self._program["clip_from_world"].write(np.ascontiguousarray(clip_from_world.T, dtype=np.float32))
            self._program["eye"] = tuple(pose_camera_in_world.position)
            context.enable_only(context.DEPTH_TEST)
            self._target.clear(0.0, 0.0, 0.0, 0.0)
            self._backdrop.clear(*BACKGROUND, 1.0)
            self._target.use()
            self._vertex_array.render()
            # The projection has the top row at y = -1, so rows come in the order of the picture.
            self._target.read_into(colour, components=3, attachment=0, alignment=1)
            self._target.read_into(depth, components=1, attachment=1, dtype="f4")
            self._target.read_into(seen, components=1, attachment=2, dtype="f4")
        return RgbdFrame(colour, depth, self._ids.take(seen.astype(np.int32)))

    def close(self) -> None:
        """Free the context and all that is in it."""
        if self._context is not None:
            with self._context as context:
                for part in (self._vertex_array, self._program, self._pose_buffer, self._target, self._backdrop):
                    part.release()
                context.gc()
            self._context.release()
            self._context = None

    def __enter__(self) -> Self:
        """Give the renderer."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        self.close()


def _context() -> Any:
    """A context of our own without a screen.

    Raises:
        RendererUnavailableError: It cannot be made.
    """
    try:
        import moderngl
    except ImportError as error:
        raise RendererUnavailableError(f"moderngl cannot be imported ({error}): pip install moderngl") from error
    # Machines without development packages have libEGL.so.1 and no libEGL.so, which is what moderngl looks for.
    names = {key: ctypes.util.find_library(name) for key, name in (("libegl", "EGL"), ("libgl", "GL"))}
    settings: dict[str, Any] = {"backend": "egl", **{key: name for key, name in names.items() if name}}
    try:
        return moderngl.create_context(require=430, standalone=True, **settings)
    except Exception as error:  # moderngl raises bare Exception and whatever the loader raises.
        reason = " ".join(str(error).split())
        raise RendererUnavailableError(f"no OpenGL 4.3 through EGL ({reason}): {_HELP}") from error
