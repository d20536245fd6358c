"""The table: its plane, found once with Open3D, its colour and its outline, and what lies on it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from learning.perception.pixel_kernel import FOUND, NOTHING, sort_pixels
from learning.perception.robot_eye import Look
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray, Pose
from twin.camera.camera_model import CameraModel
from twin.camera.noise import axial_sigma

_STRIDE = 4
"""Every so many rows and columns are looked at to find planes."""
_PLANES = 5
"""Planes that are taken out of the picture one after the other, at most."""
_ROUNDS = 200
"""RANSAC rounds a plane."""
_WITHIN = 0.008
"""Distance from a plane that belongs to it [m]: three standard deviations of depth at 1.2 m, seen aslant."""
_SLOPE_STEP, _HEIGHT_STEP = 0.02, 0.01
"""To what a found plane's slopes and height [m] are rounded,"""
_ROUNDED_WITHIN = (0.03, 0.015, _WITHIN, _WITHIN)
"""and distances [m] from it that belong to it then, until it fits."""
_LEAST_SHARE = 0.06
"""Least part of the measured pixels that a table fills."""
_UPRIGHT = 0.985
"""Cosine of the largest tilt of a table: 10 degrees."""
_SIGMAS = 4.0
"""Standard deviations of depth above the plane that are no noise: a pixel in thirty thousand."""
_LEAST_HEIGHT = 0.005
"""Nothing lower stands out by its height [m]; colour may tell it."""
_HIGHEST = 0.70
"""Nothing higher above the table is looked at [m]."""
_COLOUR_SIGMA = 2.5
"""Least standard deviation of a channel of the table's colour."""
_COLOUR_LIMIT = 25.0
"""Squared Mahalanobis distance from the table's colour that is another colour: a pixel in sixty thousand."""
_RIM = 0.015
"""Colour is not trusted nearer than this to the table's edge [m]."""
_AROUND = 0.15
"""How far outside the table's outline things may be held [m]."""
_BEFORE_BODY = 0.02
"""What is measured nearer than the robot's own body by more than this is before it [m]."""
_LIMITS = np.array([_COLOUR_LIMIT, _HIGHEST, _BEFORE_BODY])


@dataclass(frozen=True, slots=True)
class Table:
    """A table as it was seen.

    Attributes:
        normal: Upwards, (3,), in the world.
        offset: normal . p + offset is the height of a point p above the table [m].
        colour: Mean red, green, blue, (3,) of 255.
        precision: Inverse covariance of its colour, (3, 3).
        outline: Half-planes a x + b y <= c of the convex outline seen, (E, 3), in the world.
    """

    normal: FloatArray
    offset: float
    colour: FloatArray
    precision: FloatArray
    outline: FloatArray

    def heights(self, points: FloatArray) -> FloatArray:
        """Heights (n,) above the table of points (n, 3) [m]."""
        return np.asarray(points @ self.normal + self.offset)


def find_table(looks: list[Look], camera: CameraModel, rng: np.random.Generator) -> Table:
    """Find the table in the first pictures of a demo: the highest large level plane that is not the robot.

    Args:
        looks: At least one picture.
        camera: The camera.
        rng: Source of RANSAC's choices.

    Raises:
        PerceptionError: No picture shows a level plane.
    """
    import open3d

    open3d.utility.random.seed(int(rng.integers(2**31)))
    look = looks[0]
    shown = (look.depth > 0) & (look.body == 0)
    sparse = np.zeros_like(shown)
    sparse[::_STRIDE, ::_STRIDE] = True
    points, _ = world_points(look, camera, shown & sparse)
    total = len(points)
    best: tuple[FloatArray, FloatArray] | None = None
    for _ in range(_PLANES):
        if len(points) < max(50, _LEAST_SHARE * total):
            break
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        plane, inliers = cloud.segment_plane(_WITHIN, 3, _ROUNDS)
        plane = np.asarray(plane) * np.sign(plane[2] or 1.0) / np.linalg.norm(plane[:3])
        if plane[2] > _UPRIGHT and len(inliers) >= _LEAST_SHARE * total:
            middle = np.median(points[np.asarray(inliers)], axis=0)
            if best is None or middle @ best[0][:3] + best[0][3] > _WITHIN:
                best = plane, middle
        points = np.delete(points, np.asarray(inliers), axis=0)
    if best is None:
        raise PerceptionError(
            f"no table in sight: no level plane fills {_LEAST_SHARE:.0%} of the first picture "
            f"({total * _STRIDE**2} pixels measured something); is the camera covered or turned away?"
        )
    return _described(*best, looks, camera)


