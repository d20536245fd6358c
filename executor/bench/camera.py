"""Cameras: what a frame of colour, depth and mask costs with each renderer, for the same Baxter at its table."""

import time
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context

import numpy as np

from executor.bench.camera_contenders import Moment, Setup, contender
from executor.bench.physics import primitives_scene
from executor.bench.report import BenchReport
from robots.meshes import resolve
from robots.workers import end_with_parent
from twin import TwinError, World
from twin.camera import CameraModel, RgbdFrame, kinect_noise
from twin.camera.camera_model import pose_matrix
from twin.scene_view import ROBOT_ID, SceneView, robot_state

SIZES = ((320, 240), (640, 480))
SWAY = 0.05
"""How far [rad] each arm joint strays."""
TURNED_IN = {"left_s0": -0.75, "right_s0": 0.75}
"""Added to the home posture [rad]: it holds the arms beside the picture, and a robot at work has them in it."""
WARM_UP = 2
"""Frames that are drawn first and not counted."""

OURS = "moderngl"
CONTENDERS = {
    OURS: "ours: OpenGL through EGL, one draw call, decimated meshes",
    "fallback": "ours without OpenGL: PyBullet's TinyRenderer in a client of its own, decimated, both sides of faces",
    "tinyrenderer": "PyBullet's TinyRenderer, URDF with decimated meshes, no shadow",
    "tinyrenderer_original": "PyBullet's TinyRenderer, URDF of example-robot-data (410,000 triangles), no shadow",
    "pybullet_egl": "PyBullet's EGL plug-in, URDF with decimated meshes, no shadow",
    "open3d": "Open3D RaycastingScene, decimated meshes, one mesh rebuilt each frame, lit from its normals",
}
_ORIGINAL = "package://example-robot-data/robots/baxter_description/urdf/baxter.urdf"


def run(seed: int, frames: int = 40, on_done: Callable[[], None] = lambda: None) -> BenchReport:
    """Time every renderer on the same frames, each in a process of its own, one after the other.

    A frame goes from joint positions and object poses to arrays of colour, depth in metres and mask.

    Args:
        seed: Decides how the arms sway.
        frames: Frames that are counted.
        on_done: Called after each renderer and size: 12 times.
    """
    setup, moments = _scene(seed, frames + WARM_UP)
    figures: dict[str, float | None] = {}
    notes = []
    for width, height in SIZES:
        camera = CameraModel.kinect2(width, height)
        drawn: dict[str, RgbdFrame] = {}
        for name in CONTENDERS:
            try:
                times, drawn[name] = _in_its_own_process(name, setup, camera, moments)
                figures[f"{name}.ms_{width}"] = 1e3 * float(np.median(times))
            except (TwinError, ImportError) as error:
                figures[f"{name}.ms_{width}"] = None
                notes.append(f"{name} at {width} x {height}: {error}")
            on_done()
        for name, frame in drawn.items():
            if name != OURS and OURS in drawn:
                figures[f"{name}.mismatch_{width}"] = float((frame.mask != drawn[OURS].mask).mean())
        if OURS in drawn:
            figures[f"{OURS}.noise_ms_{width}"] = _noise_ms(drawn[OURS], camera, seed, frames)
    _add_ratios(figures)
    settings = dict(CONTENDERS)
    settings["scene"] = (
        f"Baxter, arms in the picture and swaying by {SWAY} rad, table, eight objects, chest camera; {frames} frames, "
        "medians; mismatch is the part of pixels whose mask differs from ours in the last frame"
    )
    return BenchReport(figures, settings=settings, notes=tuple(notes))


def _scene(seed: int, count: int) -> tuple[Setup, list[Moment]]:
    """What is drawn, and its moments."""
    spec = primitives_scene()
    rng = np.random.default_rng(seed)
    with World.from_scene(spec, seed=seed) as world:
        state, robot = world.state(), world.robot
        view = SceneView(spec, robot, world.ground)
        parts = [each for each in view.geometry.drawables if each.id != ROBOT_ID]
        body = robot_state(robot, state)
        where = {each.id: pose_matrix(each.pose_object_in_world) for each in state.objects}
        setup = Setup(
            urdf=robot.urdf_path,
            original_urdf=resolve(_ORIGINAL, robot.urdf_path, "torso"),
            pose_base_in_world=body.pose_base_in_world,
            still=tuple(each for each in parts if not each.moving),
            objects=tuple(each for each in parts if each.moving),
            pose_camera_in_world=view.camera_pose("chest", body),
        )
        poses = np.stack([where[each.id] for each in setup.objects])
        centre = robot.home + [TURNED_IN.get(name, 0.0) for name in robot.joint_names]
        postures = centre + rng.uniform(-SWAY, SWAY, (count, len(centre)))
        return setup, [Moment(robot.expand(posture, body.openings), poses) for posture in postures]


def _in_its_own_process(
    name: str, setup: Setup, camera: CameraModel, moments: list[Moment]
) -> tuple[list[float], RgbdFrame]:
    """Times [s] and last frame of a contender, which may take its process with it.

    Raises:
        TwinError: It ended its process, or cannot work here.
    """
    with ProcessPoolExecutor(1, mp_context=get_context("spawn"), initializer=end_with_parent) as pool:
        try:
            return pool.submit(_time, name, setup, camera, moments).result()
        except BrokenProcessPool as error:
            raise TwinError("it ended its process") from error


def _time(name: str, setup: Setup, camera: CameraModel, moments: list[Moment]) -> tuple[list[float], RgbdFrame]:
    """Draw every moment; the first ones are not counted."""
    times = []
    with contender(name, setup, camera) as show:
        for moment in moments:
            began = time.perf_counter()
            frame = show(moment)
            times.append(time.perf_counter() - began)
    return times[WARM_UP:], frame


def _noise_ms(frame: RgbdFrame, camera: CameraModel, seed: int, frames: int) -> float:
    """Median time of the depth camera's noise [ms]."""
    rng = np.random.default_rng(seed)
    times = []
    for _ in range(frames):
        began = time.perf_counter()
        kinect_noise(frame, rng, camera)
        times.append(time.perf_counter() - began)
    return 1e3 * float(np.median(times))


def _add_ratios(figures: dict[str, float | None]) -> None:
    """Their time over ours, for all that is not ours."""
    for width, _ in SIZES:
        ours = figures[f"{OURS}.ms_{width}"]
        for name in CONTENDERS:
            theirs = figures[f"{name}.ms_{width}"]
            if name not in (OURS, "fallback"):
                figures[f"{OURS}.ratio_vs_{name}_{width}"] = None if ours is None or theirs is None else theirs / ours
