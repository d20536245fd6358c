"""The noise of a depth camera has the size that was measured, and is where it belongs."""

import time

import numpy as np
import pytest
from numpy.typing import NDArray

from twin.camera import KINECT2_SENSOR, NOTHING, CameraModel, RgbdFrame, axial_sigma, kinect_noise
from twin.camera.noise import BLACK_HOLES, COLOUR_SIGMA, EDGE_HOLES

CAMERA = CameraModel.kinect2(320, 240)


def frame_of(depth: NDArray[np.float64], grey: int = 128) -> RgbdFrame:
    return RgbdFrame(
        np.full((*depth.shape, 3), grey, dtype=np.uint8),
        depth.astype(np.float32),
        np.where(depth > 0, 1, NOTHING).astype(np.int32),
    )


def plane(distance: float, angle: float = 0.0) -> NDArray[np.float64]:
    """Depth (height, width) of a plane through the axis, turned about the vertical [rad]."""
    normal = np.array([np.sin(angle), 0.0, np.cos(angle)])
    return np.asarray(distance * normal[2] / (CAMERA.rays() @ normal))


def middle(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """Where the view is along the axis, within 3°."""
    return image[110:130, 150:170]


@pytest.mark.parametrize("distance", [0.6, 1.0, 2.0, 3.5])
def test_depth_of_a_facing_wall_has_the_published_spread(distance: float) -> None:
    rng = np.random.default_rng(0)
    truth = plane(distance)
    errors = np.concatenate([(kinect_noise(frame_of(truth), rng, CAMERA).depth - truth).ravel() for _ in range(3)])
    assert np.isfinite(errors).all()
    inside = errors[np.abs(errors) < 0.5 * distance]
    assert len(inside) / len(errors) > 0.999, "a facing wall has no holes"
    middles = np.stack([middle(kinect_noise(frame_of(truth), rng, CAMERA).depth - truth) for _ in range(40)])
    # 16,000 draws: the spread is known to 0.6%, and within 3° the angle's part is below 1%.
    assert middles.std() == pytest.approx(0.0012 + 0.0019 * (distance - 0.4) ** 2, rel=0.025)
    assert abs(middles.mean()) < 4 * middles.std() / np.sqrt(middles.size)


def test_a_wall_at_right_angles_to_the_view_of_a_pixel_is_measured_there() -> None:
    # Single precision makes the cosine of one pixel of this wall a little more than 1.
    normal = np.array([np.sin(-0.32277326), np.sin(-0.11193327), 1.0])
    normal /= np.linalg.norm(normal)
    depth = 0.6572387461374283 / (CAMERA.rays() @ normal)
    measured = kinect_noise(frame_of(depth), np.random.default_rng(5), CAMERA).depth
    assert np.isfinite(measured).all()


@pytest.mark.parametrize("degrees", [30, 50, 62])
def test_a_slanted_wall_is_noisier_as_published(degrees: int) -> None:
    angle = np.deg2rad(degrees)
    rng = np.random.default_rng(1)
    truth = plane(1.5, angle)
    errors = np.stack([middle(kinect_noise(frame_of(truth), rng, CAMERA).depth - truth) for _ in range(60)])
    expected = 0.0012 + 0.0019 * 1.1**2 + 0.0001 / np.sqrt(1.5) * (angle / (np.pi / 2 - angle)) ** 2
    # Over the middle, depth and angle change by 3°, which matters more the steeper the wall.
    assert errors.std() == pytest.approx(expected, rel=0.05)
    assert axial_sigma(np.float32([1.5]), np.float32([angle]))[0] == pytest.approx(expected, rel=1e-5)


def test_structured_light_measures_in_steps() -> None:
    camera = CameraModel.xtion(320, 240)
    measured = kinect_noise(frame_of(np.full((240, 320), 3.0)), np.random.default_rng(0), camera).depth
    steps = np.unique(measured[measured > 0])
    # Khoshelham & Elberink: 2.85e-5 * 300² = 2.6 cm between neighbouring values at 3 m.
    near = steps[np.abs(steps - 3.0) < 0.1]
    np.testing.assert_allclose(np.diff(near), 2.85e-3 * 3.0**2, rtol=0.05)
    assert len(np.unique(kinect_noise(frame_of(plane(3.0)), np.random.default_rng(0), CAMERA).depth)) > 10_000


def test_nothing_is_measured_out_of_range() -> None:
    depth = np.full((240, 320), 1.0)
    depth[:, :100], depth[:, 220:] = 0.4, 5.0
    depth[:40] = 0.0
    measured = kinect_noise(frame_of(depth), np.random.default_rng(0), CAMERA).depth
    assert (measured[43:, :97] == 0).all()
    assert (measured[43:, 223:] == 0).all()
    assert (measured[:37] == 0).all()
    assert (measured[45:, 105:215] > 0.9).all()
    seen = measured[measured > 0]
    assert KINECT2_SENSOR.nearest <= seen.min() <= seen.max() <= KINECT2_SENSOR.farthest


def test_edges_are_ragged_and_have_holes_and_planes_have_none() -> None:
    depth = np.full((240, 320), 1.5)
    depth[:, 160:] = 1.0
    measured = kinect_noise(frame_of(depth), np.random.default_rng(3), CAMERA).depth
    at_edge = measured[:, 159:161]
    # 480 pixels: three standard deviations of the part of holes are 0.066.
    assert (at_edge == 0).mean() == pytest.approx(EDGE_HOLES, abs=0.066)
    swapped = (measured[:, 159] > 0) & (measured[:, 159] < 1.25)
    # Half a pixel beyond 0.5 of a 0.8 pixel spread: 27% of those measured see the other side.
    assert 0.15 < swapped.sum() / (measured[:, 159] > 0).sum() < 0.4
    assert (np.abs(measured[:, :157] - 1.5) < 0.05).all()
    assert (np.abs(measured[:, 163:] - 1.0) < 0.05).all()
    steep = kinect_noise(frame_of(plane(1.5, np.deg2rad(60))), np.random.default_rng(3), CAMERA).depth
    assert (middle(steep) > 0).all(), "a steep plane is not an edge"


def test_grazing_and_black_surfaces_have_holes() -> None:
    grazing = kinect_noise(frame_of(plane(1.5, np.deg2rad(82))), np.random.default_rng(0), CAMERA).depth
    assert (grazing[110:130, 159:161] == 0).all()
    black = kinect_noise(frame_of(plane(1.5), grey=5), np.random.default_rng(0), CAMERA).depth
    # 76,800 pixels: three standard deviations are 0.005.
    assert (black == 0).mean() == pytest.approx(BLACK_HOLES, abs=0.006)


def test_colour_has_a_small_spread_and_stays_in_range() -> None:
    noisy = kinect_noise(frame_of(plane(1.5)), np.random.default_rng(0), CAMERA).colour.astype(float)
    # 230,400 draws: the spread is known to 0.15%; it is made in whole steps.
    assert noisy.std() == pytest.approx(COLOUR_SIGMA, rel=0.02)
    assert noisy.mean() == pytest.approx(128, abs=0.02)
    for grey in (0, 255):
        ends = kinect_noise(frame_of(plane(1.5), grey), np.random.default_rng(0), CAMERA).colour
        assert np.abs(ends.astype(int) - grey).max() < 10, "no channel runs over"


def test_the_same_generator_gives_the_same_frame_and_the_frame_is_not_touched() -> None:
    frame = frame_of(plane(1.5))
    first, second = (kinect_noise(frame, np.random.default_rng(4), CAMERA) for _ in range(2))
    np.testing.assert_array_equal(first.depth, second.depth)
    np.testing.assert_array_equal(first.colour, second.colour)
    np.testing.assert_array_equal(first.mask, frame.mask)
    np.testing.assert_array_equal(frame.depth, plane(1.5).astype(np.float32))


def test_it_is_cheap() -> None:
    frame = frame_of(plane(1.5, 0.5))
    rng = np.random.default_rng(0)
    times = []
    for _ in range(10):
        began = time.process_time()
        kinect_noise(frame, rng, CAMERA)
        times.append(time.process_time() - began)
    # 3 ms on a quiet core; a busy machine may be four times slower.
    assert min(times) < 0.012