def _described(plane: FloatArray, middle: FloatArray, looks: list[Look], camera: CameraModel) -> Table:
    """Fit the plane to all its pixels by least squares, and learn its colour and outline.

    Open3D's RANSAC works in threads, and what it finds differs a little from time to time. It is rounded, and the fit
    goes on from there, so that the table does not depend on that.
    """
    from scipy.spatial import ConvexHull

    clouds, colours = [], []
    for look in looks:
        shown = (look.depth > 0) & (look.body == 0)
        points, pixels = world_points(look, camera, shown)
        clouds.append(points)
        colours.append(look.colour.reshape(-1, 3)[pixels].astype(float))
    cloud, colour = np.concatenate(clouds), np.concatenate(colours)
    # z = a x + b y + c, as the plane is level
    a, b = np.round(-plane[:2] / plane[2] / _SLOPE_STEP) * _SLOPE_STEP
    x, y, z = np.round(middle / _HEIGHT_STEP) * _HEIGHT_STEP
    c = z - a * x - b * y
    for within in _ROUNDED_WITHIN:
        near = np.abs(cloud[:, 2] - a * cloud[:, 0] - b * cloud[:, 1] - c) < within
        design = np.column_stack((cloud[near, :2], np.ones(int(near.sum()))))
        a, b, c = np.linalg.lstsq(design, cloud[near, 2], rcond=None)[0]
    cloud, colour = cloud[near], colour[near]
    length = float(np.sqrt(a * a + b * b + 1.0))
    typical = np.median(colour, axis=0)
    alike = colour[np.abs(colour - typical).max(axis=1) < 30.0]
    covariance = np.cov(alike.T) + 1e-6 * np.eye(3)
    values, vectors = np.linalg.eigh(covariance)
    precision = (vectors / np.maximum(values, _COLOUR_SIGMA**2)) @ vectors.T
    hull = ConvexHull(_without_strays(cloud[:, :2]))
    equations = hull.equations  # a x + b y + c <= 0 inside, (a, b) of length 1
    outline = np.column_stack((equations[:, :2], -equations[:, 2]))
    return Table(np.array([-a, -b, 1.0]) / length, -float(c) / length, alike.mean(axis=0), precision, outline)


def _without_strays(points: FloatArray) -> FloatArray:
    """Points (n, 2) whose cell of 2 cm holds many: pixels that fly off an edge are few."""
    cells = np.floor(points / 0.02).astype(np.int64)
    _, which, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    enough = counts[which.reshape(-1)] >= max(4, 0.25 * float(np.median(counts)))
    return points[enough] if enough.sum() >= 10 else points


def world_points(look: Look, camera: CameraModel, mask: NDArray[np.bool_]) -> tuple[FloatArray, NDArray[np.int64]]:
    """Points (n, 3) [m] in the world of the masked pixels, and their numbers in the picture, (n,)."""
    pixels = np.flatnonzero(mask)
    z = look.depth.reshape(-1)[pixels].astype(float)
    rows, columns = np.divmod(pixels, camera.width)
    seen = np.column_stack(((columns - camera.cx) / camera.fx * z, (rows - camera.cy) / camera.fy * z, z))
    pose = look.pose_camera_in_world
    return seen @ rotation_matrix(pose.orientation_xyzw).T + pose.position, pixels


class TableView:
    """A table from one place of the camera: what is worked out once while the camera stands still.

    Attributes:
        pose_camera_in_world: From where.
        on_table: Pixels whose line of sight meets the table inside its outline, (height, width).
    """

    def __init__(self, table: Table, camera: CameraModel, pose_camera_in_world: Pose) -> None:
        """Work out heights a metre of depth, noise and outline."""
        self.pose_camera_in_world = pose_camera_in_world
        self._table = table
        self._turn = rotation_matrix(pose_camera_in_world.orientation_xyzw)
        rays = camera.rays() @ self._turn.T
        self._rays = rays
        slope = rays @ table.normal
        self._slope = slope.astype(np.float32)
        self._base = np.float32(table.normal @ pose_camera_in_world.position + table.offset)
        with np.errstate(divide="ignore"):
            reach = np.where(slope < 0, -self._base / slope, np.inf)
        usual = np.clip(reach, 0.3, 3.0).astype(np.float32)
        # Seen aslant by the angle between the line of sight and the plane's normal.
        angle = np.arccos(np.clip(-slope / np.linalg.norm(rays, axis=2), 0.05, 1.0)).astype(np.float32)
        noise = np.abs(self._slope) * axial_sigma(usual, angle)
        self._threshold = np.maximum(_SIGMAS * noise, np.float32(_LEAST_HEIGHT)).astype(np.float32)
        meets = np.isfinite(reach)
        reached = rays[..., :2] * np.where(meets, reach, 0.0)[..., None] + pose_camera_in_world.position[:2]
        self.on_table = meets & (self._inside(reached.reshape(-1, 2), -_RIM).reshape(reach.shape))

    def sort(self, look: Look) -> NDArray[np.uint8]:
        """What each pixel shows, (height, width): `FOUND` where something stands out from the table, or `ROBOT`.

        The robot's own body is where its joints say, unless something is measured clearly before it.
        """
        kinds = sort_pixels(
            look.colour, look.depth, look.body, self._slope, float(self._base), self._threshold, self.on_table,
            self._table.colour, self._table.precision, _LIMITS,
        )  # fmt: skip
        # What is held may stick out beyond the table a little; the rest of the room is no matter.
        pixels = np.flatnonzero((kinds == FOUND) & ~self.on_table)
        if len(pixels):
            depth = look.depth.reshape(-1)[pixels].astype(float)
            places = self._rays.reshape(-1, 3)[pixels, :2] * depth[:, None] + self.pose_camera_in_world.position[:2]
            kinds.reshape(-1)[pixels[~self._inside(places, _AROUND)]] = NOTHING
        return kinds

    def points_at(self, depth: FloatArray, pixels: NDArray[np.int64]) -> FloatArray:
        """Points (n, 3) [m] in the world of pixels (n,) with given depths (n,) [m]."""
        rays = self._rays.reshape(-1, 3)[pixels]
        return np.asarray(rays * depth[:, None] + self.pose_camera_in_world.position)

    def _inside(self, places: FloatArray, margin: float) -> NDArray[np.bool_]:
        """Whether places (n, 2) [m] are inside the outline grown by a margin [m]."""
        outline = self._table.outline
        inside = np.ones(len(places), dtype=bool)
        for a, b, c in outline:
            inside &= a * places[:, 0] + b * places[:, 1] <= c + margin
        return inside
