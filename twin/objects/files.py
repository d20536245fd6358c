"""An object's faces and hulls as OBJ files: the only way in which PyBullet takes several meshes for one body."""

import atexit
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.spatial import ConvexHull, HalfspaceIntersection

from robots.pose import FloatArray

from ..physics import HULL_MARGIN
from .model import IntArray, ObjectModel


@dataclass(frozen=True, slots=True)
class ObjectFiles:
    """Files of one object, in the object frame.

    Attributes:
        hulls: The parts that are hulls, each one group; None where there are none.
        drawn: Faces, one file a visual mesh.
    """

    hulls: Path | None
    drawn: tuple[Path, ...]


@cache
def object_files(model: ObjectModel) -> ObjectFiles:
    """Write an object's files into this process's own temporary folder, which goes when the process ends."""
    folder = _folder()
    hulls = [_triangles(shrunk(part.vertices, HULL_MARGIN)) for part in model.parts if part.kind == "hull"]
    path = folder / f"{model.name}_hulls.obj"
    if hulls:
        _write(path, hulls)
    drawn = []
    for number, visual in enumerate(model.visuals):
        drawn.append(folder / f"{model.name}_{number}.obj")
        _write(drawn[-1], [(visual.vertices, visual.faces)])
    return ObjectFiles(path if hulls else None, tuple(drawn))


def shrunk(corners: FloatArray, margin: float) -> FloatArray:
    """Corners (k, 3) of a convex hull (n, 3) [m] with every face moved inwards by a margin [m]."""
    middle = corners.mean(axis=0)
    faces = np.unique(ConvexHull(corners - middle).equations.round(9), axis=0)
    faces[:, 3] += margin
    # In units of the margin, because Qhull drops corners that are close to each other in metres.
    faces[:, 3] /= margin
    cut = HalfspaceIntersection(faces, np.zeros(3)).intersections
    return np.unique((cut * margin + middle).round(9), axis=0)


@cache
def _folder() -> Path:
    folder = Path(tempfile.mkdtemp(prefix="showtell_objects_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


def _triangles(corners: FloatArray) -> tuple[FloatArray, IntArray]:
    """Corners (n, 3) and outward triangles (m, 3) of their convex hull."""
    found = ConvexHull(corners)
    faces = found.simplices.astype(np.int64)
    normals = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
    inward = np.einsum("ij,ij->i", normals, found.equations[:, :3]) < 0
    faces[inward] = faces[inward][:, ::-1]
    return corners, faces


def _write(path: Path, meshes: Sequence[tuple[FloatArray, IntArray]]) -> None:
    """Write an OBJ file with one group a mesh; every face has its own normal, so that it is lit flat."""
    lines = []
    corners = normals = 0
    for number, (vertices, faces) in enumerate(meshes):
        lines.append(f"o part_{number}")
        lines += ["v {:.9g} {:.9g} {:.9g}".format(*vertex) for vertex in vertices]
        sides = vertices[faces]
        across = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
        across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-15)
        lines += ["vn {:.6g} {:.6g} {:.6g}".format(*normal) for normal in across]
        for face in range(len(faces)):
            lines.append("f " + " ".join(f"{corners + at + 1}//{normals + face + 1}" for at in faces[face]))
        corners, normals = corners + len(vertices), normals + len(faces)
    path.write_text("\n".join(lines) + "\n", encoding="ascii")
