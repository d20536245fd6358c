"""From the tracks of one demo to its action graphlet (thesis 3.3.4)."""

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.graphs.action_graphlet import ActionGraphlet, GraphletState
from learning.perception.observation import Observation
from learning.perception.tracks import MOVED, anchors, moved_object

SHORTEST_STATE = 2
"""Frames that a qualitative state must last: a shorter one is noise, or changes that belong together."""
SMOOTHING = 3
"""Frames of the running mean over tracks."""


def action_graphlet(observation: Observation, spaces: ConceptSpaces) -> ActionGraphlet:
    """Encode a demo as the sequence of states of its gripper and the object it manipulates.

    Frames carry noise and a driven demo flickers: tracks are smoothed, each predicate must last for some frames, and
    changes that come together are one change.

    Args:
        observation: The demo's tracks.
        spaces: Concepts learned so far; the distance concept nearest to none is *at it*.

    Raises:
        PerceptionError: Nothing was moved.
    """
    moved = moved_object(observation)
    touching = lasting(touches(observation, spaces)[:, moved], SHORTEST_STATE)
    closed = lasting(observation.gripper_closed, SHORTEST_STATE)
    location = lasting(_location_variable(observation, moved), SHORTEST_STATE)
    rows = np.stack([closed, touching, location], axis=1).astype(np.int64)
    rows = _together(rows, SHORTEST_STATE)
    return ActionGraphlet.of(GraphletState(bool(row[0]), bool(row[1]), int(row[2])) for row in rows)


def touches(observation: Observation, spaces: ConceptSpaces) -> NDArray[np.bool_]:
    """Whether the gripper is at each object, per frame, (F, N): their distance concept is the *at it* one."""
    offset = observation.location - observation.gripper_location[:, None]
    return spaces.predicates("distance", _smoothed(offset)) == spaces.touching


def lasting(values: NDArray[np.generic], shortest: int) -> NDArray[np.generic]:
    """Give values that last less than `shortest` frames to the value before them; the first run is always kept."""
    result = values.copy()
    current = result[0]
    start = 0
    while start < len(result):
        stop = start
        while stop < len(result) and values[stop] == values[start]:
            stop += 1
        if stop - start >= shortest or start == 0:
            current = values[start]
        result[start:stop] = current
        start = stop
    return result


def _location_variable(observation: Observation, moved: int) -> NDArray[np.int64]:
    """0 while the moved object is nearer to its first resting place, 1 when nearer to its last, (F,)."""
    first, last = anchors(observation)
    if np.linalg.norm(last[moved] - first[moved]) <= MOVED:
        return np.zeros(len(observation.times), dtype=np.int64)
    track = _smoothed(observation.location[:, moved])
    return (np.linalg.norm(track - last[moved], axis=1) < np.linalg.norm(track - first[moved], axis=1)).astype(np.int64)


def _together(rows: NDArray[np.int64], shortest: int) -> NDArray[np.int64]:
    """Drop combinations that last less than `shortest` frames: their changes are one change."""
    keep = np.ones(len(rows), dtype=bool)
    start = 0
    while start < len(rows):
        stop = start
        while stop < len(rows) and np.array_equal(rows[stop], rows[start]):
            stop += 1
        if stop - start < shortest and 0 < start and stop < len(rows):
            keep[start:stop] = False
        start = stop
    return rows[keep]


def _smoothed(track: NDArray[np.float64]) -> NDArray[np.float64]:
    """Running median over frames, (F, ...): it takes out noise and leaves jumps where they are."""
    if len(track) < SMOOTHING:
        return track
    padded = np.concatenate([track[:1], track, track[-1:]])
    windows = np.stack([padded[:-2], padded[1:-1], padded[2:]])
    return np.asarray(np.median(windows, axis=0))
