"""What a thing's surface is like: the mean fast point feature histogram of the side of it that is seen."""

from typing import Any

import numpy as np

from learning.perception.height_slices import height_weights
from robots.pose import FloatArray

BINS = 33
NORMALS_WITHIN = 0.014
"""Radius in which a normal is fitted [m]: about nine pixels at 1 m."""
DESCRIBED_WITHIN = 0.028
"""Radius around a point that its histogram describes [m]: most of a cube, an edge of a bowl."""
LEAST_POINTS = 8
"""Fewer points have no shape."""
MOST_POINTS = 250
"""More points are thinned out: time grows with their square."""


def shape_histogram(points: FloatArray, eye: FloatArray) -> FloatArray | None:
    """FPFH (Rusu 2009) averaged over points, (33,), which sums to 1; None where there are too few points.

    Every height counts alike, so that what a hand holds looks like what stands free (`height_weights`).

    Args:
        points: The seen side of a thing, (n, 3) [m].
        eye: Where the camera is, (3,) [m]: normals look towards it.
    """
    if len(points) < LEAST_POINTS:
        return None
    import open3d

    registration: Any = open3d.pipelines.registration  # its stubs ask for arguments that have defaults
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamRadius(NORMALS_WITHIN))
    cloud.orient_normals_towards_camera_location(eye)
    heights = points[:, 2]
    if len(points) > MOST_POINTS:
        thinned = np.linspace(0, len(points) - 1, MOST_POINTS).astype(int)
        cloud, heights = cloud.select_by_index(thinned.tolist()), heights[thinned]
    search = open3d.geometry.KDTreeSearchParamRadius(DESCRIBED_WITHIN)
    histograms = np.asarray(registration.compute_fpfh_feature(cloud, search).data)
    histogram = histograms @ height_weights(heights)
    total = float(histogram.sum())
    return np.asarray(histogram / total) if np.isfinite(total) and total > 0 else None
