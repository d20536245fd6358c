"""What a renderer draws: triangle meshes with ids, those that stand and those that move."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray, read_only

from ..errors import SceneError, TwinError


@dataclass(frozen=True, slots=True)
class Drawable:
    """One mesh.

    Attributes:
        id: What the mask says where it is seen, at least 0; several drawables may share one (the links of a robot).
        vertices: Corners, (n, 3) [m]: in a frame of its own if it moves, else in the world.
        faces: Corner numbers of each triangle, (m, 3).
        rgb: Colour in 0..1, (3,), or one for each corner, (n, 3).
        moving: Whether `render` is given a pose for it.
    """

    id: int
    vertices: FloatArray
    faces: NDArray[np.int32]
    rgb: FloatArray
    moving: bool = True

    def __post_init__(self) -> None:
        """Check and freeze the arrays.

        Raises:
            SceneError: A shape or number is wrong; names the drawable's id.
        """
        vertices, rgb = read_only(self.vertices), read_only(self.rgb)
        faces = np.array(self.faces, dtype=np.int32)
        faces.setflags(write=False)
        if not 0 <= self.id < 2**31:
            raise SceneError(f"drawable {self.id}: id must be in 0..{2**31 - 1}")
        if vertices.ndim != 2 or vertices.shape[1] != 3 or not np.isfinite(vertices).all():
            raise SceneError(f"drawable {self.id}: vertices must be finite and (n, 3), got shape {vertices.shape}")
        if faces.ndim != 2 or faces.shape[1] != 3 or not len(faces):
            raise SceneError(f"drawable {self.id}: faces must be (m, 3) with m > 0, got shape {faces.shape}")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise SceneError(
                f"drawable {self.id}: faces must name corners 0..{len(vertices) - 1}, got {faces.min()}..{faces.max()}"
            )
        if rgb.shape not in ((3,), vertices.shape) or not ((rgb >= 0) & (rgb <= 1)).all():
            raise SceneError(
                f"drawable {self.id}: rgb must be (3,) or {vertices.shape} in 0..1, got shape {rgb.shape}, "
                f"values {rgb.min() if rgb.size else 'none'}..{rgb.max() if rgb.size else 'none'}"
            )
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        object.__setattr__(self, "rgb", rgb)


@dataclass(frozen=True, slots=True)
class SceneGeometry:
    """Everything that may be seen.

    Attributes:
        drawables: The meshes; `render` is given poses of the moving ones in this order.
    """

    drawables: tuple[Drawable, ...]

    def __post_init__(self) -> None:
        """Check that there is something.

        Raises:
            SceneError: There is nothing to draw.
        """
        object.__setattr__(self, "drawables", tuple(self.drawables))
        if not self.drawables:
            raise SceneError("a scene needs at least one drawable: add the table or a robot's visuals")

    @property
    def moving(self) -> int:
        """How many drawables move: N of `render`'s poses."""
        return sum(drawable.moving for drawable in self.drawables)

    def checked_poses(self, poses: FloatArray) -> FloatArray:
        """Poses of the moving drawables as float64.

        Raises:
            TwinError: Their shape is not (N, 4, 4), or a number is not finite.
        """
        checked = np.asarray(poses, dtype=float)
        if checked.shape != (self.moving, 4, 4):
            raise TwinError(
                f"poses must be ({self.moving}, 4, 4), one of each moving drawable, got shape {checked.shape}"
            )
        if not np.isfinite(checked).all():
            raise TwinError("poses must be finite numbers, got NaN or infinity: leave out frames without a state")
        return checked
