"""Normals for drawing: smooth over round surfaces, sharp over edges."""

import numpy as np
from numpy.typing import NDArray

from robots.pose import FloatArray

CREASE = np.deg2rad(40.0)
"""Faces that meet at a larger angle [rad] are drawn with an edge between them."""


def shaded_corners(
    vertices: FloatArray, faces: NDArray[np.int32], colours: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, NDArray[np.int32]]:
    """Give every corner of every face a normal, splitting corners at edges.

    Args:
        vertices: Corners, (n, 3) [m].
        faces: Corner numbers, (m, 3).
        colours: Colour of each corner, (n, 3).

    Returns:
        Corners (k, 3), unit normals (k, 3), colours (k, 3) and faces (m, 3) in the order given.
    """
    corners = faces.reshape(-1)
    sides = vertices[faces]
    # Twice the area long: large faces weigh more in the mean.
    face_normals = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    lengths = np.linalg.norm(face_normals, axis=1, keepdims=True)
    units = face_normals / np.where(lengths > 0, lengths, 1.0)
    # Corners at the same place meet, whatever their numbers.
    place = np.unique(vertices, axis=0, return_inverse=True)[1].reshape(-1)[corners]
    order = np.argsort(place, kind="stable")
    counts = np.bincount(place)
    # All pairs of face corners at one place: each looks at all of its group.
    group_start = np.concatenate(([0], np.cumsum(counts)[:-1]))
    size = counts[place[order]]
    first = np.repeat(order, size)
    offset = np.arange(len(first)) - np.repeat(np.cumsum(size) - size, size)
    second = order[np.repeat(group_start[place[order]], size) + offset]
    smooth = np.einsum("ij,ij->i", units[first // 3], units[second // 3]) > np.cos(CREASE)
    smooth |= first == second
    first, second = first[smooth], second[smooth]
    normals = np.stack(
        [np.bincount(first, weights=face_normals[second // 3, axis], minlength=len(corners)) for axis in range(3)],
        axis=1,
    )
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.where(lengths > 0, normals / np.where(lengths > 0, lengths, 1.0), (0.0, 0.0, 1.0))
    # Corners that turned out the same are sent to the renderer once.
    key = np.column_stack((place, np.round(normals, 3), np.round(colours[corners], 4)))
    _, kept, renumbered = np.unique(key, axis=0, return_index=True, return_inverse=True)
    sources = corners[kept]
    return vertices[sources], np.asarray(normals[kept]), colours[sources], renumbered.reshape(-1, 3).astype(np.int32)
