"""What is true at a table that can be spoken of: looks and places of things, how they stand, and what was done.

Looks, relations and actions are learned concepts. Places are innate measurements, as the sides of the robot's body are:
far and near, left and right, and the middle, told by where things were ever seen to rest; and so is being close to
another thing. No word is innate.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from learning.concept_id import ACTION_SPACE, Concept
from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.table_spaces import ADJACENT
from learning.graphs.action_graphlet import ActionGraphlet
from learning.grounding.kind_sizes import KindSizes
from learning.grounding.sorts import Sorts
from learning.percept import NO_CONCEPT
from learning.perception.observation import Observation
from learning.perception.tracks import anchors
from robots.pose import FloatArray

NOBODY = -1
"""Index of the moved thing where nothing moved."""
PLACE_SPACE = "place"
SIDE_PLACES = tuple(Concept(PLACE_SPACE, number) for number in range(4))
"""Towards +x (away from the robot), -x, +y (to the left) and -y, as seen from the middle of where things rest."""
MIDDLE = Concept(PLACE_SPACE, 4)
"""In the middle in both directions."""
NAMED = "named "
"""Before the name of a space of looks: the sorts that words tell apart there."""
SIZE_SPACE = "size"
"""Nobody speaks of how large a thing is by itself, but of how large it is among its like (`KindSizes`)."""
NEAR_SPACE = "near"
BESIDE = Concept(NEAR_SPACE, 0)
"""Close to another thing, on whichever side."""
CLOSE = 0.2
"""So close are things that are beside each other [m]."""
SUPPORT_SPACE = "support"
OVER = Concept(SUPPORT_SPACE, 0)
"""On another thing, or in it: over its footprint, and higher up or smaller. Such things are not beside one another."""
FOOTPRINT_ERROR = 0.01
"""How wrong the middle of a thing may be that is partly hidden by another [m]."""
ASIDE = 0.5
"""A thing is on a side when it is so many standard deviations of all resting places off their mean,"""
AMID = 0.6
"""and in the middle when it is no more than so many off in each direction."""
FIRST_SPREAD = np.array([0.12, 0.18])
"""Standard deviations of resting places before any were seen [m], worth one sighting."""
FIRST_MEAN = np.array([0.6, 0.0])
"""Their mean before any were seen [m]: within reach, in front of the robot."""


class RestingPlaces:
    """Where on the table things were ever seen to rest: count, mean and spread."""

    def __init__(self, count: float = 1.0, mean: FloatArray | None = None, square: FloatArray | None = None) -> None:
        """Start with what is within reach, or go on from earlier counts.

        Args:
            count: Places seen, the imagined first one among them.
            mean: Their mean, (2,) [m].
            square: Sum of their squared deviations, (2,) [m²].
        """
        self.count = count
        self.mean = FIRST_MEAN.copy() if mean is None else np.asarray(mean, dtype=np.float64)
        self.square = FIRST_SPREAD**2 if square is None else np.asarray(square, dtype=np.float64)

    def add(self, place: FloatArray) -> None:
        """Count a place (3,) [m]."""
        self.count += 1.0
        off = place[:2] - self.mean
        self.mean = self.mean + off / self.count
        self.square = self.square + off * (place[:2] - self.mean)

    def at(self, place: FloatArray) -> frozenset[Concept]:
        """The place concepts that hold at a place (3,) [m]."""
        x, y = (place[:2] - self.mean) / np.sqrt(self.square / self.count)
        told = (x > ASIDE, x < -ASIDE, y > ASIDE, y < -ASIDE, max(abs(x), abs(y)) < AMID)
        return frozenset(side for side, holds in zip((*SIDE_PLACES, MIDDLE), told, strict=True) if holds)


@dataclass(frozen=True, slots=True)
class TableScene:
    """One demo at a table in the learner's symbols.

    Attributes:
        looks: Concepts of what each object is like.
        places: Place concepts of where each object is before the action; none for what is held.
        relations: Pair (i, j) to the concepts of how i is to j before the action.
        moved: Index of the manipulated object.
        action: Number of the action.
        parts: Numbers of the known actions that it contains, itself included.
        goal: Place concepts of where the object ended; none where it was not brought anywhere.
        goal_relations: Other object to the concepts of how the moved one is to it in the end.
        ground: The other object that it ended on, in or nearest to; None where it ended near none.
        unseen: Space of looks to the objects, as a bit mask, of which it was not seen what they are like there.
    """

    looks: tuple[frozenset[Concept], ...]
    places: tuple[frozenset[Concept], ...]
    relations: Mapping[tuple[int, int], frozenset[Concept]]
    moved: int
    action: int
    parts: tuple[int, ...]
    goal: frozenset[Concept]
    goal_relations: Mapping[int, frozenset[Concept]]
    ground: int | None
    unseen: Mapping[str, int]

    def salient(self) -> frozenset[Concept]:
        """Concepts that the action draws attention to: of the moved thing, of where it went and what is there."""
        found = {Concept(ACTION_SPACE, self.action), *self.looks[self.moved], *self.goal}
        if self.ground is not None:
            found |= self.goal_relations[self.ground] | self.looks[self.ground]
        return frozenset(found)

    def masks(self) -> dict[Concept, int]:
        """Concept of looks to the set of objects it is true of, as a bit mask."""
        found: defaultdict[Concept, int] = defaultdict(int)
        for index, concepts in enumerate(self.looks):
            for concept in concepts:
                found[concept] |= 1 << index
        return dict(found)


@dataclass(frozen=True, slots=True)
class TableRecord:
    """What of one demo is kept while its sentences are, to put into symbols again when concepts have changed.

    Attributes:
        looks: Space of looks to the mean embedded value of each object, (N, d); NaN where it was never measured.
        first: Place of each object before the action, (N, 3) [m].
        last: Place of each after it, (N, 3) [m].
        moved: Index of the manipulated object.
        held: Whether it was in the hand from the start.
        brought: Whether it ended at rest in another place.
        action: Number of the action.
        parts: Numbers of the known actions that it contains.
        sides: Length, width and height of each object, (N, 3) [m]; NaN where they were never measured. Without
            them nothing is known to be over another.
    """

    looks: Mapping[str, FloatArray]
    first: FloatArray
    last: FloatArray
    moved: int
    held: bool
    brought: bool
    action: int
    parts: tuple[int, ...]
    sides: FloatArray | None = None

    def pair(self, i: int, j: int) -> FloatArray | None:
        """Sides of two objects, (2, 3) [m]."""
        return None if self.sides is None else self.sides[[i, j]]

    def resting(self) -> Iterator[FloatArray]:
        """Places where things rest, each (3,) [m]."""
        yield from (place for index, place in enumerate(self.first) if index != self.moved or not self.held)
        if self.brought:
            yield self.last[self.moved]


def table_record(
    observation: Observation, spaces: ConceptSpaces, action: int, graphlet: ActionGraphlet, moved: int
) -> TableRecord:
    """Keep of a demo what can be spoken of.

    Args:
        observation: The demo's tracks.
        spaces: Concepts, with the action.
        action: Number of the action.
        graphlet: Its graphlet.
        moved: Index of the manipulated object.
    """
    first, last = anchors(observation)
    begin, end = graphlet.states[0], graphlet.states[-1]
    return TableRecord(
        looks=dict(measured_looks(observation, spaces)),
        first=first,
        last=last,
        moved=moved,
        held=begin.holds,
        brought=not end.raised and not end.holds and end.object_location != begin.object_location,
        action=action,
        parts=tuple(sorted({action, *spaces.actions.parts_of(graphlet)})),
        sides=sides_of(observation),
    )


def table_scene(
    record: TableRecord,
    spaces: ConceptSpaces,
    resting: RestingPlaces,
    sorts: Mapping[str, Sorts],
    sizes: KindSizes | None = None,
) -> TableScene:
    """Put a demo at a table into symbols.

    Args:
        record: What was kept of it.
        spaces: Concepts as they are now.
        resting: Where things rest.
        sorts: Space of looks to the sorts that words tell apart there.
        sizes: How large things of each kind are; without it nothing is small or large among its like.
    """
    first, last, moved = record.first, record.last, record.moved
    others = [index for index in range(len(first)) if index != moved]
    before = {
        (i, j): relation_of(first[i] - first[j], spaces, record.pair(i, j))
        for i in range(len(first))
        for j in others
        if i != j
    }
    after = (
        {j: relation_of(last[moved] - last[j], spaces, record.pair(moved, j)) for j in others} if record.brought else {}
    )
    near = {other: concepts for other, concepts in after.items() if concepts}
    away = {other: float(np.linalg.norm(last[moved] - last[other])) for other in near}
    numbers = _all_numbers(record.looks, spaces, sorts)
    return TableScene(
        looks=tuple(
            frozenset(
                Concept(name, int(row[index]))
                for name, row in numbers.items()
                if row[index] != NO_CONCEPT and name != SIZE_SPACE
            )
            | _among_kind(index, numbers, record.looks, sizes)
            for index in range(len(first))
        ),
        places=tuple(
            frozenset() if record.held and index == moved else resting.at(place) for index, place in enumerate(first)
        ),
        relations={pair: concepts for pair, concepts in before.items() if concepts},
        moved=moved,
        action=spaces.actions.resolve(record.action),
        parts=tuple(sorted({spaces.actions.resolve(part) for part in record.parts})),
        goal=resting.at(last[moved]) if record.brought else frozenset(),
        goal_relations=near,
        unseen=_unseen(numbers),
        ground=min(near, key=lambda other: (OVER not in near[other], away[other]), default=None),
    )


def kinds_and_sizes(
    record: TableRecord, spaces: ConceptSpaces, sorts: Mapping[str, Sorts]
) -> Iterator[tuple[Concept, float]]:
    """Kind and size of each object of which both are known: concept of its shape, logarithm of its size."""
    numbers = _all_numbers(record.looks, spaces, sorts)
    for index in range(len(record.first)):
        found = _kind_and_size(index, numbers, record.looks)
        if found is not None:
            yield found


def _kind_and_size(
    index: int, numbers: Mapping[str, NDArray[np.int64]], looks: Mapping[str, FloatArray]
) -> tuple[Concept, float] | None:
    size = float(looks[SIZE_SPACE][index, 0]) if SIZE_SPACE in looks else np.nan
    for name in ("shape", f"{NAMED}shape"):
        if name in numbers and numbers[name][index] != NO_CONCEPT and np.isfinite(size):
            return Concept(name, int(numbers[name][index])), size
    return None


def _among_kind(
    index: int, numbers: Mapping[str, NDArray[np.int64]], looks: Mapping[str, FloatArray], sizes: KindSizes | None
) -> frozenset[Concept]:
    """Whether an object is small or large among its like."""
    known = None if sizes is None else _kind_and_size(index, numbers, looks)
    told = None if known is None or sizes is None else sizes.among(*known)
    return frozenset() if told is None else frozenset((told,))


def looks_of(
    observation: Observation, spaces: ConceptSpaces, sorts: Mapping[str, Sorts]
) -> dict[str, NDArray[np.int64]]:
    """Number of each object in each space of looks, and of its sort, (N,); `NO_CONCEPT` where there is none."""
    return _all_numbers(dict(measured_looks(observation, spaces)), spaces, sorts)


def _all_numbers(
    looks: Mapping[str, FloatArray], spaces: ConceptSpaces, sorts: Mapping[str, Sorts]
) -> dict[str, NDArray[np.int64]]:
    """Space of looks to numbers, (N,), and space of sorts to theirs where words tell things of one concept apart."""
    found = {}
    for name, values in looks.items():
        found[name] = _numbers(values, name, spaces)
        if name in sorts and len(sorts[name].means):
            homes = _numbers(np.array(sorts[name].means), name, spaces)
            found[f"{NAMED}{name}"] = sorts[name].told_apart(values, found[name], homes)
            found[name] = np.where(found[f"{NAMED}{name}"] == NO_CONCEPT, found[name], NO_CONCEPT)
    return found


def _unseen(numbers: Mapping[str, NDArray[np.int64]]) -> dict[str, int]:
    """Space of looks, also of sorts, to the objects that have no concept there, as a bit mask; only spaces with any."""
    found = {}
    for name, row in numbers.items():
        other = numbers.get(f"{NAMED}{name.removeprefix(NAMED)}", row)
        missing = (numbers[name.removeprefix(NAMED)] == NO_CONCEPT) & (other == NO_CONCEPT)
        if np.any(missing):
            found[name] = sum(1 << int(index) for index in np.flatnonzero(missing))
    return found


def still_record(
    observation: Observation, spaces: ConceptSpaces, places: FloatArray, held: int | None = None
) -> TableRecord:
    """Keep of a table what can be spoken of while nothing is moved.

    Args:
        observation: What is seen.
        spaces: Concepts.
        places: Where things are, (N, 3) [m].
        held: Index of what is in the hand.
    """
    return TableRecord(
        looks=dict(measured_looks(observation, spaces)),
        first=places,
        last=places,
        moved=NOBODY if held is None else held,
        held=held is not None,
        brought=False,
        action=0,
        parts=(),
        sides=sides_of(observation),
    )


def _numbers(embedded: FloatArray, name: str, spaces: ConceptSpaces) -> NDArray[np.int64]:
    """Concept number of each embedded value, (N,)."""
    mixture = spaces.mixtures[name]
    numbers = np.full(len(embedded), NO_CONCEPT, dtype=np.int64)
    known = np.all(np.isfinite(embedded), axis=1)
    if mixture.components and np.any(known):
        numbers[known] = mixture.classify(embedded[known])
    return numbers


def measured_looks(observation: Observation, spaces: ConceptSpaces) -> Iterator[tuple[str, FloatArray]]:
    """Space of looks and the mean embedded value of each object over the frames in which it was seen, (N, d)."""
    for name, mixture in spaces.mixtures.items():
        values = None if mixture.space.relation or name == "location" else mixture.space.measured(observation)
        if values is None or values.shape[1] == 0:
            continue
        embedded = mixture.space.embed(values)
        known = np.all(np.isfinite(embedded), axis=2)
        if observation.visible is not None:
            seen = known & observation.visible
            known = np.where(np.any(seen, axis=0), seen, known)
        times = np.count_nonzero(known, axis=0)[:, None]
        total = np.sum(np.where(known[..., None], embedded, 0.0), axis=0)
        yield name, np.divide(total, times, out=np.full_like(total, np.nan), where=times > 0)


def sides_of(observation: Observation) -> FloatArray:
    """Length, width and height of each object, (N, 3) [m]: medians of when it was seen."""
    count = len(observation.object_ids)
    if observation.extent is None or not len(observation.extent):
        return np.full((count, 3), np.nan)
    seen = np.isfinite(observation.extent)
    if observation.visible is not None:
        visible = seen & observation.visible[..., None]
        seen = np.where(np.any(visible, axis=0), visible, seen)
    sides = np.full((count, 3), np.nan)
    for index in np.flatnonzero(np.any(seen, axis=(0, 2))):
        frames = np.all(seen[:, index], axis=1)
        if np.any(frames):
            sides[index] = np.median(observation.extent[frames, index], axis=0)
    return sides


def relation_of(offset: FloatArray, spaces: ConceptSpaces, sides: FloatArray | None = None) -> frozenset[Concept]:
    """Relation concepts of one thing to another.

    Args:
        offset: From the other to the one, (3,) [m].
        spaces: Concepts.
        sides: Of the one and of the other, (2, 3) [m]; without them nothing is over another.

    Returns:
        That it is over the other; else its direction, and whether it is close; none for things far apart.
    """
    length = float(np.linalg.norm(offset))
    if length > ADJACENT:
        return frozenset()
    if sides is not None and _is_over(offset, sides[0], sides[1]):
        return frozenset((OVER,))
    beside = {BESIDE} if length <= CLOSE else set()
    if not spaces.mixtures["direction"].components:
        return frozenset(beside)
    return frozenset((*beside, Concept("direction", int(spaces.predicates("direction", offset[None])[0]))))


def _is_over(offset: FloatArray, one: FloatArray, other: FloatArray) -> bool:
    """Whether a thing with sides `one` (3,) is on or in another, at an offset (3,) from it [m]."""
    inside = float(np.hypot(offset[0], offset[1])) <= 0.5 * float(other[1]) + FOOTPRINT_ERROR
    return inside and bool(offset[2] > 0.5 * other[2] or one[1] < other[1])
