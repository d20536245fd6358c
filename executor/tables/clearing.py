"""Putting aside what is in the way at a table: what stands where a thing shall go."""

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import RefusalError
from executor.tables.places import Spot, TableThings, spots_for
from learning.interpretation.table_interpreter import TableGoal

if TYPE_CHECKING:
    from learning import Knowledge
    from learning.graphs import ActionGraphlet

AMPLE, CROWDED = 0.05, 5.0
"""A thing that is put aside has so much room about it [m], or what is missing costs so many times as much way."""
NOWHERE = 9.0
"""Where a thing is imagined that is put aside [m]: far from every table."""


def in_the_way(
    goal: TableGoal, moved: int, things: TableThings, knowledge: "Knowledge"
) -> tuple[int, list[Spot]] | None:
    """The thing without which there would be room for a goal, and the places then; None where it is no single one.

    Args:
        goal: What is meant.
        moved: Index of the thing that goes there.
        things: All things as they are seen.
        knowledge: What was learned.
    """
    for index in range(len(things.location)):
        if index == moved or index in goal.grounds:
            continue
        location = np.array(things.location)
        location[index, :2] = NOWHERE
        spots = spots_for(
            goal, moved, replace(things, location=location), knowledge.spaces, knowledge.table_language.resting
        )
        if spots:
            return index, spots
    return None


def places_aside(index: int, moved: int, kept_free: Spot, things: TableThings, knowledge: "Knowledge") -> list[Spot]:
    """Free places for a thing that is put aside, the nearest of those with much room first.

    Args:
        index: Index of the thing.
        moved: Index of the thing that shall go to where it stands.
        kept_free: Where that shall go.
        things: All things as they are seen.
        knowledge: What was learned.
    """
    location = np.vstack([things.location, kept_free.position[None]])
    extent = np.vstack([things.extent, things.extent[moved][None]])
    anywhere = TableGoal(frozenset(), ())
    found = spots_for(
        anywhere, index, TableThings(location, extent), knowledge.spaces, knowledge.table_language.resting
    )
    here, others = things.location[index, :2], np.arange(len(location)) != index
    taken = TableThings(location[others], extent[others])

    def cost(spot: Spot) -> float:
        away = np.linalg.norm(taken.location[:, :2] - spot.position[:2], axis=1) - taken.radius - things.radius[index]
        return float(np.linalg.norm(spot.position[:2] - here)) + CROWDED * max(0.0, AMPLE - float(away.min()))

    return sorted(found, key=cost)


def carrying_action(knowledge: "Knowledge") -> "tuple[int, ActionGraphlet]":
    """The learned action that takes a thing and puts it down somewhere else, with its number.

    Raises:
        RefusalError: None was learned.
    """
    for number, graphlet in knowledge.spaces.actions.numbered.items():
        first, last = graphlet.states[0], graphlet.states[-1]
        carried = any(state.holds for state in graphlet.states) and first.object_location != last.object_location
        if carried and not first.holds and not last.holds:
            return number, graphlet
    raise RefusalError("no action was learned that puts a thing somewhere else")
