"""What is true of a recorded demo: its objects' classes and places, and its action, put beside the tracks."""

from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from learning.evaluation.concepts import ScoredDemo
from learning.evaluation.concepts_truth import TrueDemo
from learning.perception.observation import Observation
from robots.pose import FloatArray
from teleop.truth import read_truth

if TYPE_CHECKING:
    from teleop import Demo

FARTHEST_MATCH = 0.06
"""A track is of the object whose true place is nearest in the first frame, if it is no further away than this [m]."""
PICTURE_BYTES = 5
"""Bytes of a pixel: three of colour, two of depth."""
PICTURE_SIZE = (320, 240)


def scored_demo(demo: "Demo", observation: Observation, number: int) -> ScoredDemo:
    """Put the truth of a demo beside its observation.

    Args:
        demo: The recording; its true object states and its sidecar are read.
        observation: What perception got from it.
        number: Number of the demo: no other is of its group.

    Raises:
        DemoError: The sidecar is missing or is none.
    """
    truth = read_truth(demo.path)
    positions = np.asarray(demo.states.object_positions)
    first, last = positions[0], positions[-1]
    match = matched(observation.location[0] if len(observation.times) else np.zeros((0, 3)), first)
    by_id = {thing.id: thing for thing in demo.scene.objects}
    things = [None if index is None else by_id[int(demo.states.object_ids[index])] for index in match]
    properties: dict[str, tuple[str | None, ...]] = {
        "colour": tuple(None if thing is None else thing.colour for thing in things),
        "shape": tuple(None if thing is None else thing.shape for thing in things),
    }
    board = demo.scene.kind == "board"
    pictures = 0 if board else len(observation.times) * PICTURE_SIZE[0] * PICTURE_SIZE[1] * PICTURE_BYTES
    return ScoredDemo(
        observation,
        TrueDemo(properties, _ordered(first, match), _ordered(last, match), action_of_truth(truth)),
        tuple(demo.utterances),
        group=number,
        raw=pictures,
    )


def action_of_truth(truth: dict[str, Any]) -> str | None:
    """Name of the action that a sidecar tells, None when it tells none."""
    for key in ("action", "task"):
        if isinstance(truth.get(key), str):
            return str(truth[key])
    return None


def matched(seen: FloatArray, true: FloatArray) -> list[int | None]:
    """Index of the true object of each track, None for a track that is near none.

    Args:
        seen: Places of the tracks in the first frame, (N, 3) [m].
        true: True places, (M, 3) [m].
    """
    result: list[int | None] = [None] * len(seen)
    if len(seen) and len(true):
        away = np.linalg.norm(seen[:, None] - true[None], axis=2)
        for track, thing in zip(*linear_sum_assignment(away), strict=True):
            if away[track, thing] <= FARTHEST_MATCH:
                result[int(track)] = int(thing)
    return result


def _ordered(places: FloatArray, match: list[int | None]) -> FloatArray:
    """Places in the order of the tracks, (N, 3) [m]; NaN for a track of nothing."""
    nowhere = np.full(3, np.nan)
    return np.array([nowhere if index is None else places[index] for index in match]).reshape(-1, 3)
