"""Concept numbers of every object and pair in every frame of a demo that a camera saw (thesis 3.3.4)."""

import numpy as np
from numpy.typing import NDArray

from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.feature_space import NEAR, RELATIONS
from learning.graphs.camera_states import STATE_TIME, Segmentation, frame_period
from learning.graphs.concept_chain import lasting_concepts
from learning.graphs.graphlets import ConceptNumber
from learning.percept import NO_CONCEPT
from learning.perception.gaps import gap_offsets
from learning.perception.handling import bounded
from learning.perception.track_noise import track_noise
from learning.perception.tracks import anchors, moved_distance
from robots.pose import FloatArray

FARTHEST = 3.0 * NEAR
"""Objects whose centres are further apart than this do not relate [m], whatever a feature space says."""
Row = dict[str, NDArray[np.int64]]
"""Feature space to the concept number in each frame, (F,)."""


class CameraPredicates:
    """What holds in each frame, smoothed; any number of objects, each seen or hidden.

    Properties of looks are those of all frames together. An object that rests has one place, a pair of them one
    relation: the medians over the frames in which they are seen. Of what moves, and of the hand, each predicate is a
    hidden Markov model over its concepts.

    Attributes:
        number: Objects N.
        closed: Whether the gripper is closed, (F,).
        location: Concept number of the place of each object, the gripper last, (F, N + 1).
        looks: Feature space to the concept number of each object, (N,).
        relations: Pair (i, j), i as seen from j and i = N the gripper, to its concept numbers.
    """

    def __init__(self, segmentation: Segmentation, spaces: ConceptSpaces) -> None:
        """Find all concept numbers of a demo."""
        self._observation = observation = segmentation.observation
        self._spaces = spaces
        self._expected = max(STATE_TIME / frame_period(observation), 2.0)
        self.number = len(observation.object_ids)
        self.closed = np.zeros(len(observation.times), dtype=bool)
        for segment in segmentation.segments:
            self.closed[segment.start : segment.stop] = segment.state.gripper_closed
        first, last = anchors(observation)
        still = np.linalg.norm(last - first, axis=1) <= moved_distance(observation)
        still[segmentation.moved] = False
        track = self._track(still)
        everything = np.concatenate([track, observation.gripper_location[:, None]], axis=1)
        self.location = np.stack(
            [
                self._concepts("location", everything[:, i], i < self.number and still[i])
                for i in range(self.number + 1)
            ],
            axis=1,
        )
        self.looks = self._looks()
        self.relations: dict[tuple[int, int], Row] = {}
        for j in range(self.number):
            for i in range(self.number):
                if i != j:
                    self._relate(i, j, everything[:, i] - track[:, j], constant=bool(still[i] and still[j]))
        moved = segmentation.moved
        self._relate_gripper(moved, observation.gripper_location - track[:, moved])

    def rows(self) -> NDArray[np.int64]:
        """One row a frame with all that may change, (F, m)."""
        relations = [numbers for row in self.relations.values() for numbers in row.values()]
        return np.column_stack([self.closed.astype(np.int64), self.location, *relations])

    def objects(self, frame: int) -> dict[int, tuple[ConceptNumber, ...]]:
        """Concepts of each object in a frame."""
        return {
            index: (
                *((name, int(numbers[index])) for name, numbers in self.looks.items() if numbers[index] != NO_CONCEPT),
                ("location", int(self.location[frame, index])),
            )
            for index in range(self.number)
        }

    def pairs(self, frame: int) -> dict[tuple[int, int], tuple[ConceptNumber, ...]]:
        """Concepts of each pair that relates in a frame."""
        found = {
            pair: tuple((name, int(row[name][frame])) for name in row if row[name][frame] != NO_CONCEPT)
            for pair, row in self.relations.items()
        }
        return {pair: concepts for pair, concepts in found.items() if concepts}

    def _track(self, still: NDArray[np.bool_]) -> FloatArray:
        """Object centres, (F, N, 3) [m]; of what rests, the median over the frames in which it was seen."""
        track = self._observation.location.copy()
        for index in np.flatnonzero(still):
            values = track[:, index]
            if self._observation.visible is not None and np.any(self._observation.visible[:, index]):
                values = values[self._observation.visible[:, index]]
            track[:, index] = np.median(values, axis=0)
        return track

    def _looks(self) -> dict[str, NDArray[np.int64]]:
        """Concept number of each object in each space of looks; `NO_CONCEPT` where it was never measured."""
        looks = {}
        for name, mixture in self._spaces.mixtures.items():
            values = None if mixture.space.relation or name == "location" else mixture.space.measured(self._observation)
            if values is None or not mixture.components:
                continue
            embedded = mixture.space.embed(values)
            numbers = np.full(self.number, NO_CONCEPT, dtype=np.int64)
            for index in range(self.number):
                known = np.all(np.isfinite(embedded[:, index]), axis=1)
                if self._observation.visible is not None and np.any(known & self._observation.visible[:, index]):
                    known &= self._observation.visible[:, index]
                if np.any(known):
                    numbers[index] = int(mixture.classify(embedded[known, index].mean(axis=0)))
            looks[name] = numbers
        return looks

    def _relate(self, i: int, j: int, offset: FloatArray, *, constant: bool) -> None:
        """Direction and distance of object i as seen from object j, where they are near enough to relate."""
        far = min(self._spaces.mixtures["direction"].space.farthest, FARTHEST)
        noise = track_noise(self._observation)
        spread = np.sqrt(2.0 * (noise[i] ** 2 + noise[j] ** 2))
        near = bounded((far - np.linalg.norm(offset, axis=1)) / spread)
        if np.all(near < 0.0):
            return
        self.relations[i, j] = {name: self._concepts(name, offset, constant, near) for name in RELATIONS}

    def _relate_gripper(self, moved: int, offset: FloatArray) -> None:
        """Direction of the gripper as seen from the manipulated object, and their distance, face to point."""
        gap = gap_offsets(self._observation)[:, moved]
        self.relations[self.number, moved] = {
            "direction": self._concepts("direction", offset, constant=False),
            "distance": self._concepts("distance", gap, constant=False),
        }

    def _concepts(
        self, name: str, values: FloatArray, constant: bool, related: FloatArray | None = None
    ) -> NDArray[np.int64]:
        """Concept number of a feature space in each frame, (F,)."""
        mixture = self._spaces.mixtures[name]
        embedded = mixture.space.embed(values)
        if not constant:
            return lasting_concepts(embedded, mixture, self._expected, related)
        number = int(mixture.classify(embedded[:1])[0]) if mixture.components else NO_CONCEPT
        return np.full(len(values), number if related is None or related[0] > 0.0 else NO_CONCEPT, dtype=np.int64)
