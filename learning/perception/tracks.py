"""What tracks say by themselves: where things rest, and which object was moved."""

import numpy as np
from numpy.typing import NDArray

from learning.errors import PerceptionError
from learning.perception.handling import FIRST_FRAMES, handled_evidence
from learning.perception.observation import Observation
from learning.perception.track_noise import track_noise
from robots.pose import FloatArray

ANCHOR_FRAMES = 3
"""First and last frames that are averaged into an object's first and last resting place."""
REST_RADIUS = 0.012
"""Within this of its first or last place an object is at rest [m]: four standard deviations of the board's noise."""
MOVED = 0.018
"""An object was moved if its first and last places are further apart [m]: half a block."""
SIGMAS = 3.0
"""Standard deviations of a camera's noise that count as none."""
LEAST_EVIDENCE = 6.0
"""Evidence that a camera's track must give for its object being handled [nats]: three clear frames."""


def anchors(observation: Observation) -> tuple[FloatArray, FloatArray]:
    """First and last place of every object, each (N, 3) [m], averaged over the first and last frames."""
    if observation.extent is not None:  # medians, as a camera's tracks flicker
        first, last = observation.location[:FIRST_FRAMES], observation.location[-FIRST_FRAMES:]
        return np.median(first, axis=0), np.median(last, axis=0)
    frames = min(ANCHOR_FRAMES, len(observation.times))
    return observation.location[:frames].mean(axis=0), observation.location[-frames:].mean(axis=0)


def rest_radius(observation: Observation) -> FloatArray:
    """Within how much of its place each object is at rest, (N,) [m]: `REST_RADIUS`, more where tracks are noisier."""
    noise = np.zeros(observation.location.shape[1]) if observation.extent is None else track_noise(observation)
    return np.maximum(REST_RADIUS, SIGMAS * noise)


def moved_distance(observation: Observation) -> FloatArray:
    """How much each object's place must change for it to have moved, (N,) [m]: `MOVED`, more where tracks are noisier.

    Both places are medians of a few frames, so that their noise is the smaller.
    """
    noise = np.zeros(observation.location.shape[1]) if observation.extent is None else track_noise(observation)
    return np.asarray(np.maximum(MOVED, SIGMAS * noise * np.sqrt(2.0 / FIRST_FRAMES)))


def at_rest(observation: Observation) -> NDArray[np.bool_]:
    """Whether each object is where it was first or last seen, (F, N). What is in between is on its way."""
    first, last = anchors(observation)
    off_first = np.linalg.norm(observation.location - first, axis=2)
    off_last = np.linalg.norm(observation.location - last, axis=2)
    return np.asarray(np.minimum(off_first, off_last) < rest_radius(observation))


def at_start(observation: Observation) -> NDArray[np.bool_]:
    """Whether each object is still where it was first seen, (F, N). True for the first frame always."""
    first, _ = anchors(observation)
    still = np.linalg.norm(observation.location - first, axis=2) < rest_radius(observation)
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
    moved = np.linalg.norm(last - first, axis=1) > moved_distance(observation)
    tracks = np.arange(number) + number * (nearer_last & moved)
    return np.where(at_rest(observation), tracks, -1)


def moved_object(observation: Observation) -> int:
    """Index of the manipulated object: the one whose place changed most, else the one the closed gripper carried.

    Where a camera saw the demo: the one whose track is best explained by being handled, be it moved, held or touched.

    Raises:
        PerceptionError: Nothing was moved or held, or touched.
    """
    if len(observation.object_ids) == 0:
        raise PerceptionError("the demo shows no object: nothing to learn an action from")
    if observation.extent is not None:
        evidence = handled_evidence(observation)
        handled = int(np.argmax(evidence))
        if evidence[handled] > LEAST_EVIDENCE:
            return handled
        raise PerceptionError(
            f"no object was handled: the largest evidence for it is {evidence[handled]:.1f} nats, "
            f"and less than {LEAST_EVIDENCE:.0f} counts as none"
        )
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
