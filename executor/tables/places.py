"""Where on a table a goal can be met: places that are what the words say, free, and well inside what is meant."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from learning.concept_id import Concept
from learning.concepts.concept_spaces import ConceptSpaces
from learning.concepts.table_spaces import ADJACENT
from learning.grounding.table_scene import MIDDLE, OVER, SIDE_PLACES, RestingPlaces, relation_of
from learning.interpretation.table_interpreter import TableGoal
from robots.pose import FloatArray

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
ANGLES = 24
DISTANCES = 8
ASIDE_COST = 5.0
"""What a radian off the direction that is meant costs, in standard deviations."""
TYPICAL_GAP = 0.05
"""Room that people leave between things that are beside each other [m]."""


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
    """

    location: FloatArray
    extent: FloatArray

    @property
    def radius(self) -> FloatArray:
        """Of the circle around each, seen from above, (N,) [m]."""
        return np.asarray(0.5 * np.hypot(self.extent[:, 0], self.extent[:, 1]))

    @property
    def top(self) -> FloatArray:
        """Height of each top, (N,) [m]."""
        return np.asarray(self.location[:, 2] + 0.5 * self.extent[:, 2])


def spots_for(
    goal: TableGoal, moved: int, things: TableThings, spaces: ConceptSpaces, resting: RestingPlaces
) -> list[Spot]:
    """Places that meet a goal, the best first.

    A place is the better the nearer it is to what the words mean typically, and the more room it leaves.

    Args:
        goal: What is meant.
        moved: Index of the thing that goes there.
        things: All things as they are seen.
        spaces: Concepts of directions.
        resting: Where things were ever seen to rest.
    """
    found: list[tuple[float, Spot]] = []
    if goal.grounds:
        for ground in goal.grounds:
            if ground != moved:
                found += _by(ground, goal.concepts, moved, things, spaces)
    else:
        found += _at(goal.concepts, moved, things, resting)
    return [spot for _, spot in sorted(found, key=lambda each: each[0])]


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
            room = _room(place, moved, things)
            if room >= LEAST_ROOM:
                off = float(np.linalg.norm(weight * ((place[:2] - resting.mean) / spread - ideal)))
                yield off + _crowded(room), Spot(place)


def _by(
    ground: int, concepts: frozenset[Concept], moved: int, things: TableThings, spaces: ConceptSpaces
) -> Iterator[tuple[float, Spot]]:
    """Free places in a relation to a thing, each with how far it is from typical."""
    centre, height = things.location[ground], float(things.extent[moved, 2])
    on_top = np.array([centre[0], centre[1], things.top[ground] + 0.5 * height])
    means = [
        spaces.mixtures["direction"].components[spaces.resolve("direction", concept.number)].mean
        for concept in concepts
        if concept.space == "direction"
    ]
    if OVER in concepts or any(mean[2] > STEEP * np.linalg.norm(mean) for mean in means):
        yield 0.0, Spot(on_top, ground)
        return
    typical = float(things.radius[ground] + things.radius[moved]) + TYPICAL_GAP
    for distance in np.linspace(0.5 * typical, ADJACENT, DISTANCES):
        for angle in 2.0 * np.pi * np.arange(ANGLES) / ANGLES:
            way = np.array([np.cos(angle), np.sin(angle)])
            place = np.append(centre[:2] + distance * way, 0.5 * height)
            if not concepts <= relation_of(place - centre, spaces, things.extent[[moved, ground]]):
                continue
            room = _room(place, moved, things)
            if room >= LEAST_ROOM:
                aside = max(
                    (float(np.arccos(np.clip(way @ mean[:2] / np.linalg.norm(mean), -1.0, 1.0))) for mean in means),
                    default=0.0,
                )
                yield ASIDE_COST * aside + abs(distance - typical) / 0.05 + _crowded(room), Spot(place)


def _room(place: FloatArray, moved: int, things: TableThings) -> float:
    """Room between the thing at a place and the nearest other, seen from above [m]."""
    others = np.arange(len(things.location)) != moved
    if not np.any(others):
        return np.inf
    away = np.linalg.norm(things.location[others, :2] - place[:2], axis=1)
    return float((away - things.radius[others] - things.radius[moved]).min())


def _crowded(room: float) -> float:
    """What little room costs."""
    return max(0.0, (ROOM + 0.02 - room) / 0.02)
