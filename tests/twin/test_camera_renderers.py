"""Both renderers: exact geometry, and the same picture."""

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import trimesh

from robots.pose import Pose
from twin import TwinError
from twin.camera import (
    NOTHING,
    CameraModel,
    Drawable,
    Renderer,
    RendererUnavailableError,
    SceneGeometry,
    looking_at,
    make_renderer,
)
from twin.camera.camera_model import pose_matrix
from twin.camera.renderer import BACKGROUND

from .camera_scenes import AT_TABLE, CAMERA, STRAIGHT, at, ball, box, table_poses, table_scene


@pytest.fixture(params=["gl", "tiny"])
def kind(request: pytest.FixtureRequest) -> str:
    """Every renderer; OpenGL is skipped on a machine without it."""
    if request.param == "gl":
        try:
            make_renderer(SceneGeometry((ball(0, 1.0, (1, 1, 1)),)), CAMERA, "gl").close()
        except RendererUnavailableError as error:
            pytest.skip(str(error))
    return str(request.param)


@pytest.fixture
def at_table(kind: str) -> Iterator[Renderer]:
    with make_renderer(table_scene(), CAMERA, kind) as renderer:
        yield renderer


def test_a_tilted_plane_has_its_exact_depth_in_every_pixel(kind: str) -> None:
    camera_pose = looking_at((0.3, -0.2, 1.0), (1.0, 0.5, 0.2))
    normal = np.array([0.5, -0.6, -1.0]) / np.linalg.norm([0.5, -0.6, -1.0])
    first = np.cross(normal, (1.0, 0.0, 0.0))
    second = np.cross(normal, first)
    middle = np.array([0.0, 0.0, 1.5])
    corners = np.array([middle + 3 * (s * first + t * second) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
    to_world = pose_matrix(camera_pose)
    plane = Drawable(7, corners @ to_world[:3, :3].T + to_world[:3, 3], [[0, 1, 2], [0, 2, 3]], (1, 0, 0), moving=False)
    with make_renderer(SceneGeometry((plane,)), CAMERA, kind) as renderer:
        frame = renderer.render(np.zeros((0, 4, 4)), camera_pose)
    expected = (normal @ middle) / (CAMERA.rays() @ normal)
    assert (frame.mask == 7).all()
    # Single precision; PyBullet's depth buffer goes through 1 / depth as well.
    np.testing.assert_allclose(frame.depth, expected, rtol=1e-6 if kind == "gl" else 1e-5)


def test_a_box_is_seen_in_the_pixels_that_its_face_projects_to(kind: str) -> None:
    # Chosen so that no edge goes through the centre of a pixel.
    size, x, y, distance = 0.2, 0.11, -0.213, 1.1
    scene = SceneGeometry((box(5, (size, size, size), (1, 0, 0)),))
    with make_renderer(scene, CAMERA, kind) as renderer:
        frame = renderer.render(at(x, y, distance)[None], STRAIGHT)
    front = distance - size / 2
    left, right = (CAMERA.fx * (x + side * size / 2) / front + CAMERA.cx for side in (-1, 1))
    top, bottom = (CAMERA.fy * (y + side * size / 2) / front + CAMERA.cy for side in (-1, 1))
    u, v = np.meshgrid(np.arange(CAMERA.width), np.arange(CAMERA.height))
    face = (u > left) & (u < right) & (v > top) & (v < bottom)
    np.testing.assert_array_equal(np.abs(frame.depth - front) < 1e-5, face)
    # The box lies to the right and up, so that its left and lower sides are seen too, farther away.
    assert frame.depth[(frame.mask == 5) & ~face].min() > front
    assert u[frame.mask == 5].min() == np.ceil(left)
    assert v[frame.mask == 5].min() == np.ceil(top)


def test_a_ball_is_seen_where_it_is_and_as_large_as_it_is(kind: str) -> None:
    centre, radius = np.array([0.15, 0.1, 1.0]), 0.1
    with make_renderer(SceneGeometry((ball(9, radius, (0, 1, 0)),)), CAMERA, kind) as renderer:
        frame = renderer.render(at(*centre)[None], STRAIGHT)
    rays = CAMERA.rays()
    along = rays @ centre
    squared = (rays**2).sum(axis=2)
    root = along**2 - squared * (centre @ centre - radius**2)
    expected = np.where(root > 0, (along - np.sqrt(np.maximum(root, 0))) / squared, 0.0)
    # 5,120 flat faces lie up to 0.3 mm inside the ball; at the outline a pixel more or less.
    assert ((frame.mask == 9) != (root > 0)).sum() <= 20
    inside = root > 2e-3
    assert inside.sum() > 500
    np.testing.assert_allclose(frame.depth[inside], expected[inside], atol=1e-3)


def test_ids_colours_and_nothing_are_told_apart(at_table: Renderer) -> None:
    frame = at_table.render(table_poses(), AT_TABLE)
    assert set(np.unique(frame.mask)) == {NOTHING, 3, 7, 11, 100}
    nothing = frame.mask == NOTHING
    assert (frame.depth[nothing] == 0).all()
    assert (frame.depth[~nothing] > 0).all()
    # Half a step of 255 is rounded either way.
    assert np.abs(frame.colour[nothing] - 255 * np.array(BACKGROUND)).max() <= 0.51
    assert [int(np.argmax(frame.colour[frame.mask == each].mean(axis=0))) for each in (3, 7, 11)] == [0, 1, 2]
    assert (frame.colour.dtype, frame.depth.dtype, frame.mask.dtype) == (np.uint8, np.float32, np.int32)
    with pytest.raises(ValueError, match="read-only"):
        frame.depth[0, 0] = 1.0


def test_what_moves_is_drawn_where_it_is_now(at_table: Renderer) -> None:
    first = at_table.render(table_poses(), AT_TABLE)
    moved = table_poses()
    moved[0, :3, 3] += (0.0, -0.3, 0.0)
    second = at_table.render(moved, AT_TABLE)
    columns = [np.nonzero(frame.mask == 3)[1].mean() for frame in (first, second)]
    assert columns[1] - columns[0] > 20, "to the right of a camera that looks along +x is -y"
    again = at_table.render(table_poses(), AT_TABLE)
    for name in ("colour", "depth", "mask"):
        np.testing.assert_array_equal(getattr(again, name), getattr(first, name))


def test_a_face_is_seen_from_both_sides_and_lit_alike(kind: str) -> None:
    corners = np.array([[-1.0, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    frames = []
    for faces in ([[0, 1, 2], [0, 2, 3]], [[2, 1, 0], [3, 2, 0]]):
        plate = SceneGeometry((Drawable(0, corners, np.array(faces), np.array((0.5, 0.5, 0.5)), moving=False),))
        with make_renderer(plate, CAMERA, kind) as renderer:
            frames.append(renderer.render(np.zeros((0, 4, 4)), STRAIGHT))
    assert (frames[0].mask == 0).all()
    np.testing.assert_allclose(frames[0].colour.astype(int), frames[1].colour, atol=1)


def test_corners_have_colours_of_their_own(kind: str) -> None:
    left, right = trimesh.creation.box((0.2, 0.2, 0.2)), trimesh.creation.box((0.2, 0.2, 0.2))
    left.apply_translation((-0.2, 0, 1))
    right.apply_translation((0.2, 0, 1))
    both = trimesh.util.concatenate([left, right])
    rgb = np.repeat([(1.0, 0.0, 0.0), (0.0, 0.0, 1.0)], 8, axis=0)
    with make_renderer(SceneGeometry((Drawable(4, both.vertices, both.faces, rgb),)), CAMERA, kind) as renderer:
        frame = renderer.render(np.eye(4)[None], STRAIGHT)
    across = np.nonzero(frame.mask == 4)[1]
    colours = frame.colour[frame.mask == 4]
    assert (colours[across < CAMERA.cx].argmax(axis=1) == 0).all()
    assert (colours[across > CAMERA.cx].argmax(axis=1) == 2).all()


def test_both_renderers_see_the_same() -> None:
    camera = CameraModel.kinect2(320, 240)
    frames = []
    for kind in ("gl", "tiny"):
        try:
            with make_renderer(table_scene(), camera, kind) as renderer:
                frames.append(renderer.render(table_poses(), AT_TABLE))
        except RendererUnavailableError as error:
            pytest.skip(str(error))
    gl, tiny = frames
    same = gl.mask == tiny.mask
    # Pixels whose centre is within rounding of an outline may differ.
    assert same.mean() > 0.999
    seen = same & (gl.mask != NOTHING)
    np.testing.assert_allclose(gl.depth[seen], tiny.depth[seen], atol=1e-3)
    # Both interpolate normals over the ball's faces, at different precision.
    assert np.abs(gl.colour[seen].astype(int) - tiny.colour[seen]).mean() < 2


def test_renderers_of_one_process_do_not_meet(kind: str) -> None:
    camera = CAMERA.resized(64, 48)
    with (
        make_renderer(table_scene(), CAMERA, kind) as first,
        make_renderer(SceneGeometry((ball(9, 0.2, (0, 1, 0)),)), camera, kind) as second,
    ):
        alone = first.render(table_poses(), AT_TABLE)
        other = second.render(at(0, 0, 1)[None], STRAIGHT)
        again = first.render(table_poses(), AT_TABLE)
        assert set(np.unique(other.mask)) == {NOTHING, 9}
        assert other.mask.shape == (48, 64)
        np.testing.assert_array_equal(alone.mask, again.mask)
        second.close()
        np.testing.assert_array_equal(first.render(table_poses(), AT_TABLE).depth, alone.depth)


def test_closing_frees_what_was_used(kind: str) -> None:
    scene = SceneGeometry((ball(1, 0.1, (1, 0, 0)),))
    large = CameraModel.kinect2(1024, 768)

    def memory() -> int:
        pages = Path("/proc/self/statm").read_text(encoding="ascii").split()[1]
        return int(pages) * os.sysconf("SC_PAGE_SIZE")

    if not Path("/proc/self/statm").exists():
        pytest.skip("the memory of a process is read from /proc")
    for number in range(30):
        if number == 10:
            before = memory()
        with make_renderer(scene, large, kind) as renderer:
            renderer.render(at(0, 0, 1)[None], STRAIGHT)
    # One renderer's targets take 13 MB: twenty that stayed would take 250.
    assert memory() - before < 100e6
    with pytest.raises(TwinError, match="renderer is closed"):
        renderer.render(at(0, 0, 1)[None], STRAIGHT)
    renderer.close()


def test_poses_that_do_not_fit_are_refused(at_table: Renderer) -> None:
    with pytest.raises(
        TwinError, match=r"poses must be \(3, 4, 4\), one of each moving drawable, got shape \(2, 4, 4\)"
    ):
        at_table.render(table_poses()[:2], AT_TABLE)
    broken = table_poses()
    broken[1, 0, 3] = np.nan
    with pytest.raises(TwinError, match="finite"):
        at_table.render(broken, AT_TABLE)


def test_an_unknown_kind_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TwinError, match="one of auto, gl, tiny, got 'vulkan'"):
        make_renderer(table_scene(), CAMERA, "vulkan")
    monkeypatch.setenv("SHOWTELL_RENDERER", "tiny")
    with make_renderer(table_scene(), CAMERA) as renderer:
        assert (renderer.name, renderer.note) == ("tinyrenderer", None)


def test_without_opengl_pybullet_draws_and_says_why() -> None:
    code = (
        "import trimesh\n"
        "from twin.camera import *\n"
        "b = trimesh.creation.box((1, 1, 1))\n"
        "r = make_renderer(SceneGeometry((Drawable(0, b.vertices, b.faces, (1, 0, 0), moving=False),)),\n"
        "                  CameraModel.kinect2(32, 24))\n"
        "import numpy as np\n"
        "print(r.name, '|', r.note, '|', r.render(np.zeros((0, 4, 4)), looking_at((3, 0, 0), (0, 0, 0))).mask.max())\n"
    )
    # EGL finds no driver: as on a machine where none is installed.
    environment = {**os.environ, "__EGL_VENDOR_LIBRARY_FILENAMES": os.devnull, "SHOWTELL_RENDERER": "auto"}
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=Path(__file__).resolve().parents[2],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    name, note, seen = (part.strip() for part in done.stdout.splitlines()[-1].split("|"))
    assert name == "tinyrenderer"
    assert "slower" in note
    assert "apt-get install" in note
    assert note in done.stderr
    assert seen == "0"


def test_the_camera_may_be_anywhere(kind: str) -> None:
    """Turning world and camera together changes nothing."""
    turn = trimesh.transformations.rotation_matrix(1.0, (0.0, 0.0, 1.0), (0.0, 0.0, 0.0))
    turn[:3, 3] = (2.0, -1.0, 0.5)
    from robots.kinematics import quaternion_xyzw

    camera_in_world = turn @ pose_matrix(AT_TABLE)
    elsewhere = Pose(camera_in_world[:3, 3], quaternion_xyzw(camera_in_world[:3, :3]))
    moving = SceneGeometry(table_scene().drawables[1:])
    with make_renderer(moving, CAMERA, kind) as renderer:
        here = renderer.render(table_poses(), AT_TABLE)
        there = renderer.render(turn @ table_poses(), elsewhere)
    assert (here.mask == there.mask).mean() > 0.999
    both = (here.mask == there.mask) & (here.mask != NOTHING)
    np.testing.assert_allclose(here.depth[both], there.depth[both], atol=2e-5)
