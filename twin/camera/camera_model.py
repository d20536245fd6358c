"""A pinhole camera and its depth sensor.

Pixel (u, v) counts columns from the left and rows from the top, and whole numbers are the centres of pixels: a point
(x, y, z) of the optical frame (x right, y down, z forward) is seen at u = fx x / z + cx, v = fy y / z + cy.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np

from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose

from ..errors import TwinError

Vector = Sequence[float] | FloatArray


@dataclass(frozen=True, slots=True)
class DepthSensor:
    """How far a depth sensor measures, and how finely.

    Attributes:
        nearest: Smallest depth that is measured [m].
        farthest: Largest depth that is measured [m].
        step: Distance of neighbouring measured depths at 1 m, growing with the square of depth [1/m]; 0 is continuous.
    """

    nearest: float
    farthest: float
    step: float

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            TwinError: The range is empty or the step negative.
        """
        if not 0 < self.nearest < self.farthest < np.inf:
            raise TwinError(
                f"a depth sensor needs 0 < nearest < farthest [m], got nearest={self.nearest}, farthest={self.farthest}"
            )
        if not 0 <= self.step < np.inf:
            raise TwinError(f"a depth sensor's step must be at least 0 [1/m], got {self.step}")


KINECT2_SENSOR = DepthSensor(0.5, 4.5, 0.0)
"""Time of flight: continuous depth."""
XTION_SENSOR = DepthSensor(0.5, 4.5, 2.85e-3)
"""Structured light: disparity in whole steps (Khoshelham & Elberink 2012: 2.85e-5 z² with z in cm)."""


@dataclass(frozen=True, slots=True)
class CameraModel:
    """Size and intrinsics of a camera without distortion.

    Attributes:
        width: Columns [pixel].
        height: Rows [pixel].
        fx: Focal length across [pixel].
        fy: Focal length down [pixel].
        cx: Column of the optical axis [pixel].
        cy: Row of the optical axis [pixel].
        near: Nothing nearer is drawn [m].
        far: Nothing farther is drawn [m].
        sensor: What `kinect_noise` makes of the depth.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    near: float = 0.05
    far: float = 10.0
    sensor: DepthSensor = KINECT2_SENSOR

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            TwinError: A size is no positive whole number, a focal length is not positive, or near is not before far.
        """
        for name in ("width", "height"):
            value = getattr(self, name)
            if not isinstance(value, int) or not 1 <= value <= 8192:
                raise TwinError(f"camera {name} must be a whole number of pixels in 1..8192, got {value!r}")
        for name in ("fx", "fy"):
            if not 0 < getattr(self, name) < np.inf:
                raise TwinError(f"camera {name} must be a positive number of pixels, got {getattr(self, name)}")
        if not (np.isfinite(self.cx) and np.isfinite(self.cy)):
            raise TwinError(f"camera cx and cy must be finite numbers of pixels, got {self.cx}, {self.cy}")
        if not 0 < self.near < self.far < np.inf:
            raise TwinError(f"a camera needs 0 < near < far [m], got near={self.near}, far={self.far}")

    @classmethod
    def kinect2(cls, width: int = 320, height: int = 240) -> Self:
        """A Kinect v2's depth camera (512 x 424, 365.5 pixel focal length, 70.6° across), scaled to a width.

        Another proportion than 512:424 cuts rows at top and bottom, or shows more of them.
        """
        return cls._scaled(512, 365.5, width, height, KINECT2_SENSOR)

    @classmethod
    def xtion(cls, width: int = 320, height: int = 240) -> Self:
        """An Asus Xtion or Kinect v1 (640 x 480, 525 pixel focal length, 62.7° across), scaled to a width."""
        return cls._scaled(640, 525.0, width, height, XTION_SENSOR)

    @classmethod
    def _scaled(cls, full_width: int, focal: float, width: int, height: int, sensor: DepthSensor) -> Self:
        """Square pixels, the axis in the middle of the picture."""
        scaled = focal * width / full_width
        return cls(width, height, scaled, scaled, (width - 1) / 2, (height - 1) / 2, sensor=sensor)

    def resized(self, width: int, height: int) -> "CameraModel":
        """The same view with another number of pixels (intrinsics scaled about the picture's corner)."""
        across, down = width / self.width, height / self.height
        return CameraModel(
            width,
            height,
            self.fx * across,
            self.fy * down,
            (self.cx + 0.5) * across - 0.5,
            (self.cy + 0.5) * down - 0.5,
            self.near,
            self.far,
            self.sensor,
        )

    def project(self, points: FloatArray) -> FloatArray:
        """Pixels (n, 2), u then v, of points of the optical frame (n, 3) [m] in front of the camera."""
        x, y, z = np.asarray(points, dtype=float).T
        return np.stack((self.fx * x / z + self.cx, self.fy * y / z + self.cy), axis=1)

    def rays(self) -> FloatArray:
        """Points at depth 1 m that every pixel looks at, (height, width, 3) [m]; times depth gives the point cloud."""
        u, v = np.meshgrid(np.arange(self.width), np.arange(self.height))
        return np.stack(((u - self.cx) / self.fx, (v - self.cy) / self.fy, np.ones(u.shape)), axis=2)

    def clip_matrix(self) -> FloatArray:
        """Projection from the optical frame to clip space, (4, 4); top row at y = -1, near at z = -1."""
        depth = self.far - self.near
        return np.array(
            [
                [2 * self.fx / self.width, 0, (2 * self.cx + 1) / self.width - 1, 0],
                [0, 2 * self.fy / self.height, (2 * self.cy + 1) / self.height - 1, 0],
                [0, 0, (self.far + self.near) / depth, -2 * self.far * self.near / depth],
                [0, 0, 1, 0],
            ]
        )


def looking_at(eye: Vector, target: Vector, up: Vector = (0.0, 0.0, 1.0)) -> Pose:
    """Pose of an optical frame that looks from a point at another.

    Args:
        eye: Where the camera is, (3,) [m].
        target: What is in the middle of the picture, (3,) [m].
        up: Direction that points up in the picture, (3,).

    Raises:
        TwinError: The points are the same, or the camera would look along `up`.
    """
    at = np.asarray(eye, dtype=float)
    forward = np.asarray(target, dtype=float) - at
    right = np.cross(forward, np.asarray(up, dtype=float))
    if not np.linalg.norm(right) > 1e-9:
        raise TwinError(f"a camera at {list(eye)} cannot look at {list(target)} with up {list(up)}: give another")
    forward, right = forward / np.linalg.norm(forward), right / np.linalg.norm(right)
    return Pose(at, quaternion_xyzw(np.stack((right, np.cross(forward, right), forward), axis=1)))


def pose_matrix(pose: Pose) -> FloatArray:
    """Homogeneous matrix (4, 4) of a pose."""
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_matrix(pose.orientation_xyzw)
    matrix[:3, 3] = pose.position
    return matrix
