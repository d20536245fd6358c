"""The camera: colour, depth and what is seen, in one call, without a screen.

- `CameraModel` has size, intrinsics and a `DepthSensor`: `CameraModel.kinect2()`, `CameraModel.xtion()`; poses of
  cameras are those of the optical frame (x right, y down, z forward), `looking_at(eye, target)` makes one.
- `SceneGeometry` is what is drawn: `Drawable` meshes, each with an id, standing or moving.
- `make_renderer(geometry, camera)` gives a `Renderer`: `GlRenderer` (moderngl, EGL, one draw call), or `TinyRenderer`
  (PyBullet's own) with a note where OpenGL is missing. `render(poses, pose_camera_in_world)` gives an `RgbdFrame`.
- `kinect_noise(frame, rng, camera)` spoils a frame as a depth camera would.
- `render_states(...)` renders recorded states in other processes.

moderngl and PyBullet load when a renderer is made.
"""

from .camera_model import KINECT2_SENSOR, XTION_SENSOR, CameraModel, DepthSensor, looking_at
from .frame import NOTHING, RgbdFrame
from .noise import axial_sigma, kinect_noise
from .recorded import render_states
from .renderer import Renderer, RendererUnavailableError, make_renderer
from .scene_geometry import Drawable, SceneGeometry

__all__ = [
    "KINECT2_SENSOR",
    "NOTHING",
    "XTION_SENSOR",
    "CameraModel",
    "DepthSensor",
    "Drawable",
    "Renderer",
    "RendererUnavailableError",
    "RgbdFrame",
    "SceneGeometry",
    "axial_sigma",
    "kinect_noise",
    "looking_at",
    "make_renderer",
    "render_states",
]
