"""The choice of a renderer."""

import logging
import os
from types import TracebackType
from typing import Protocol, Self

from robots.pose import FloatArray, Pose

from ..errors import TwinError
from .camera_model import CameraModel
from .frame import RgbdFrame
from .scene_geometry import SceneGeometry

VARIABLE = "SHOWTELL_RENDERER"
"""Environment variable that asks for a renderer."""
KINDS = ("auto", "gl", "tiny")

LIGHT = (0.3, 0.2, 0.93)
"""Direction towards the lamp, in the world."""
AMBIENT = 0.45
"""Part of a surface's colour that the room's light gives; the lamp gives the rest where it shines straight."""
BACKGROUND = (0.62, 0.66, 0.70)
"""Colour of what is beyond everything."""

_LOG = logging.getLogger(__name__)


class RendererUnavailableError(TwinError):
    """A renderer cannot work on this machine; the message says what is missing."""


class Renderer(Protocol):
    """Draws one scene with one camera. A context manager; use it in the thread that made it.

    Attributes:
        name: Name for tables.
        note: Why this is not the fastest renderer; None when it is.
    """

    name: str
    note: str | None

    def render(self, poses: FloatArray, pose_camera_in_world: Pose) -> RgbdFrame:
        """Draw.

        Args:
            poses: Homogeneous poses of the geometry's moving drawables in the world, (N, 4, 4).
            pose_camera_in_world: Pose of the optical frame (x right, y down, z forward).

        Raises:
            TwinError: The poses do not fit the geometry, or the renderer is closed.
        """
        ...

    def close(self) -> None:
        """Free the renderer; later calls of `render` fail."""
        ...

    def __enter__(self) -> Self:
        """Give the renderer."""
        ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close it."""
        ...


def make_renderer(geometry: SceneGeometry, camera: CameraModel, kind: str = "auto") -> Renderer:
    """Make the fastest renderer that works here.

    Args:
        geometry: What to draw.
        camera: The camera.
        kind: "gl" (OpenGL), "tiny" (PyBullet's own) or "auto": OpenGL, or else PyBullet's with a note that says why.
            The environment variable SHOWTELL_RENDERER decides for "auto".

    Raises:
        RendererUnavailableError: "gl" was asked for and OpenGL is missing; the message says what to install.
        TwinError: There is no such kind.
    """
    wanted = os.environ.get(VARIABLE, "auto") if kind == "auto" else kind
    if wanted not in KINDS:
        raise TwinError(f"renderer must be one of {', '.join(KINDS)}, got {wanted!r}")
    if wanted == "tiny":
        return _tiny(geometry, camera, None)
    try:
        from .gl_renderer import GlRenderer

        return GlRenderer(geometry, camera)
    except RendererUnavailableError as error:
        if wanted == "gl":
            raise
        note = f"rendering with PyBullet's own renderer, which is slower: {error}"
        _LOG.warning(note)
        return _tiny(geometry, camera, note)


def _tiny(geometry: SceneGeometry, camera: CameraModel, note: str | None) -> Renderer:
    # Here, because PyBullet need not be loaded where OpenGL draws.
    from .tiny_renderer import TinyRenderer

    return TinyRenderer(geometry, camera, note)
