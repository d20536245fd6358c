"""What a thing's surface is like: the mean fast point feature histogram of the side of it that is seen."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from learning.perception.table import TableView
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
FRAMES = 8
"""Frames of a demo at which a thing's shape is measured."""
STEADIED = 5
"""Frames before and after each that are averaged where the thing rests: noise of depth falls to a third."""
SAME_PLACE = 0.004
"""A thing that moved less rests [m]."""


@dataclass(frozen=True, slots=True)
class WholeView:
    """A thing seen whole.

    Attributes:
        frame: When.
        centre: Where its middle was, (3,) [m].
        pixels: Numbers of its measured pixels, (m,).
        depth: Their depths, (m,) [m].
        view: The table from where the camera was.
    """

    frame: int
    centre: FloatArray
    pixels: NDArray[np.int64]
    depth: FloatArray
    view: TableView


def shape_histogram(points: FloatArray, eye: FloatArray) -> FloatArray | None:
    """FPFH (Rusu 2009) averaged over points, (33,), which sums to 1; None where there are too few points.

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
    if len(points) > MOST_POINTS:
        cloud = cloud.select_by_index(np.linspace(0, len(points) - 1, MOST_POINTS).astype(int).tolist())
    search = open3d.geometry.KDTreeSearchParamRadius(DESCRIBED_WITHIN)
    histogram = np.asarray(registration.compute_fpfh_feature(cloud, search).data).mean(axis=1)
    total = float(histogram.sum())
    return np.asarray(histogram / total) if np.isfinite(total) and total > 0 else None


def shapes_over_time(views: Sequence[WholeView], frames: int) -> FloatArray:
    """A thing's shape at every frame, (F, 33): measured at a few frames spread over the demo, else the nearest's.

    Args:
        views: Where it was seen whole, in order.
        frames: How many frames there are, F.

    Returns:
        The histograms; a level one where it was never seen whole.
    """
    resting = [each for each in range(len(views)) if _rests(views, each)] or list(range(len(views)))
    count = min(FRAMES, len(resting))
    chosen = (
        [resting[int(each)] for each in np.unique(np.linspace(0, len(resting) - 1, count).round())] if count else []
    )
    found = []
    for number in chosen:
        histogram = shape_histogram(_steadied(views, number), views[number].view.pose_camera_in_world.position)
        if histogram is not None:
            found.append((views[number].frame, histogram))
    if not found:
        return np.full((frames, BINS), 1.0 / BINS)
    when = np.array([frame for frame, _ in found])
    nearest = np.abs(np.arange(frames)[:, None] - when).argmin(axis=1)
    return np.asarray(np.stack([histogram for _, histogram in found])[nearest])


def _rests(views: Sequence[WholeView], number: int) -> bool:
    """Whether the thing is where it is in the views just before and after."""
    here = views[number]
    beside = [each for each in views[max(number - 2, 0) : number + 3] if abs(each.frame - here.frame) <= 3]
    return len(beside) > 1 and all(np.abs(each.centre - here.centre).max() < SAME_PLACE for each in beside)


def _steadied(views: Sequence[WholeView], number: int) -> FloatArray:
    """Points (n, 3) [m] of a view, each pixel's depth averaged over the frames around while the thing rests."""
    here = views[number]
    around = [
        each
        for each in views[max(number - STEADIED, 0) : number + STEADIED + 1]
        if each.view is here.view and np.abs(each.centre - here.centre).max() < SAME_PLACE
    ]
    pixels = np.concatenate([each.pixels for each in around])
    depth = np.concatenate([each.depth for each in around])
    unique, which, counts = np.unique(pixels, return_inverse=True, return_counts=True)
    mean = np.bincount(which.reshape(-1), weights=depth) / counts
    often = counts >= 0.5 * len(around)
    return here.view.points_at(mean[often], unique[often])
