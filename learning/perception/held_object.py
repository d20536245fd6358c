"""Where an object is while it is held: the hand's place is known, and the object's place in it hardly changes."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from learning.perception.handling import felt, touch_evidence
from learning.perception.observation import Observation

LAST_LOOK = 10
"""Frames of the last unhindered look at an object before it was grasped."""


def with_held_object(observation: Observation, index: int) -> Observation:
    """The observation with the track of object `index` tied to the hand wherever the fingers feel something.

    While an object is held it is hidden by fingers and moves fast, and its track is at its worst. Its place in the hand
    hardly changes: the median of where it was seen there is added to the tool's place, which also brings back a track
    that was lost on the way. It counts as seen then. An object that the fingers hide all the time they hold it is where
    it was when they closed on it, if it was there; else it is left as it is.
    """
    held = felt(observation)
    seen = held if observation.visible is None else held & observation.visible[:, index]
    if not np.any(seen):
        seen = _closed_on(observation, index, held)
    if not np.any(seen):
        return observation
    location = observation.location.copy()
    visible = np.ones(location.shape[:2], dtype=bool) if observation.visible is None else observation.visible.copy()
    in_hand = location[:, index] - observation.gripper_location
    for start, stop in _runs(held):
        known = in_hand[start:stop][seen[start:stop]]
        known = known if len(known) else in_hand[seen]
        location[start:stop, index] = observation.gripper_location[start:stop] + np.median(known, axis=0)
        visible[start:stop, index] = True
        height = _height_before(observation, index, start)
        if height is not None:  # when the fingers close on it, it still rests as it was seen to before they hid it
            location[start:stop, index, 2] += height - location[start, index, 2]
    return replace(observation, location=location, visible=visible)


def _closed_on(observation: Observation, index: int, held: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """First frames of the stays in the hand at which object `index`, once seen, is believed to be at the hand, (F,)."""
    touching = touch_evidence(observation)[:, index] > 0.0
    first = np.zeros(len(held), dtype=bool)
    for start, _ in _runs(held):
        once = observation.visible is None or bool(np.any(observation.visible[:start, index]))
        first[start] = once and touching[start]
    return first


def _runs(held: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """First and one past the last frame of each stay in the hand."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], held, [False]]).astype(np.int64)))
    return [(int(start), int(stop)) for start, stop in edges.reshape(-1, 2)]


def _height_before(observation: Observation, index: int, start: int) -> float | None:
    """Height of the object's centre [m] when the hand was last away from it before frame `start`, if it was."""
    free = ~observation.gripper_closed[:start] & (touch_evidence(observation)[:start, index] < 0.0)
    if observation.visible is not None:
        free &= observation.visible[:start, index]
    frames = np.flatnonzero(free)[-LAST_LOOK:]
    return float(np.median(observation.location[frames, index, 2])) if len(frames) >= 3 else None
