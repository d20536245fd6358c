"""From the tracks of one demo to its action graphlet (thesis 3.3.4)."""

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.graphs.action_graphlet import ActionGraphlet, GraphletState
from learning.graphs.smoothing import lasting, smoothed, without_short_rows
from learning.perception.observation import Observation
from learning.perception.tracks import MOVED, anchors, moved_object

SHORTEST_STATE = 2
"""Frames that a qualitative state must last: a shorter one is noise, or changes that belong together."""


def action_of(observation: Observation, spaces: ConceptSpaces) -> ActionGraphlet:
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
    rows = without_short_rows(rows, SHORTEST_STATE)
    return ActionGraphlet.of(_one_change_at_a_time(GraphletState(bool(c), bool(t), int(at)) for c, t, at in rows))


def touches(observation: Observation, spaces: ConceptSpaces) -> NDArray[np.bool_]:
    """Whether the gripper is at each object, per frame, (F, N): their distance concept is the *at it* one."""
    offset = observation.location - observation.gripper_location[:, None]
    return np.asarray(spaces.predicates("distance", smoothed(offset)) == spaces.touching)


def _one_change_at_a_time(states: Iterable[GraphletState]) -> Iterator[GraphletState]:
    """Put in the state that was too short to be seen when the gripper closes as it arrives, or leaves as it opens.

    A gripper that grasps is there before it closes, and one that lets go opens before it leaves: in between it is open
    and touching, however briefly.
    """
    before: GraphletState | None = None
    for state in states:
        if before is not None and before.gripper_closed != state.gripper_closed and before.touching != state.touching:
            grasping = state if state.gripper_closed else before
            if grasping.touching:
                yield GraphletState(False, True, grasping.object_location)
        yield state
        before = state


def _location_variable(observation: Observation, moved: int) -> NDArray[np.int64]:
    """0 while the moved object is nearer to its first resting place, 1 when nearer to its last, (F,)."""
    first, last = anchors(observation)
    if np.linalg.norm(last[moved] - first[moved]) <= MOVED:
        return np.zeros(len(observation.times), dtype=np.int64)
    track = smoothed(observation.location[:, moved])
    nearer_last = np.linalg.norm(track - last[moved], axis=1) < np.linalg.norm(track - first[moved], axis=1)
    return np.asarray(nearer_last, dtype=np.int64)
