"""Where on a table a goal can be met: places that are what the words say, free, and well inside what is meant."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from learning.concept_id import Concept
from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.gaussian import Gaussian
from learning.concepts.table_spaces import ADJACENT
from learning.grounding.table_scene import MIDDLE, OVER, SIDE_PLACES, RestingPlaces, relation_of
from learning.interpretation.table_interpreter import TableGoal
from robots.pose import FloatArray
from twin.objects.overlap import half_width

ROOM = 0.02
"""Room between a thing that is put down and any other, seen from above [m];"""
LEAST_ROOM = 0.008
"""with less than this it is not put there at all."""
STEP = 0.02
"""Grid of places that are looked at [m]."""
STEEP = 0.7
"""A direction whose sine of altitude is larger leads onto or into a thing."""
WELL_INSIDE = 1.2
"""On a side of the table is best so many standard deviations off the middle of all resting places."""
FARTHEST = 2.0
"""Nothing is put further off than so many of them."""
SPOTS = 4
"""Places that are tried for one goal."""
FIRST_SPOTS = 40
"""The best of all places, from which those are taken"""
APART = 0.05
"""so far apart [m]."""
OUTLINE = 7
"""Points on each side of a thing whose distance to others is looked at."""
ANGLES = 24
DISTANCES = 8
ASIDE_COST = 5.0
"""What a radian off the direction that is meant costs, in standard deviations."""
FARTHEST_ASIDE = 3.0
"""Further off a direction than so many standard deviations nobody ever meant it."""
TYPICAL_GAP, WIDEST_GAP = 0.05, 0.15
"""Room that people leave between things that are beside each other, usually and at most [m]."""
HARDLY_MOVED = 0.03
"""What is missing from how far people bring things costs as many standard deviations as this goes into it [m]."""
FARTHEST_BESIDE = ADJACENT - 0.05
"""Nothing is put beside another with the centres further apart [m]: near where the words end they are hardly meant."""


@dataclass(frozen=True, slots=True)
class Spot:
    """A place for a thing.

    Attributes:
        position: Where its centre comes to rest, (3,) [m].
        onto: Index of the thing that it comes to rest in or on; None for the table.
    """

    position: FloatArray
    onto: int | None = None


@dataclass(frozen=True, slots=True)
class TableThings:
    """What is known of the things on a table.

    Attributes:
        location: Their centres, (N, 3) [m].
        extent: Their length, width and height, (N, 3) [m].
        yaw: Directions of their lengths, (N,) [rad]; None where they are not known, NaN for those that are not.
    """

    location: FloatArray
    extent: FloatArray
    yaw: FloatArray | None = None

    @property
    def radius(self) -> FloatArray:
        """Of the circle around each, seen from above, (N,) [m]."""
        return np.asarray(0.5 * np.hypot(self.extent[:, 0], self.extent[:, 1]))

    @property
    def top(self) -> FloatArray:
        """Height of each top, (N,) [m]."""
        return np.asarray(self.location[:, 2] + 0.5 * self.extent[:, 2])

    def half_width(self, index: int, way: FloatArray) -> float:
        """How far a thing reaches from its centre along a way (2,), seen from above [m]; all around if unknown how."""
        yaw = np.nan if self.yaw is None else float(self.yaw[index])
        if np.isnan(yaw):
            return float(self.radius[index])
        return half_width(0.5 * self.extent[index], yaw, way)

    def room(self, index: int, place: FloatArray) -> float:
        """Room between a thing that is put at a place, turned as it is, and the nearest other, from above [m]."""
        others = np.arange(len(self.location)) != index
        if not np.any(others):
            return np.inf
        yaw = np.nan if self.yaw is None else float(self.yaw[index])
        if np.isnan(yaw):
            return float(self.away(place)[others].min() - self.radius[index])
        return float(self.away(place + self._outline(index, yaw))[:, others].min())

    def _outline(self, index: int, yaw: float) -> FloatArray:
        """Points on the outline of a thing seen from above, around its centre, (n, 2) [m]."""
        steps = np.linspace(-1.0, 1.0, OUTLINE)
        ends = np.ones_like(steps)
        sides = [(steps, ends), (steps, -ends), (ends, steps), (-ends, steps)]
        half = 0.5 * self.extent[index, :2]
        box = np.concatenate([np.stack(side, axis=1) for side in sides]) * half
        cos, sin = np.cos(yaw), np.sin(yaw)
        return np.asarray(np.stack([box[:, 0] * cos - box[:, 1] * sin, box[:, 0] * sin + box[:, 1] * cos], axis=1))

    def away(self, place: FloatArray) -> FloatArray:
        """How far each is from places (..., 2), seen from above, (..., N) [m]; less than 0 inside."""
        off = place[..., None, :2] - self.location[:, :2]
        around = np.linalg.norm(off, axis=-1) - self.radius
        if self.yaw is None:
            return np.asarray(around)
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        along = np.stack([off[..., 0] * cos + off[..., 1] * sin, off[..., 1] * cos - off[..., 0] * sin], axis=-1)
        beyond = np.abs(along) - 0.5 * self.extent[:, :2]
        inside = np.minimum(beyond.max(axis=-1), 0.0)
        box = np.linalg.norm(np.maximum(beyond, 0.0), axis=-1) + inside
        return np.asarray(np.where(np.isnan(self.yaw), around, box))


def spots_for(
    goal: TableGoal,
    moved: int,
    things: TableThings,
    spaces: ConceptSpaces,
    resting: RestingPlaces,
    least: float = 0.0,
) -> list[Spot]:
    """Places that meet a goal, the best first.

    A place is the better the nearer it is to what the words mean typically, and the more room it leaves. Places so near
    to where the thing stands that nobody would see it moved are worse.

    Args:
        goal: What is meant.
        moved: Index of the thing that goes there.
        things: All things as they are seen.
        spaces: Concepts of directions.
        resting: Where things were ever seen to rest.
        least: How far the thing is brought at least, if that is possible [m].
    """
    found: list[tuple[float, Spot]] = []
    if goal.grounds:
        for ground in goal.grounds:
            if ground != moved:
                found += _by(ground, goal.concepts, moved, things, spaces)
    else:
        found += _at(goal.concepts, moved, things, resting)
    here = things.location[moved, :2]

    def cost(each: tuple[float, Spot]) -> float:
        missing = least - float(np.linalg.norm(each[1].position[:2] - here))
        return each[0] + max(0.0, missing) / HARDLY_MOVED

    return [spot for _, spot in sorted(found, key=cost)]


def best_apart(spots: Sequence[Spot]) -> tuple[Spot, ...]:
    """The best of many places, the best first, that are apart from each other."""
    kept: list[Spot] = []
    for spot in spots[:FIRST_SPOTS]:
        if all(np.linalg.norm(spot.position - other.position) > APART for other in kept):
            kept.append(spot)
    return tuple(kept[:SPOTS])


def meets(
    goal: TableGoal,
    place: FloatArray,
    extent: FloatArray,
    grounds: Sequence[tuple[FloatArray, FloatArray]],
    spaces: ConceptSpaces,
    resting: RestingPlaces,
) -> bool:
    """Whether a thing is where a goal says: in that part of the table, or so to one of the things it was to go to.

    Args:
        goal: What is meant.
        place: Where the thing's centre is, (3,) [m].
        extent: Its length, width and height, (3,) [m].
        grounds: Centre (3,) and extent (3,) [m] of each thing that it may go to; none for a part of the table.
        spaces: Concepts of directions.
        resting: Where things were ever seen to rest.
    """
    if not goal.grounds:
        return goal.concepts <= resting.at(place)
    wanted = frozenset((OVER,)) if _onto(goal.concepts, spaces) else goal.concepts
    return any(wanted <= relation_of(place - centre, spaces, np.stack([extent, its])) for centre, its in grounds)


def lies_over(index: int, ground: int, things: TableThings, spaces: ConceptSpaces) -> bool:
    """Whether a thing is seen on or in another, and not below it."""
    offset = things.location[index] - things.location[ground]
    if offset[2] < -0.5 * things.extent[ground, 2]:
        return False
    return OVER in relation_of(offset, spaces, things.extent[[index, ground]])


def _at(
    concepts: frozenset[Concept], moved: int, things: TableThings, resting: RestingPlaces
) -> Iterator[tuple[float, Spot]]:
    """Free places in a part of the table, each with how far it is from typical."""
    spread = np.sqrt(resting.square / resting.count)
    low, high = resting.mean - FARTHEST * spread, resting.mean + FARTHEST * spread
    height = 0.5 * float(things.extent[moved, 2])
    ideal = np.zeros(2)
    for number, side in enumerate(SIDE_PLACES):
        if side in concepts:
            ideal[number // 2] = WELL_INSIDE * (1.0 if number % 2 == 0 else -1.0)
    told = np.array([any(side in concepts for side in SIDE_PLACES[2 * axis : 2 * axis + 2]) for axis in (0, 1)])
    weight = np.where(told | (MIDDLE in concepts), 1.0, 0.3)
    for x in np.arange(low[0], high[0], STEP):
        for y in np.arange(low[1], high[1], STEP):
            place = np.array([x, y, height])
            if not concepts <= resting.at(place):
                continue
            room = things.room(moved, place[:2])
            if room >= LEAST_ROOM:
                off = float(np.linalg.norm(weight * ((place[:2] - resting.mean) / spread - ideal)))
                yield off + _crowded(room), Spot(place)


def _by(
    ground: int, concepts: frozenset[Concept], moved: int, things: TableThings, spaces: ConceptSpaces
) -> Iterator[tuple[float, Spot]]:
    """Free places in a relation to a thing, each with how far it is from typical."""
    centre, height = things.location[ground], float(things.extent[moved, 2])
    on_top = np.array([centre[0], centre[1], things.top[ground] + 0.5 * height])
    if _onto(concepts, spaces):
        others = (each for each in range(len(things.location)) if each not in (moved, ground))
        if not any(lies_over(each, ground, things, spaces) for each in others):
            yield 0.0, Spot(on_top, ground)
        return
    directions = _directions(concepts, spaces)
    for angle in 2.0 * np.pi * np.arange(ANGLES) / ANGLES:
        way = np.array([np.cos(angle), np.sin(angle)])
        aside = [_aside(way, each) for each in directions]
        if any(off > FARTHEST_ASIDE * spread for off, spread in aside):
            continue
        touching = things.half_width(ground, way) + things.half_width(moved, way)
        typical, farthest = touching + TYPICAL_GAP, min(touching + WIDEST_GAP, FARTHEST_BESIDE)
        aside_most = max((off for off, _ in aside), default=0.0)
        for distance in np.linspace(touching, farthest, DISTANCES):
            place = np.append(centre[:2] + distance * way, 0.5 * height)
            if not concepts <= relation_of(place - centre, spaces, things.extent[[moved, ground]]):
                continue
            room = things.room(moved, place[:2])
            if room >= LEAST_ROOM:
                yield ASIDE_COST * aside_most + abs(distance - typical) / 0.05 + _crowded(room), Spot(place)


def _directions(concepts: frozenset[Concept], spaces: ConceptSpaces) -> list[Gaussian]:
    """The directions among some concepts."""
    return [
        spaces.mixtures["direction"].components[spaces.resolve("direction", concept.number)]
        for concept in concepts
        if concept.space == "direction"
    ]


def _onto(concepts: frozenset[Concept], spaces: ConceptSpaces) -> bool:
    """Whether concepts say that one thing is on or in another."""
    means = [each.mean for each in _directions(concepts, spaces)]
    return OVER in concepts or any(mean[2] > STEEP * np.linalg.norm(mean) for mean in means)


def _aside(way: FloatArray, direction: Gaussian) -> tuple[float, float]:
    """How far a way (2,) is off a direction, and how far ways of that direction usually are [rad]."""
    mean = direction.mean[:2] / np.linalg.norm(direction.mean)
    across = np.array([-mean[1], mean[0]])
    spread = float(np.sqrt(across @ direction.covariance[:2, :2] @ across))
    return float(np.arccos(np.clip(way @ mean, -1.0, 1.0))), spread


def _crowded(room: float) -> float:
    """What little room costs."""
    return max(0.0, (ROOM + 0.02 - room) / 0.02)
