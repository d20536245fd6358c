"""All that concept learning takes from one demo: its own mixture in every feature space."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

from learning.concepts.demo_mixture import fit_mixture
from learning.concepts.feature_space import FEATURE_SPACES, NEAR
from learning.concepts.gaussian import Gaussian
from learning.errors import PerceptionError
from learning.perception.observation import Observation
from learning.perception.tracks import moved_object, resting_track
from robots.pose import FloatArray

FRAMES = 8
"""Frames of a demo whose values are clustered, spread evenly: what rests looks the same in all the others."""
HELD_FRAMES = 16
"""Frames with a closed gripper that tell how far the gripper is from what it holds."""
MOST_POINTS = 400
"""Values of a space that are clustered at most, drawn at random, so that a crowded scene takes no longer."""
MOST_DISTANCES = 60
"""Distances between objects that are clustered at most, beside the score between gripper and object."""

Values = tuple[FloatArray, NDArray[np.int64]]


@dataclass(frozen=True, slots=True)
class DemoConcepts:
    """The mixtures of one demo, before they are merged with what is known.

    Attributes:
        components: Feature space name to the components found in the demo.
    """

    components: Mapping[str, tuple[Gaussian, ...]]


def fit_demo(observation: Observation, rng: np.random.Generator) -> DemoConcepts:
    """Cluster the feature values of one demo in every feature space (thesis 3.3, GMM with BIC).

    A pure function of its arguments, so that its result can be kept and merged into several `ConceptSpaces`.

    Args:
        observation: The demo's tracks.
        rng: Draws values where there are more than are clustered.
    """
    values = feature_values(observation, rng)
    components = {}
    with _threadpools().limit(limits=1):  # threads cost five times what these small matrices take
        for name, (points, tracks) in values.items():
            if len(points) > MOST_POINTS:
                chosen = np.sort(rng.choice(len(points), MOST_POINTS, replace=False))
                points, tracks = points[chosen], tracks[chosen]
            components[name] = fit_mixture(points, tracks, FEATURE_SPACES[name])
    return DemoConcepts(components)


@cache
def _threadpools() -> ThreadpoolController:
    """The thread pools of the linear algebra libraries, looked up once."""
    return ThreadpoolController()


def feature_values(observation: Observation, rng: np.random.Generator) -> dict[str, Values]:
    """Embedded values to cluster and the track of each, by feature space.

    Properties and relations are those of objects at rest: a place is where something rests, and what a carried object
    flies past is no relation. Distance holds near pairs of objects, and the gripper with the object it manipulates.
    """
    frames = np.unique(np.linspace(0, len(observation.times) - 1, FRAMES).round().astype(int))
    track = resting_track(observation)[frames]
    frame, obj = np.nonzero(track >= 0)
    picked, tracks = frames[frame], track[frame, obj]
    measured = {
        "colour": observation.colour[picked, obj],
        "shape": observation.shape[picked, obj],
        "location": observation.location[picked, obj],
    }
    values = {name: (FEATURE_SPACES[name].embed(value), tracks) for name, value in measured.items()}

    pair, offsets = _near_pairs(observation.location[frames], track)
    values["direction"] = FEATURE_SPACES["direction"].embed(offsets), pair
    wide = 2 * len(observation.object_ids)
    once = np.flatnonzero(pair // wide < pair % wide)  # distance has no sense of direction: each pair once
    # Few of them, lest the many pairs of a crowded scene drown the gripper's values.
    once = once if len(once) <= MOST_DISTANCES else np.sort(rng.choice(once, MOST_DISTANCES, replace=False))
    gripper, gripper_track = _gripper_offsets(observation)
    distance = FEATURE_SPACES["distance"].embed(np.concatenate([offsets[once], gripper]))
    values["distance"] = distance, np.concatenate([pair[once], gripper_track])
    return values


def _near_pairs(location: FloatArray, track: NDArray[np.int64]) -> tuple[NDArray[np.int64], FloatArray]:
    """Ordered pairs of near objects at rest: a number for each pair of resting places, (n,), and offsets, (n, 3) [m].

    Whether a pair is near is decided once, by its mean offset: decided frame by frame, noise would let the pairs just
    out of reach in whenever they look nearer than they are.

    Args:
        location: Object centres, (F, N, 3) [m].
        track: Resting place of each, -1 for none, (F, N).
    """
    number = location.shape[1]
    offset = location[:, :, None] - location[:, None]  # [f, i, j]: i as seen from j
    related = np.linalg.norm(offset, axis=3) < 1.2 * NEAR
    related &= (track[:, :, None] >= 0) & (track[:, None, :] >= 0) & ~np.eye(number, dtype=bool)
    frame, i, j = np.nonzero(related)
    names, pair = np.unique(2 * number * track[frame, i] + track[frame, j], return_inverse=True)
    offsets = offset[frame, i, j]
    sums = np.zeros((len(names), 3))
    np.add.at(sums, pair, offsets)
    near = np.linalg.norm(sums / np.bincount(pair, minlength=len(names))[:, None], axis=1) < NEAR
    keep = near[pair]
    return names[pair][keep], offsets[keep]


def _gripper_offsets(observation: Observation) -> tuple[FloatArray, NDArray[np.int64]]:
    """Offsets of the manipulated object from the gripper, (n, 3) [m], and a track number for each, (n,).

    Taken while the gripper is closed, and at both ends of the demo; on the way there it passes through all distances.
    """
    try:
        moved = moved_object(observation)
    except PerceptionError:  # a scene in which nothing happens still teaches what things look like
        return np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
    offset = observation.location[:, moved] - observation.gripper_location
    last = len(observation.times) - 1
    held = np.flatnonzero(observation.gripper_closed)
    held = held[np.unique(np.linspace(0, len(held) - 1, HELD_FRAMES).round().astype(int))] if len(held) else held
    ends = np.unique([0, min(1, last), max(0, last - 1), last])
    chosen = np.unique(np.concatenate([held, ends]))
    # A track that is near and far in turn is no mode of its own: number the near and the far part apart.
    far = np.linalg.norm(offset[chosen], axis=1) > NEAR
    return offset[chosen], np.where(observation.gripper_closed[chosen], -1, -2) - 2 * far
