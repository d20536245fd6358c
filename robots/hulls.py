"""A mesh as a few convex hulls, which is how both collision libraries handle it fast."""

from functools import lru_cache, partial
from pathlib import Path

import numpy as np
import trimesh

from .errors import RobotError
from .meshes import kept, load
from .obstacle import span_a_volume
from .pose import FloatArray
from .triangle_mesh import TriangleMesh

SLACK = 1.15
"""A mesh whose hull has less than this many times its volume is as good as convex."""
CUTS = 8
"""Slices of a mesh that is not."""


def convex_pieces(path: Path) -> list[Path]:
    """Convex hulls that together cover a mesh and not much more, as OBJ files.

    A mesh that is far from convex is sliced across its longest side, and each slice gets a hull of its own: Baxter's
    torso fills but half of its one hull, which would keep his elbows away from his waist.

    Raises:
        RobotError: The mesh cannot be read, or is flat.
    """
    try:
        changed = path.stat().st_mtime
    except OSError as error:
        raise RobotError(f"{path}: cannot be read: {error.strerror}") from error
    hulls = _hulls(path, changed)
    return [kept(path, f"hull-{number}-of-{len(hulls)}", partial(_mesh, hull)) for number, hull in enumerate(hulls)]


@lru_cache(maxsize=32)
def _hulls(path: Path, changed: float) -> tuple[trimesh.Trimesh, ...]:
    del changed  # part of the key: a file that was written anew is read anew
    mesh = load(path)
    if not span_a_volume(mesh.vertices):
        raise RobotError(f"{path}: is flat: only a mesh with a volume can be collided with; use a thin box")
    whole = trimesh.Trimesh(mesh.vertices, mesh.faces, process=True)
    hull = whole.convex_hull
    slices = _slices(whole)
    convex = not slices or sum(each.volume for each in slices) * SLACK > hull.volume
    return (hull,) if convex else tuple(slices)


def _slices(mesh: trimesh.Trimesh) -> list[trimesh.Trimesh]:
    """Hulls of the slices of a mesh across its longest side."""
    axis = int(np.argmax(mesh.extents))
    corners: FloatArray = np.asarray(mesh.vertices)
    low, high = mesh.bounds[:, axis].tolist()
    bounds = np.linspace(low, high, CUTS + 1)
    cut = [_crossings(corners[mesh.edges_unique], axis, level) for level in bounds[1:-1]]
    cut = [np.zeros((0, 3)), *cut, np.zeros((0, 3))]
    found = []
    for number in range(CUTS):
        inside = (corners[:, axis] >= bounds[number]) & (corners[:, axis] <= bounds[number + 1])
        points = np.concatenate((corners[inside], cut[number], cut[number + 1]))
        if len(points) >= 4 and np.ptp(points, axis=0).min() > 1e-4:
            found.append(trimesh.convex.convex_hull(points))
    return found


def _crossings(edges: FloatArray, axis: int, level: float) -> FloatArray:
    """Where edges (n, 2, 3) cross a plane across an axis, (k, 3)."""
    start, end = edges[:, 0], edges[:, 1]
    crossing = (start[:, axis] < level) != (end[:, axis] < level)
    start, end = start[crossing], end[crossing]
    part = (level - start[:, axis]) / (end[:, axis] - start[:, axis])
    return np.asarray(start + part[:, None] * (end - start))


def _mesh(hull: trimesh.Trimesh) -> TriangleMesh:
    return TriangleMesh(np.asarray(hull.vertices), np.asarray(hull.faces, dtype=np.int32), None)
