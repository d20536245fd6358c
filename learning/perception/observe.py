"""Observations: of any recorded demo, and of the board: a demo, key frames, and a world that stands still."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from learning.errors import PerceptionError
from learning.perception.board_noise import BOARD_NOISE, FRAME_TIME, BoardNoise, TrueTracks, observed
from learning.perception.observation import Observation
from robots.pose import FloatArray, read_only
from twin.scene_spec import ObjectSpec, SceneSpec
from twin.state import WorldState

if TYPE_CHECKING:
    from learning.perception.camera_observation import Perceived
    from learning.perception.observe_camera import Eyesight
    from teleop import Demo

KEY_FRAME_LENGTH = 4
"""Noisy frames that one key frame stands for: 0.4 s at 10 Hz."""
WORLD_FRAMES = 10
"""Noisy frames of a world that stands still: 1 s at 10 Hz."""


@dataclass(frozen=True, slots=True)
class KeyFrame:
    """A moment of an action at which everything stands still.

    Attributes:
        gripper_location: Tool frame in the world, (3,) [m].
        gripper_closed: Gripper state.
        object_location: Object centres in the world, (N, 3) [m].
    """

    gripper_location: FloatArray
    gripper_closed: bool
    object_location: FloatArray


def observe(demo: "Demo", rng: np.random.Generator) -> Observation:
    """Observe any recorded demo: the board's states through noise, a table through the robot's camera.

    Args:
        demo: The recording.
        rng: Source of all noise.

    Raises:
        PerceptionError: What the demo shows cannot be perceived.
    """
    return perceive_any(demo, rng).observation


def perceive_any(demo: "Demo", rng: np.random.Generator, eyesight: "Eyesight | None" = None) -> "Perceived":
    """As `observe`, with notes about what the tracks do not say.

    Args:
        demo: The recording.
        rng: Source of all noise.
        eyesight: Camera and size of pictures, for a table.

    Raises:
        PerceptionError: What the demo shows cannot be perceived.
    """
    from learning.perception.camera_observation import Perceived
    from learning.perception.observe_camera import USUAL, perceive_camera_demo

    if demo.scene.kind == "board":
        return Perceived(observe_demo(demo, rng))
    return perceive_camera_demo(demo, rng, eyesight or USUAL)


def observe_key_frames(
    frames: Sequence[KeyFrame],
    objects: Sequence[ObjectSpec],
    rng: np.random.Generator,
    noise: BoardNoise = BOARD_NOISE,
) -> Observation:
    """Observe a sequence of key frames, each for `KEY_FRAME_LENGTH` noisy frames.

    Args:
        frames: At least one key frame.
        objects: The N objects, for their ids and looks (their `position` is not used).
        rng: Source of the noise.
        noise: Its standard deviations.

    Raises:
        PerceptionError: There are no key frames.
    """
    if not frames:
        raise PerceptionError("there are no key frames to observe; give at least one")
    repeated = [frame for frame in frames for _ in range(KEY_FRAME_LENGTH)]
    tracks = TrueTracks(
        times=read_only(FRAME_TIME * np.arange(len(repeated))),
        gripper_location=np.array([frame.gripper_location for frame in repeated], dtype=np.float64),
        gripper_closed=np.array([frame.gripper_closed for frame in repeated], dtype=bool),
        location=np.array([frame.object_location for frame in repeated], dtype=np.float64).reshape(
            len(repeated), len(objects), 3
        ),
    )
    return observed(tracks, objects, rng, noise)


def observe_demo(demo: "Demo", rng: np.random.Generator, noise: BoardNoise = BOARD_NOISE) -> Observation:
    """Observe a recorded demo of the board at about 10 Hz, through noise.

    Args:
        demo: The recording; its true poses are read, as the board is fully observed (design section 5).
        rng: Source of the noise.
        noise: Its standard deviations.
    """
    states = demo.states
    times = np.asarray(demo.times, dtype=np.float64)
    picked = np.searchsorted(times, np.arange(times[0], times[-1], FRAME_TIME))
    picked = np.unique(np.append(picked, len(times) - 1))  # the last state says how the demo ended
    by_id = {thing.id: thing for thing in demo.scene.objects}
    tracks = TrueTracks(
        times=times[picked],
        gripper_location=np.asarray(states.tool)[picked, :3],
        gripper_closed=np.asarray(states.gripper_closed, dtype=bool)[picked],
        location=np.asarray(states.object_positions)[picked],
    )
    return observed(tracks, [by_id[int(number)] for number in states.object_ids], rng, noise)


def observe_world(
    state: WorldState, spec: SceneSpec, rng: np.random.Generator, noise: BoardNoise = BOARD_NOISE
) -> Observation:
    """Observe a world that stands still for `WORLD_FRAMES` noisy frames.

    Args:
        state: Its true state.
        spec: Its scene, for the objects' looks.
        rng: Source of the noise.
        noise: Its standard deviations.
    """
    by_id = {thing.id: thing for thing in spec.objects}
    location = np.array([thing.pose_object_in_world.position for thing in state.objects]).reshape(-1, 3)
    tracks = TrueTracks(
        times=read_only(state.time + FRAME_TIME * np.arange(WORLD_FRAMES)),
        gripper_location=np.tile(state.pose_tool_in_world.position, (WORLD_FRAMES, 1)),
        gripper_closed=np.full(WORLD_FRAMES, state.gripper_closed),
        location=np.tile(location, (WORLD_FRAMES, 1, 1)),
    )
    return observed(tracks, [by_id[thing.id] for thing in state.objects], rng, noise)
