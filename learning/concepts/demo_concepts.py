"""All that concept learning takes from one demo: its own mixture in every feature space."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import ThreadpoolController

from learning.concepts.demo_mixture import fit_mixture
from learning.concepts.feature_space import NEAR, FeatureSpace
from learning.concepts.gaussian import Gaussian
from learning.concepts.space_set import BOARD, SpaceSet
from learning.concepts.track_noise import TrackNoise
from learning.errors import PerceptionError
from learning.perception.gaps import gap_offsets
from learning.perception.observation import Observation
from learning.perception.tracks import moved_object, resting_track
from robots.pose import FloatArray

HELD_FRAMES = 16
"""Frames with a closed gripper that tell how far the gripper is from what it holds."""
MOST_POINTS = 400
"""Values of a space that are clustered at most, drawn at random, so that a crowded scene takes no longer."""
MOST_DISTANCES = 60
"""Distances between objects that are clustered at most, beside the score between gripper and object."""

Values = tuple[FloatArray, NDArray[np.int64]]
Labels = Mapping[int, Mapping[str, str]]
"""What a user says of some objects: track number (`Observation.object_ids`) to feature space to a name."""


@dataclass(frozen=True, slots=True)
class DemoConcepts:
    """The mixtures of one demo, before they are merged with what is known.

    Attributes:
        components: Feature space name to the components found in the demo.
        noise: Feature space name to the scatter within tracks, of spaces that learn from it.
        names: Feature space name to what a user calls each component, of spaces in which something was said.
    """

    components: Mapping[str, tuple[Gaussian, ...]]
    noise: Mapping[str, TrackNoise] = field(default_factory=dict)
    names: Mapping[str, tuple[str | None, ...]] = field(default_factory=dict)


def fit_demo(
    observation: Observation,
    rng: np.random.Generator,
    spaces: SpaceSet = BOARD,
    labels: Labels | None = None,
) -> DemoConcepts:
    """Cluster the feature values of one demo in every feature space (thesis 3.3, GMM with BIC).

    A pure function of its arguments, so that its result can be kept and merged into several `ConceptSpaces`.

    A few labels help where kinds look alike (thesis 6.3.2). `{3: {"colour": "red", "shape": "mug"}}` says of object 3
    what it is called: what is called the same becomes one concept, what is called differently never does.

    Args:
        observation: The demo's tracks.
        rng: Draws values where there are more than are clustered.
        spaces: The feature spaces.
        labels: What a user says of some of the objects.

    Raises:
        PerceptionError: A label is about an object or a feature space that is not there.
    """
    _check_labels(labels or {}, observation, spaces)
    values = feature_values(observation, rng, spaces)
    frames, resting = _looked_at(observation, spaces), resting_track(observation)
    number = len(observation.object_ids)
    components, noise, names = {}, {}, {}
    with threadpools().limit(limits=1):  # threads cost five times what these small matrices take
        for name, (points, tracks) in values.items():
            space = spaces.space(name)
            if len(points) > MOST_POINTS:
                chosen = np.sort(rng.choice(len(points), MOST_POINTS, replace=False))
                points, tracks = points[chosen], tracks[chosen]
            if space.kinds == "learned":
                noise[name] = TrackNoise.within(*_property_values(observation, space, frames, resting, glimpsed=True))
            called = {} if space.relation else _names_by_object(labels or {}, observation, name)
            if not called:
                components[name] = fit_mixture(points, tracks, space)
                continue
            # What was said of one object is not said of others that look like it: it is fitted by itself.
            own = tracks % number
            rest = ~np.isin(own, list(called))
            parts: list[tuple[Gaussian, str | None]] = []
            parts += [(each, None) for each in fit_mixture(points[rest], tracks[rest], space)]
            for thing, said in called.items():
                parts += [(each, said) for each in fit_mixture(points[own == thing], 0 * tracks[own == thing], space)]
            components[name] = tuple(each for each, _ in parts)
            names[name] = tuple(said for _, said in parts)
    return DemoConcepts(components, noise, names)


@cache
def threadpools() -> ThreadpoolController:
    """The thread pools of the linear algebra libraries, looked up once."""
    return ThreadpoolController()


def feature_values(observation: Observation, rng: np.random.Generator, spaces: SpaceSet = BOARD) -> dict[str, Values]:
    """Embedded values to cluster and the track of each, by feature space.

    Properties and relations are those of objects at rest: a place is where something rests, and what a carried object
    flies past is no relation. Values that were not measured are left out. Distance holds near pairs of objects, and the
    gripper with the object it manipulates.
    """
    frames = _looked_at(observation, spaces)
    resting = resting_track(observation)
    values = {space.name: _property_values(observation, space, frames, resting) for space in spaces.properties}
    for space in spaces.relations:
        pair, offsets = _near_pairs(observation.location[frames], resting[frames], space.farthest)
        if space.name != "distance":
            values[space.name] = space.embed(offsets), pair
            continue
        wide = 2 * len(observation.object_ids)
        once = np.flatnonzero(pair // wide < pair % wide)  # distance has no sense of direction: each pair once
        # Few of them, lest the many pairs of a crowded scene drown the gripper's values.
        once = once if len(once) <= MOST_DISTANCES else np.sort(rng.choice(once, MOST_DISTANCES, replace=False))
        gripper, gripper_track = _gripper_offsets(observation)
        distance = space.embed(np.concatenate([offsets[once], gripper]))
        values[space.name] = distance, np.concatenate([pair[once], gripper_track])
    return values


def _looked_at(observation: Observation, spaces: SpaceSet) -> NDArray[np.int64]:
    """Frames whose values are clustered."""
    return np.unique(np.linspace(0, len(observation.times) - 1, spaces.frames).round().astype(int))


def _property_values(
    observation: Observation,
    space: type[FeatureSpace],
    frames: NDArray[np.int64],
    resting: NDArray[np.int64],
    glimpsed: bool = False,
) -> Values:
    """Embedded values (n, d) of a property and the track of each, (n,), where it was seen and measured."""
    number = len(observation.object_ids)
    measured = space.glimpsed(observation) if glimpsed else space.measured(observation)
    if measured is None or number == 0:
        return np.zeros((0, space.dimension)), np.zeros(0, dtype=np.int64)
    if space.in_motion:
        known = np.all(np.isfinite(measured), axis=2)
        rows = np.flatnonzero(np.any(known, axis=1))
        frames = rows[np.unique(np.linspace(0, len(rows) - 1, len(frames)).round().astype(int))] if len(rows) else rows
        resting = np.tile(np.arange(number), (len(resting), 1))
    track = resting[frames]
    if observation.visible is not None:
        track = np.where(observation.visible[frames], track, -1)
    frame, obj = np.nonzero(track >= 0)
    points = space.embed(measured[frames[frame], obj])
    tracks = track[frame, obj] % number if space.of_object else track[frame, obj]
    known = np.all(np.isfinite(points), axis=1)
    return points[known], tracks[known]


def _check_labels(labels: Labels, observation: Observation, spaces: SpaceSet) -> None:
    """Raise unless all labels are about something that is there."""
    ids = observation.object_ids.tolist()
    properties = [space.name for space in spaces.properties]
    for thing, said in labels.items():
        if thing not in ids:
            raise PerceptionError(f"a label is about object {thing}; the demo's objects are {ids}")
        for name in said:
            if name not in properties:
                raise PerceptionError(f"a label is about '{name}'; properties are {', '.join(properties)}")


def _names_by_object(labels: Labels, observation: Observation, space: str) -> dict[int, str]:
    """Index of each object of which something was said in a feature space, and what."""
    ids = observation.object_ids.tolist()
    return {ids.index(thing): said[space] for thing, said in labels.items() if space in said}


def _near_pairs(
    location: FloatArray, track: NDArray[np.int64], farthest: float
) -> tuple[NDArray[np.int64], FloatArray]:
    """Ordered pairs of near objects at rest: a number for each pair of resting places, (n,), and offsets, (n, 3) [m].

    Whether a pair is near is decided once, by its mean offset: decided frame by frame, noise would let the pairs just
    out of reach in whenever they look nearer than they are.

    Args:
        location: Object centres, (F, N, 3) [m].
        track: Resting place of each, -1 for none, (F, N).
        farthest: Objects further apart are not near [m].
    """
    number = location.shape[1]
    offset = location[:, :, None] - location[:, None]  # [f, i, j]: i as seen from j
    related = np.linalg.norm(offset, axis=3) < 1.2 * farthest
    related &= (track[:, :, None] >= 0) & (track[:, None, :] >= 0) & ~np.eye(number, dtype=bool)
    frame, i, j = np.nonzero(related)
    names, pair = np.unique(2 * number * track[frame, i] + track[frame, j], return_inverse=True)
    offsets = offset[frame, i, j]
    sums = np.zeros((len(names), 3))
    np.add.at(sums, pair, offsets)
    near = np.linalg.norm(sums / np.bincount(pair, minlength=len(names))[:, None], axis=1) < farthest
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
    offset = gap_offsets(observation)[:, moved]
    last = len(observation.times) - 1
    held = np.flatnonzero(observation.gripper_closed)
    held = held[np.unique(np.linspace(0, len(held) - 1, HELD_FRAMES).round().astype(int))] if len(held) else held
    ends = np.unique([0, min(1, last), max(0, last - 1), last])
    chosen = np.unique(np.concatenate([held, ends]))
    # A track that is near and far in turn is no mode of its own: number the near and the far part apart.
    far = np.linalg.norm(offset[chosen], axis=1) > NEAR
    return offset[chosen], np.where(observation.gripper_closed[chosen], -1, -2) - 2 * far
