"""Observations through the robot's own camera: of a recorded demo at a table, and of a world that stands still."""

import logging
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from learning.errors import PerceptionError
from learning.perception.camera_observation import Perceived, gathered
from learning.perception.observation import Observation
from learning.perception.proprioception import Proprioception, frames_of, proprioception_at, proprioception_of
from learning.perception.robot_eye import HEIGHT, WIDTH, Look, RobotEye
from learning.perception.table import Table, find_table
from learning.perception.tracker import Tracker
from robots.pose import FloatArray, Pose
from twin.scene_spec import SceneSpec
from twin.state import ObjectState, WorldState

if TYPE_CHECKING:
    from robots.model import RobotModel
    from teleop import Demo

_LOG = logging.getLogger(__name__)

WORLD_FRAMES = 12
"""Pictures of a world that stands still: enough to get to know a thing in the hand."""


@dataclass(frozen=True, slots=True)
class Eyesight:
    """How a demo is looked at.

    Attributes:
        camera: Name of the robot's camera; None takes its first.
        width: Columns of a picture [pixel].
        height: Rows [pixel].
    """

    camera: str | None = None
    width: int = WIDTH
    height: int = HEIGHT


USUAL = Eyesight()


def observe_camera_demo(demo: "Demo", rng: np.random.Generator, eyesight: Eyesight = USUAL) -> Observation:
    """Observe a recorded demo at a table through the camera of its robot, at about 10 Hz.

    Args:
        demo: The recording; the objects' recorded states are used to draw the pictures and for nothing else.
        rng: Source of the sensor's noise and of the tracker's randomness.
        eyesight: Camera and size of the pictures.

    Raises:
        PerceptionError: The robot has no camera, no table is in sight, or joint positions are missing.
    """
    perceived = perceive_camera_demo(demo, rng, eyesight)
    for note in perceived.notes:
        _LOG.warning("%s: %s", demo.path, note)
    return perceived.observation


def perceive_camera_demo(demo: "Demo", rng: np.random.Generator, eyesight: Eyesight = USUAL) -> Perceived:
    """As `observe_camera_demo`, with notes about what the tracks do not say.

    Raises:
        PerceptionError: See `observe_camera_demo`.
    """
    robot = _robot(demo.scene)
    own = proprioception_of(demo, robot)
    states = demo.states
    if not np.isfinite(states.object_positions).all():
        raise PerceptionError(f"{demo.path}: states of objects are missing, so its pictures cannot be drawn")
    picked = frames_of(np.asarray(demo.times, dtype=np.float64))

    def shown() -> Iterator[list[ObjectState]]:
        for k in picked:
            yield [
                ObjectState(int(number), Pose(position, orientation))
                for number, position, orientation in zip(
                    states.object_ids, states.object_positions[k], states.object_orientations[k], strict=True
                )
            ]

    with RobotEye(demo.scene, robot, eyesight.camera, eyesight.width, eyesight.height) as eye:
        return _perceive(eye, own, shown(), rng)


def observe_camera_world(
    state: WorldState,
    spec: SceneSpec,
    rng: np.random.Generator,
    *,
    arm: str | None = None,
    frames: int = WORLD_FRAMES,
    eye: RobotEye | None = None,
    robot: "RobotModel | None" = None,
    apart: FloatArray | None = None,
) -> Observation:
    """Observe a world that stands still through the camera of its robot.

    Args:
        state: Its state; the objects' places are used to draw the pictures and for nothing else.
        spec: Its scene.
        rng: Source of the sensor's noise and of the tracker's randomness.
        arm: Whose hand the observation tells of; None takes one whose gripper is closed, else the first.
        frames: How many pictures.
        eye: An eye for this scene to use again, which saves making one.
        robot: The robot, where it is loaded already.
        apart: Red, green, blue of 255 of things that may stand in or on others and are no lids of them, (k, 3).

    Raises:
        PerceptionError: The robot has no camera or no such arm, or no table is in sight.
    """
    if frames < 1:
        raise PerceptionError(f"frames must be at least 1, got {frames}")
    body = robot or _robot(spec)
    own = proprioception_at(state, body, frames, arm)
    shown = [state.objects] * frames
    if eye is not None:
        return _perceive(eye, own, shown, rng, apart).observation
    with RobotEye(spec, body) as fresh:
        return _perceive(fresh, own, shown, rng, apart).observation


def _perceive(
    eye: RobotEye,
    own: Proprioception,
    shown: Iterable[Iterable[ObjectState]],
    rng: np.random.Generator,
    apart: FloatArray | None = None,
) -> Perceived:
    """Take a picture of every frame, and follow what is in them."""
    tracker: Tracker | None = None
    sightings = []
    for number, (body, objects) in enumerate(zip(own.bodies, shown, strict=True)):
        look: Look = eye.look(body, objects, rng)
        if tracker is None:
            table = _table(eye, look, rng)
            tracker = Tracker(table, eye.model, rng, apart)
        sightings.append(tracker.step(look, own.tool[number], bool(own.closed[number]), float(own.opening[number])))
    if tracker is None:
        raise PerceptionError("there are no pictures to look at: the demo holds no state")
    return gathered(own, sightings, table)


def _table(eye: RobotEye, look: Look, rng: np.random.Generator) -> Table:
    """The table, as it was found when the eye first looked from where it is: tables stand still."""
    here = look.pose_camera_in_world
    if eye.table is not None:
        there, table = eye.table
        if np.array_equal(here.position, there.position) and np.array_equal(
            here.orientation_xyzw, there.orientation_xyzw
        ):
            return table
    eye.table = here, find_table([look], eye.model, rng)
    return eye.table[1]


def _robot(spec: SceneSpec) -> "RobotModel":
    if spec.kind != "table":
        raise PerceptionError(f"a camera looks at tables, and this scene is a {spec.kind}: use observe_demo")
    return _loaded(spec.robot, spec.finger_mounting)


@lru_cache(maxsize=4)
def _loaded(name: str, finger_mounting: float | None) -> "RobotModel":
    """A robot, read once: a pass looks at hundreds of demos of one."""
    from robots import load_robot

    return load_robot(name, finger_mounting=finger_mounting)
