"""What is in the way of a goal at a table: what lies on a thing, or stands where one shall go; and where it may go."""

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from executor.tables.places import Spot, TableThings, lies_over, spots_for
from learning.interpretation.table_interpreter import TableGoal

if TYPE_CHECKING:
    from learning import Knowledge

AMPLE, CROWDED = 0.05, 5.0
"""A thing that is put aside has so much room about it [m], or what is missing costs so many times as much way."""
MOST_IN_THE_WAY = 3
"""So many things at most are cleared for one goal."""
NOWHERE = 9.0
"""Where a thing is imagined that is put aside [m]: far from every table."""


def covering(index: int, things: TableThings, knowledge: "Knowledge", held: int | None = None) -> tuple[int, ...]:
    """What lies on or in a thing, the uppermost first.

    Args:
        index: Index of the thing.
        things: All things as they are seen.
        knowledge: What was learned.
        held: Index of what is in the hand, which lies on nothing.
    """
    found: list[int] = []
    below = [index]
    while below:
        under = below.pop()
        above = [each for each in range(len(things.location)) if each not in (*found, index, held)]
        lying = [each for each in above if lies_over(each, under, things, knowledge.spaces)]
        found += lying
        below += lying
    return tuple(sorted(found, key=lambda each: -float(things.top[each])))


def in_the_way(
    goal: TableGoal, moved: int, things: TableThings, knowledge: "Knowledge"
) -> tuple[tuple[int, ...], list[Spot]] | None:
    """The fewest things without which there would be room for a goal, and the places then; None where there are none.

    What lies on or in them is in the way, too. At most `MOST_IN_THE_WAY` are looked for.

    Args:
        goal: What is meant.
        moved: Index of the thing that goes there.
        things: All things as they are seen.
        knowledge: What was learned.
    """
    resting = knowledge.table_language.resting
    others = [index for index in range(len(things.location)) if index != moved]
    for count in range(1, MOST_IN_THE_WAY + 1):
        for chosen in combinations(others, count):
            lying = [each for index in chosen for each in covering(index, things, knowledge, moved)]
            away = tuple(dict.fromkeys((*lying, *chosen)))
            if set(away) & set(goal.grounds) or len(away) > MOST_IN_THE_WAY:
                continue
            location = np.array(things.location)
            location[list(away), :2] = NOWHERE
            spots = spots_for(goal, moved, replace(things, location=location), knowledge.spaces, resting)
            if spots:
                return away, spots
    return None


def places_aside(
    index: int, moved: int, kept_free: Spot | None, things: TableThings, knowledge: "Knowledge"
) -> list[Spot]:
    """Free places for a thing that is put aside, the nearest of those with much room first.

    Args:
        index: Index of the thing.
        moved: Index of the thing that shall go to where it stands.
        kept_free: Where that shall go; None where it goes nowhere.
        things: All things as they are seen.
        knowledge: What was learned.
    """
    if kept_free is not None:
        location = np.vstack([things.location, kept_free.position[None]])
        extent = np.vstack([things.extent, things.extent[moved][None]])
        yaw = None if things.yaw is None else np.append(things.yaw, things.yaw[moved])
        things = TableThings(location, extent, yaw)
    anywhere = TableGoal(frozenset(), ())
    found = spots_for(anywhere, index, things, knowledge.spaces, knowledge.table_language.resting)
    here, others = things.location[index, :2], np.arange(len(things.location)) != index

    def cost(spot: Spot) -> float:
        room = float(things.away(spot.position)[others].min()) - float(things.radius[index])
        return float(np.linalg.norm(spot.position[:2] - here)) + CROWDED * max(0.0, AMPLE - room)

    return sorted(found, key=cost)
