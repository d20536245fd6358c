"""What a depth camera does to a picture: noise, steps, ragged edges and holes.

Axial and lateral noise as Nguyen, Izadi & Lovell (2012) measured them on a Kinect, steps of structured light as in
Khoshelham & Elberink (2012).
"""

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from .camera_model import CameraModel
from .frame import RgbdFrame

STEEPEST = np.deg2rad(80.0)
"""Angle [rad] between surface and view beyond which nothing is measured; holes begin 15° before."""
_HOLES_FROM = np.deg2rad(65.0)
_COS_HOLES, _COS_STEEPEST = float(np.cos(_HOLES_FROM)), float(np.cos(STEEPEST))
EDGE = 0.03
"""Step between neighbouring pixels, as part of depth and beside what the slope explains, that counts as an edge."""
EDGE_HOLES = 0.35
"""Part of the pixels at edges that measure nothing."""
BLACK = 0.06
"""Mean of red, green and blue below which a surface gives back too little light."""
BLACK_HOLES = 0.5
"""Part of the pixels of black surfaces that measure nothing."""
LATERAL_SIGMA = 0.8
"""Lateral noise [pixel] of a surface seen straight (Nguyen et al., section 3)."""
COLOUR_SIGMA = 2.0
"""Noise of each colour channel, of 255."""

# The inverse of the normal distribution at 256 levels, scaled so that its standard deviation is exactly sigma: a random
# byte is ten times cheaper than a normal draw.
_LEVELS = ndtri((np.arange(256) + 0.5) / 256)
_COLOUR_STEPS = np.round(np.sqrt(COLOUR_SIGMA**2 - 1 / 12) * _LEVELS / _LEVELS.std()).astype(np.int16)
"""Rounding to whole steps adds a twelfth to the variance, which is taken away first."""
_LATERAL_STEPS = np.clip(np.round(LATERAL_SIGMA * _LEVELS), -2, 2).astype(np.int32)


def axial_sigma(depth: NDArray[np.float32], angle: NDArray[np.float32]) -> NDArray[np.float32]:
    """Standard deviation of measured depth [m] (Nguyen et al., eq. 4 and 5).

    Args:
        depth: Depth, above 0 [m].
        angle: Angle between the surface's normal and the direction to the camera, 0 .. below π/2 [rad].
    """
    level = 0.0012 + 0.0019 * (depth - 0.4) ** 2
    return np.asarray(level + 0.0001 / np.sqrt(depth) * (angle / (np.pi / 2 - angle)) ** 2, dtype=np.float32)


def kinect_noise(frame: RgbdFrame, rng: np.random.Generator, camera: CameraModel) -> RgbdFrame:
    """Spoil a frame.

    Args:
        frame: A frame as rendered with this camera.
        rng: Source of all randomness.
        camera: The camera; its sensor gives range and steps.

    Returns:
        A frame with noisy colour, depth with noise and holes (0), and the same mask.
    """
    z = frame.depth
    shape = z.shape
    seen = z > 0
    safe = np.where(seen, z, np.float32(1.0))
    cosine, edge = _surface(np.where(seen, np.float32(1.0) / safe, np.float32(0.0)), camera)
    # At edges a pixel measures what a neighbour up to two pixels away should see.
    rows, columns = np.nonzero(edge)
    count = len(rows)
    draws = np.frombuffer(rng.bytes(4 * count), dtype=np.uint8).reshape(4, count)
    from_row = np.clip(rows + _LATERAL_STEPS[draws[0]], 0, shape[0] - 1)
    from_column = np.clip(columns + _LATERAL_STEPS[draws[1]], 0, shape[1] - 1)
    measured = z.copy()
    measured[rows, columns] = z[from_row, from_column]
    # Beyond 80° nothing is measured, so that the formula's pole is never met; rounding may leave a cosine above 1.
    angle = np.arccos(np.clip(cosine, np.float32(_COS_STEEPEST), np.float32(1.0)))
    measured += axial_sigma(safe, angle) * rng.standard_normal(shape, dtype=np.float32)
    sensor = camera.sensor
    if sensor.step > 0:
        # Whole steps of 1 / depth are what whole steps of disparity are.
        disparity = np.maximum(np.round(1.0 / (sensor.step * np.maximum(measured, np.float32(1e-3)))), 1.0)
        measured = (1.0 / (sensor.step * disparity)).astype(np.float32)
    chance = np.clip((_COS_HOLES - cosine) / np.float32(_COS_HOLES - _COS_STEEPEST), 0.0, 1.0)
    red, green, blue = np.moveaxis(frame.colour, 2, 0)
    dark = np.add(red, green, dtype=np.uint16) + blue < 3 * 255 * BLACK
    chance[dark] = np.maximum(chance[dark], BLACK_HOLES)
    chance[rows, columns] = np.maximum(chance[rows, columns], EDGE_HOLES)
    lost = rng.random(shape, dtype=np.float32) < chance
    measured[lost | (measured < sensor.nearest) | (measured > sensor.farthest)] = 0.0
    colour = _COLOUR_STEPS.take(np.frombuffer(rng.bytes(frame.colour.size), dtype=np.uint8)).reshape(frame.colour.shape)
    colour += frame.colour
    np.clip(colour, 0, 255, out=colour)
    return RgbdFrame(colour.astype(np.uint8), measured, frame.mask)


def _surface(inverse: NDArray[np.float32], camera: CameraModel) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Cosine of the angle between each pixel's surface and its view, and where depth jumps.

    The inverse of depth is linear over the picture of a plane: its slope gives the plane, and where it bends by much
    there is an edge, however steep the plane.

    Args:
        inverse: 1 / depth, (height, width) [1/m]; 0 where nothing is.
        camera: The camera.
    """
    slopes, edge = [], np.zeros(inverse.shape, dtype=bool)
    bend_limit = np.float32(EDGE) * inverse
    for axis in (0, 1):
        step = np.diff(inverse, axis=axis)
        first, last = np.take(step, [0], axis), np.take(step, [-1], axis)
        before, after = np.concatenate((first, step), axis), np.concatenate((step, last), axis)
        edge |= np.abs(after - before) > bend_limit
        # The smaller of both, so that a pixel at an edge takes the slope of its own surface.
        slopes.append(np.where(np.abs(before) < np.abs(after), before, after))
    down, across = slopes
    v = (np.arange(camera.height, dtype=np.float32) - np.float32(camera.cy))[:, None]
    u = (np.arange(camera.width, dtype=np.float32) - np.float32(camera.cx))[None, :]
    # The plane n . p = 1 through a pixel has n . ray = 1 / depth.
    normal_z = inverse - u * across - v * down
    length = np.sqrt((np.float32(camera.fx) * across) ** 2 + (np.float32(camera.fy) * down) ** 2 + normal_z**2)
    ray = np.sqrt((u / np.float32(camera.fx)) ** 2 + (v / np.float32(camera.fy)) ** 2 + 1)
    return inverse / np.maximum(length * ray, np.float32(1e-12)), edge
