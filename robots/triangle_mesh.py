"""A triangle mesh, and thinning it so that it draws fast and still looks the same."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from .pose import FloatArray, read_only

FEWEST_TRIANGLES = 12
"""Triangles that even the smallest part of a mesh keeps: a box's."""

_MERGE_WITHIN = 1e-5
"""Corners nearer than this part of the mesh's size are one: many files give every face corners of its own, and such
faces cannot be thinned."""
_MANY_COLOURS = 8
"""A mesh with more colours than this is thinned as one piece; its corners then take the nearest colour."""


@dataclass(frozen=True, slots=True)
class TriangleMesh:
    """A triangle mesh.

    Attributes:
        vertices: Corners, (n, 3) [m].
        faces: Corner numbers of each triangle, (m, 3).
        colours: Red, green and blue of each corner, (n, 3) in 0..1; None where the file gives none.
    """

    vertices: FloatArray
    faces: NDArray[np.int32]
    colours: FloatArray | None

    def __post_init__(self) -> None:
        """Freeze the arrays."""
        object.__setattr__(self, "vertices", read_only(self.vertices))
        faces = np.array(self.faces, dtype=np.int32)
        faces.setflags(write=False)
        object.__setattr__(self, "faces", faces)
        if self.colours is not None:
            object.__setattr__(self, "colours", read_only(self.colours))


def decimate(mesh: TriangleMesh, triangles: int) -> TriangleMesh:
    """Thin a mesh to about `triangles` triangles by quadric error (Garland & Heckbert 1997), colour by colour.

    Open3D's is used: at 700 triangles Baxter's meshes keep within 1 to 7 mm on average, where fast-simplification stops
    early on meshes of many pieces (pedestal: 1,500 triangles, 23 mm).
    """
    parts = _parts_by_colour(mesh)
    pieces = []
    for vertices, faces in parts:
        wanted = max(FEWEST_TRIANGLES, triangles * len(faces) // len(mesh.faces))
        pieces.append(_thin(*merge_corners(vertices, faces), wanted))
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    vertices = np.concatenate([vertices for vertices, _ in pieces])
    faces = np.concatenate([faces + start for (_, faces), start in zip(pieces, starts[:-1], strict=True)])
    if mesh.colours is None:
        return TriangleMesh(vertices, faces, None)
    if len(parts) > 1:
        shades = [np.tile(_first_colours(mesh)[0][i], (len(each), 1)) for i, (each, _) in enumerate(pieces)]
        return TriangleMesh(vertices, faces, np.concatenate(shades))
    return TriangleMesh(vertices, faces, mesh.colours[cKDTree(mesh.vertices).query(vertices)[1]])


def _first_colours(mesh: TriangleMesh) -> tuple[FloatArray, NDArray[np.int64]]:
    """The different colours (k, 3) of the faces' first corners, and which of them each face has, (m,)."""
    if mesh.colours is None:
        return np.zeros((1, 3)), np.zeros(len(mesh.faces), dtype=np.int64)
    shades, which = np.unique(mesh.colours[mesh.faces[:, 0]], axis=0, return_inverse=True)
    return shades, which.reshape(-1)


def _parts_by_colour(mesh: TriangleMesh) -> list[tuple[FloatArray, NDArray[np.int32]]]:
    """Corners and triangles of the parts of a mesh that have one colour each; one part where there are many colours."""
    shades, which = _first_colours(mesh)
    if len(shades) > _MANY_COLOURS:
        return [(mesh.vertices, mesh.faces)]
    return [(mesh.vertices, mesh.faces[which == index]) for index in range(len(shades))]


def _thin(vertices: FloatArray, faces: NDArray[np.int32], triangles: int) -> tuple[FloatArray, NDArray[np.int32]]:
    """Thin corners and faces to about a number of triangles."""
    if len(faces) <= triangles:
        return vertices, faces
    # Here and not above: loading Open3D takes a second, and a filled cache does not need it.
    import open3d

    whole = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(faces))
    thin = whole.simplify_quadric_decimation(triangles)
    # Edge collapse stops early where surfaces cross themselves; a grid that grows coarser always arrives.
    cell = float(np.ptp(vertices, axis=0).max()) / 200
    while len(thin.triangles) > 1.1 * triangles:
        thin = whole.simplify_vertex_clustering(cell)
        cell *= 1.25
    thin.remove_degenerate_triangles()
    thin.remove_unreferenced_vertices()
    return np.asarray(thin.vertices), np.asarray(thin.triangles).astype(np.int32)


def merge_corners(vertices: FloatArray, faces: NDArray[np.int32]) -> tuple[FloatArray, NDArray[np.int32]]:
    """Make corners at the same place one; drop triangles without area and corners without triangle."""
    used, first = np.unique(faces, return_inverse=True)
    corners = vertices[used]
    cell = _MERGE_WITHIN * max(float(np.ptp(corners, axis=0).max()), np.finfo(float).tiny)
    _, kept, inverse = np.unique(np.round(corners / cell), axis=0, return_index=True, return_inverse=True)
    joined = inverse.reshape(-1)[first.reshape(-1)].reshape(-1, 3)
    a, b, c = joined.T
    return corners[kept], joined[(a != b) & (b != c) & (a != c)].astype(np.int32)
