"""From the tracks of one demo to its action graphlet (thesis 3.3.4)."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_measures import measured
from learning.graphs.camera_states import segmented
from learning.graphs.graphlet_state import GraphletState
from learning.graphs.smoothing import lasting, smoothed, without_short_rows
from learning.perception.gaps import gap_offsets
from learning.perception.observation import Observation
from learning.perception.tracks import MOVED, anchors, moved_object
from robots.pose import FloatArray

SHORTEST_STATE = 2
"""Frames that a qualitative state must last: a shorter one is noise, or changes that belong together."""


def action_of(observation: Observation, spaces: ConceptSpaces) -> ActionGraphlet:
    """Encode a demo as the sequence of states of its gripper and the object it manipulates.

    Where a camera saw the demo, see `camera_states.segmented`. On the board, where poses are known but for a little
    noise: tracks are smoothed, each predicate must last for some frames, and changes that come together are one change.

    Args:
        observation: The demo's tracks.
        spaces: Concepts learned so far; the distance concept nearest to none is *at it*.

    Raises:
        PerceptionError: Nothing was moved.
    """
    return shown_action(observation, spaces)[0]


def shown_action(
    observation: Observation, spaces: ConceptSpaces
) -> tuple[ActionGraphlet, list[dict[str, FloatArray]] | None, int]:
    """The graphlet of a demo (`action_of`), the measures of its states, and the index of the manipulated object.

    Measures are those of `action_measures.measured`, or None on the board, where actions are known by key frames.

    Raises:
        PerceptionError: Nothing was moved.
    """
    if observation.extent is not None:
        segmentation = segmented(observation, spaces)
        return segmentation.graphlet, measured(segmentation), segmentation.moved
    moved = moved_object(observation)
    touching = lasting(touches(observation, spaces)[:, moved], SHORTEST_STATE)
    closed = lasting(observation.gripper_closed, SHORTEST_STATE)
    location = lasting(_location_variable(observation, moved), SHORTEST_STATE)
    rows = np.stack([closed, touching, location], axis=1).astype(np.int64)
    rows = without_short_rows(rows, SHORTEST_STATE)
    states = _one_change_at_a_time(GraphletState(bool(c), bool(t), int(at)) for c, t, at in rows)
    return ActionGraphlet.of(_without_idle_ends(list(states))), None, moved


def touches(observation: Observation, spaces: ConceptSpaces) -> NDArray[np.bool_]:
    """Whether the gripper is at each object, per frame, (F, N): their distance concept is the *at it* one."""
    return np.asarray(spaces.predicates("distance", smoothed(gap_offsets(observation))) == spaces.touching)


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


def _without_idle_ends(states: Sequence[GraphletState]) -> Sequence[GraphletState]:
    """Leave out what the hand does far from the object before it comes to it, and after it left it.

    A hand that is away may be open or closed from whatever it did before; only as what it comes, and leaves, matters.
    """
    touching = [index for index, state in enumerate(states) if state.touching]
    if not touching:
        return states
    return states[max(touching[0] - 1, 0) : touching[-1] + 2]


def _location_variable(observation: Observation, moved: int) -> NDArray[np.int64]:
    """0 while the moved object is nearer to its first resting place, 1 when nearer to its last, (F,)."""
    first, last = anchors(observation)
    if np.linalg.norm(last[moved] - first[moved]) <= MOVED:
        return np.zeros(len(observation.times), dtype=np.int64)
    track = smoothed(observation.location[:, moved])
    nearer_last = np.linalg.norm(track - last[moved], axis=1) < np.linalg.norm(track - first[moved], axis=1)
    return np.asarray(nearer_last, dtype=np.int64)
