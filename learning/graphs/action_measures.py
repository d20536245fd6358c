"""What one demo shows of the continuous side of its action: `action_statistics.MEASURES` of every state."""

import numpy as np
from numpy.typing import NDArray

from learning.graphs.camera_states import Segment, Segmentation, frame_period
from learning.perception.gaps import box_size, face_distances
from learning.perception.handling import FIRST_FRAMES
from learning.perception.track_noise import track_noise
from robots.pose import FloatArray

APPROACH_TIME = 0.5
"""The hand's way to the object is that of this time before they touch [s]."""
LEAST_WAY = 0.005
"""A shorter way has no direction [m]."""
HIGH = 0.8
"""Quantile of an object's heights that is taken for how high it was raised: it also rises and sinks, and flickers."""
END = 1.0 / 3.0
"""Part of a state that is its end, where the hand has arrived."""


def measured(segmentation: Segmentation) -> list[dict[str, FloatArray]]:
    """Measures of each state of a demo, as `ActionStatistics.update` takes them."""
    rows: list[dict[str, FloatArray]] = []
    before: Segment | None = None
    frame = _action_frame(segmentation)
    for segment in segmentation.segments:
        rows.append(_of_state(segmentation, segment) | _of_change(segmentation, before, segment, frame))
        before = segment
    return rows


def _of_state(segmentation: Segmentation, segment: Segment) -> dict[str, FloatArray]:
    """What holds throughout a state."""
    observation, moved = segmentation.observation, segmentation.moved
    frames = _frames(segmentation, segment)
    values = {"duration": np.array([frame_period(observation) * (segment.stop - segment.start)])}
    if observation.gripper_opening is not None:
        values["opening"] = np.array([np.median(observation.gripper_opening[frames])])
    if observation.wrist_force is not None:
        values["force"] = _force(segmentation, segment, observation.wrist_force)
    if segment.state.raised:
        _, half_height = box_size(observation)
        height = np.quantile(observation.location[frames, moved, 2], HIGH)
        values["clearance"] = np.array([height - half_height[moved]])
    return values


def _force(segmentation: Segmentation, segment: Segment, felt: FloatArray) -> FloatArray:
    """What the wrist feels in a state [N]: of a hand that leans on an object, while it leans most.

    Args:
        segmentation: The demo.
        segment: Its state.
        felt: Force in every frame, (F, 3) [N].
    """
    here = felt[_frames(segmentation, segment)]
    free = [felt[_frames(segmentation, each)] for each in segmentation.segments if not each.state.touching]
    if segment.state.side is None or not free:
        return np.asarray(here.mean(axis=0))
    # Coming on and letting go take half of the time: their mean would be a touch that nobody showed.
    lean = np.linalg.norm(here - np.median(np.concatenate(free), axis=0), axis=1)
    return np.asarray(here[lean >= np.median(lean)].mean(axis=0))


def _of_change(
    segmentation: Segmentation, before: Segment | None, segment: Segment, frame: FloatArray
) -> dict[str, FloatArray]:
    """What a state has that another came before: where the hand touches, where the object was brought."""
    observation, moved = segmentation.observation, segmentation.moved
    if before is None:
        return _grip(segmentation, segment, frame) if segment.state.touching else {}
    values: dict[str, FloatArray] = {}
    if segment.state.touching and not before.state.touching:
        values |= _grip(segmentation, segment, frame)
        way = _approach(segmentation, segment)
        if np.linalg.norm(way) > LEAST_WAY:
            values["approach"] = frame @ (way / np.linalg.norm(way))
    if segment.state.object_location != before.state.object_location and not segment.state.raised:
        way = np.median(observation.location[_end(segmentation, segment), moved], axis=0) - _first(segmentation)
        values["displacement"] = way
        values["travel"] = np.array([np.linalg.norm(way[:2])])
    return values


def _grip(segmentation: Segmentation, segment: Segment, frame: FloatArray) -> dict[str, FloatArray]:
    """Where on the object the hand is when it has come to it."""
    observation, moved = segmentation.observation, segmentation.moved
    end = _furthest(segmentation, segment)
    offset = np.median(observation.gripper_location[end] - observation.location[end, moved], axis=0)
    _, half_height = box_size(observation)
    above, outside = face_distances(observation)
    return {
        "offset": frame @ offset,
        "height": np.array([offset[2] / max(half_height[moved], LEAST_WAY)]),
        "faces": np.array([np.median(above[end, moved]), np.median(outside[end, moved])]),
    }


def _action_frame(segmentation: Segmentation) -> FloatArray:
    """Rotation from the world to the action's frame, (3, 3)."""
    pushed = any(segment.state.side is not None for segment in segmentation.segments)
    observation, moved = segmentation.observation, segmentation.moved
    along = np.zeros(2)
    if pushed and len({segment.state.object_location for segment in segmentation.segments}) > 1:
        along = (np.median(observation.location[-FIRST_FRAMES:, moved], axis=0) - _first(segmentation))[:2]
    if np.linalg.norm(along) <= 2.0 * float(track_noise(observation)[moved]):
        touched = (segment for segment in segmentation.segments if segment.state.touching)
        along = _approach(segmentation, next(touched, segmentation.segments[0]))[:2]
    length = float(np.linalg.norm(along))
    cosine, sine = along / length if length > LEAST_WAY else (1.0, 0.0)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def _approach(segmentation: Segmentation, segment: Segment) -> FloatArray:
    """Way of the tool before it touched the object, (3,) [m]."""
    tool = segmentation.observation.gripper_location
    frames = max(1, round(APPROACH_TIME / frame_period(segmentation.observation)))
    there = min(segment.start, len(tool) - 1)
    return np.asarray(tool[there] - tool[max(there - frames, 0)])


def _furthest(segmentation: Segmentation, segment: Segment) -> NDArray[np.intp]:
    """The half of a state's frames in which the tool is furthest along the way it came: it comes, stays, and goes."""
    frames = _frames(segmentation, segment)
    way = _approach(segmentation, segment)
    if np.linalg.norm(way) <= LEAST_WAY:
        frames = _end(segmentation, segment)
    reached = segmentation.observation.gripper_location[frames] @ way
    return np.asarray(frames.start + np.flatnonzero(reached >= np.median(reached)), dtype=np.intp)


def _first(segmentation: Segmentation) -> FloatArray:
    """First place of the object, (3,) [m]."""
    return np.asarray(np.median(segmentation.observation.location[:FIRST_FRAMES, segmentation.moved], axis=0))


def _frames(segmentation: Segmentation, segment: Segment) -> slice:
    """The frames of a state; of one that was too short to be seen, the frame at which it was put in."""
    start = min(segment.start, len(segmentation.observation.times) - 1)
    return slice(start, max(segment.stop, start + 1))


def _end(segmentation: Segmentation, segment: Segment) -> slice:
    """The last frames of a state."""
    frames = _frames(segmentation, segment)
    return slice(frames.stop - max(1, round(END * (frames.stop - frames.start))), frames.stop)
