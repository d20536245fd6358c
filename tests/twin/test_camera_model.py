"""Camera models: intrinsics, poses, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.kinematics import rotation_matrix
from twin import TwinError
from twin.camera import CameraModel, DepthSensor, Drawable, SceneGeometry, looking_at
from twin.errors import SceneError

TRIANGLE = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])


def test_kinect2_and_xtion_have_their_published_field_of_view() -> None:
    for camera, degrees in (
        (CameraModel.kinect2(), 70.0),
        (CameraModel.kinect2(640, 480), 70.0),
        (CameraModel.xtion(), 62.7),
        (CameraModel.xtion(640, 480), 62.7),
    ):
        # The makers round to a degree.
        assert np.degrees(2 * np.arctan(camera.width / 2 / camera.fx)) == pytest.approx(degrees, abs=0.5)
        assert camera.fx == camera.fy
        assert camera.cx == (camera.width - 1) / 2
    assert CameraModel.xtion(640, 480).fx == 525.0
    assert CameraModel.xtion().sensor.step > 0 == CameraModel.kinect2().sensor.step


@given(st.integers(2, 500), st.integers(2, 500), st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_a_resized_camera_sees_the_same_at_the_same_place(width: int, height: int, x: float, y: float) -> None:
    camera = CameraModel(320, 240, 300.0, 290.0, 150.0, 130.0)
    point = np.array([[x, y, 1.0]])
    whole, resized = camera.project(point)[0], camera.resized(width, height).project(point)[0]
    # Pixel centres are whole numbers, so that the picture's corner is at -0.5.
    np.testing.assert_allclose((resized + 0.5) / (width, height), (whole + 0.5) / (320, 240), atol=1e-9)


def test_rays_and_projection_undo_each_other() -> None:
    camera = CameraModel(5, 4, 7.0, 8.0, 1.0, 2.5)
    u, v = np.meshgrid(np.arange(5.0), np.arange(4.0))
    pixels = camera.project(3.0 * camera.rays().reshape(-1, 3))
    np.testing.assert_allclose(pixels, np.stack((u.ravel(), v.ravel()), axis=1), atol=1e-12)


def test_looking_at_puts_the_target_in_front_and_up_at_the_top() -> None:
    pose = looking_at((1.0, 2.0, 3.0), (1.0, 5.0, 3.0))
    np.testing.assert_allclose(rotation_matrix(pose.orientation_xyzw).T, [[1, 0, 0], [0, 0, -1], [0, 1, 0]], atol=1e-12)
    for target in ((1.0, 2.0, 3.0), (1.0, 2.0, 0.0)):
        with pytest.raises(TwinError, match="cannot look at"):
            looking_at((1.0, 2.0, 3.0), target)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((0, 240, 300, 300, 1, 1), "width must be a whole number of pixels in 1..8192, got 0"),
        ((320, 2.5, 300, 300, 1, 1), "height must be a whole number"),
        ((320, 240, -1.0, 300, 1, 1), "fx must be a positive number"),
        ((320, 240, 300, float("nan"), 1, 1), "fy must be a positive number"),
        ((320, 240, 300, 300, float("inf"), 1), "cx and cy must be finite"),
        ((320, 240, 300, 300, 1, 1, 2.0, 1.0), "0 < near < far"),
    ],
)
def test_impossible_cameras_are_refused(values: tuple[float, ...], message: str) -> None:
    with pytest.raises(TwinError, match=message):
        CameraModel(*values)  # type: ignore[arg-type]


def test_impossible_sensors_are_refused() -> None:
    with pytest.raises(TwinError, match="0 < nearest < farthest"):
        DepthSensor(2.0, 1.0, 0.0)
    with pytest.raises(TwinError, match="step must be at least 0"):
        DepthSensor(1.0, 2.0, -1.0)


@pytest.mark.parametrize(
    ("identity", "vertices", "faces", "rgb", "message"),
    [
        (-1, TRIANGLE, [[0, 1, 2]], (1, 0, 0), "drawable -1: id must be"),
        (5, TRIANGLE[:, :2], [[0, 1, 2]], (1, 0, 0), r"drawable 5: vertices must be finite and \(n, 3\)"),
        (5, TRIANGLE * np.nan, [[0, 1, 2]], (1, 0, 0), "drawable 5: vertices must be finite"),
        (5, TRIANGLE, np.zeros((0, 3)), (1, 0, 0), r"faces must be \(m, 3\) with m > 0"),
        (5, TRIANGLE, [[0, 1, 3]], (1, 0, 0), r"corners 0\.\.2, got 0\.\.3"),
        (5, TRIANGLE, [[0, 1, 2]], (255, 0, 0), r"in 0\.\.1"),
        (5, TRIANGLE, [[0, 1, 2]], (1, 0), r"rgb must be \(3,\)"),
    ],
)
def test_impossible_drawables_are_refused(
    identity: int, vertices: object, faces: object, rgb: object, message: str
) -> None:
    with pytest.raises(SceneError, match=message):
        Drawable(identity, vertices, faces, rgb)  # type: ignore[arg-type]


def test_an_empty_scene_is_refused() -> None:
    with pytest.raises(SceneError, match="at least one drawable"):
        SceneGeometry(())
