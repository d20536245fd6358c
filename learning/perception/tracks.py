"""What tracks say by themselves: where things rest, and which object was moved."""

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from learning.perception.observation import Observation
from robots.pose import FloatArray

ANCHOR_FRAMES = 3
"""First and last frames that are averaged into an object's first and last resting place."""
REST_RADIUS = 0.012
"""Within this of its first or last place an object is at rest [m]: four standard deviations of the board's noise."""
MOVED = 0.018
"""An object was moved if its first and last places are further apart [m]: half a block."""


def anchors(observation: Observation) -> tuple[FloatArray, FloatArray]:
    """First and last place of every object, each (N, 3) [m], averaged over the first and last frames."""
    frames = min(ANCHOR_FRAMES, len(observation.times))
    return observation.location[:frames].mean(axis=0), observation.location[-frames:].mean(axis=0)


def at_rest(observation: Observation) -> NDArray[np.bool_]:
    """Whether each object is where it was first or last seen, (F, N). What is in between is on its way."""
    first, last = anchors(observation)
    off_first = np.linalg.norm(observation.location - first, axis=2)
    off_last = np.linalg.norm(observation.location - last, axis=2)
    return np.asarray(np.minimum(off_first, off_last) < REST_RADIUS)


def at_start(observation: Observation) -> NDArray[np.bool_]:
    """Whether each object is still where it was first seen, (F, N). True for the first frame always."""
    first, _ = anchors(observation)
    still = np.linalg.norm(observation.location - first, axis=2) < REST_RADIUS
    still[0] = True
    return np.asarray(still)


def resting_track(observation: Observation) -> NDArray[np.int64]:
    """Number of the resting place of each object in each frame, (F, N): object i rests at i first and at N + i last.

    -1 where it is on its way. An object that was not moved rests at its first place throughout.
    """
    first, last = anchors(observation)
    number = len(observation.object_ids)
    nearer_last = np.linalg.norm(observation.location - last, axis=2) < np.linalg.norm(
        observation.location - first, axis=2
    )
    moved = np.linalg.norm(last - first, axis=1) > MOVED
    tracks = np.arange(number) + number * (nearer_last & moved)
    return np.where(at_rest(observation), tracks, -1)


def moved_object(observation: Observation) -> int:
    """Index of the manipulated object: the one whose place changed most, else the one the closed gripper carried.

    Raises:
        PerceptionError: Nothing was moved or held.
    """
    if len(observation.object_ids) == 0:
        raise PerceptionError("the demo shows no object: nothing to learn an action from")
    first, last = anchors(observation)
    shift = np.linalg.norm(last - first, axis=1)
    moved = int(np.argmax(shift))
    if shift[moved] > MOVED:
        return moved
    closed = observation.gripper_closed
    if np.any(closed):
        # Carried away and put back: closest to the closed gripper on the whole.
        away = np.linalg.norm(observation.location[closed] - observation.gripper_location[closed][:, None], axis=2)
        nearest = int(np.argmin(away.mean(axis=0)))
        if away[:, nearest].mean() < MOVED:
            return nearest
    raise PerceptionError(
        f"no object was moved: the largest change of place is {1000 * shift[moved]:.0f} mm, "
        f"and less than {1000 * MOVED:.0f} mm counts as none"
    )
