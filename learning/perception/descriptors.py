"""Fast point feature histograms of the board's blocks: made once with Open3D and kept in `board_fpfh.json`.

To make the file again: `python -m learning.perception.descriptors`.
"""

import json
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from robots.pose import FloatArray, read_only
from twin.board import ALL_SHAPES, BLOCK
from twin.objects import board_model

DATA_FILE = "board_fpfh.json"
SAMPLES = 2000
"""Points sampled on a block's surface."""
NEIGHBOURHOOD = 0.4 * BLOCK
"""Radius around a point that its histogram describes [m]: wide enough to look around an edge from most of a face."""
SEED = 0


@cache
def board_descriptors() -> dict[str, FloatArray]:
    """Shape name to its FPFH, (33,), which sums to 1."""
    data = json.loads(files("learning.perception").joinpath(DATA_FILE).read_text(encoding="utf-8"))
    return {shape: read_only(bins) for shape, bins in data["fpfh"].items()}


def compute_descriptor(vertices: FloatArray, triangles: np.ndarray[tuple[int, int], np.dtype[np.int64]]) -> FloatArray:
    """FPFH (Rusu 2009) of a mesh, averaged over seeded sample points and normalised, (33,).

    Args:
        vertices: (V, 3) [m].
        triangles: Vertex indices, counter-clockwise from outside, (T, 3).
    """
    import open3d

    registration: Any = open3d.pipelines.registration  # its stubs ask for arguments that have defaults

    corners = vertices[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    rng = np.random.default_rng(SEED)
    chosen = rng.choice(len(triangles), SAMPLES, p=areas / areas.sum())
    u, v = rng.uniform(size=(2, SAMPLES, 1))
    u, v = np.where(u + v > 1.0, 1.0 - u, u), np.where(u + v > 1.0, 1.0 - v, v)  # fold the square to the triangle
    first, second, third = np.moveaxis(corners[chosen], 1, 0)
    points = first + u * (second - first) + v * (third - first)
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.normals = open3d.utility.Vector3dVector(normals[chosen] / areas[chosen, None])
    search = open3d.geometry.KDTreeSearchParamRadius(NEIGHBOURHOOD)
    histogram = np.asarray(registration.compute_fpfh_feature(cloud, search).data).mean(axis=1)
    return np.asarray(histogram / histogram.sum())


def block_mesh(shape: str) -> tuple[FloatArray, np.ndarray[tuple[int, int], np.dtype[np.int64]]]:
    """Vertices [m] and triangles of a block about its centre: its faces, the ridge of a prism along x."""
    if shape not in ("cube", "prism"):
        faces = board_model(shape, "red").visuals[0]
        return faces.vertices, faces.faces
    half = 0.5 * BLOCK
    low = [(x * half, y * half, -half) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    if shape == "cube":
        high = [(x, y, half) for x, y, _ in low]
        vertices = np.array(low + high)
        quads = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
        triangles = [(a, b, c) for a, b, c, _ in quads] + [(a, c, d) for a, _, c, d in quads]
    else:
        vertices = np.array([*low, (-half, 0.0, half), (half, 0.0, half)])
        triangles = [(2, 1, 0), (3, 2, 0), (0, 1, 5), (0, 5, 4), (2, 3, 4), (2, 4, 5), (1, 2, 5), (3, 0, 4)]
    return vertices, np.array(triangles, dtype=np.int64)


def make_data() -> str:
    """The text of the data file."""
    fpfh = {shape: [round(float(b), 6) for b in compute_descriptor(*block_mesh(shape))] for shape in ALL_SHAPES}
    return json.dumps({"samples": SAMPLES, "radius": NEIGHBOURHOOD, "seed": SEED, "fpfh": fpfh}, indent=1) + "\n"


if __name__ == "__main__":
    from pathlib import Path

    Path(__file__).with_name(DATA_FILE).write_text(make_data(), encoding="utf-8")
