"""Which concepts of a demo are worth a word: those of the thing that moved, how it moved and where it went.

A board holds some 25 blocks, so that nearly every concept is true of something in every demo and co-occurrence with
all of them says nothing. As infants do, the learner attends to what moves (the part of the state graph that its action
graphlet touches): the moved object's properties and relations before, its new place and relations after.
"""

import numpy as np

from learning.concept_id import ACTION_SPACE, OBJECT_SPACES, RELATION_SPACES, Concept
from learning.percept import NO_CONCEPT, Percept, ShownAction

LOOKS = ("colour", "shape")
"""Properties of an object itself, wherever it is."""
NEARLY = 1.15
"""Neighbours up to this many times the distance of the nearest count as nearest too."""


def salient_concepts(percept: Percept, shown: ShownAction) -> set[Concept]:
    """Give the concepts that a shown action draws attention to."""
    salient = {Concept(ACTION_SPACE, part) for part in shown.parts}
    attended = [shown.moved]
    if shown.placement is not None:
        for space, numbers in percept.placement_properties.items():
            if numbers[shown.placement] != NO_CONCEPT:
                salient.add(Concept(space, int(numbers[shown.placement])))
        attended += nearest_neighbours(percept, shown)
        for space in RELATION_SPACES:
            relations = percept.placement_relations[space][shown.placement]
            salient.update(Concept(space, int(relations[j])) for j in attended[1:] if relations[j] != NO_CONCEPT)
    for index in attended:
        for space in OBJECT_SPACES:
            number = int(percept.properties[space][index])
            if number != NO_CONCEPT and (space != "location" or index == shown.moved):
                salient.add(Concept(space, number))
    return salient


def focal_concepts(percept: Percept, shown: ShownAction) -> set[Concept]:
    """Give the concepts of the action as a whole and of the moved object alone.

    Every move contains a take, and most things land on a cube: what is nearly always salient cannot be told from
    chance by `salient_concepts`, but it is not nearly always in focus.
    """
    focal = {Concept(ACTION_SPACE, shown.action)}
    for space in LOOKS:
        number = int(percept.properties[space][shown.moved])
        if number != NO_CONCEPT:
            focal.add(Concept(space, number))
    return focal


def nearest_neighbours(percept: Percept, shown: ShownAction) -> list[int]:
    """Find what the moved object ends up nearest to: the block below it, or those right beside it."""
    related = [
        j
        for j in range(len(percept.object_ids))
        if j != shown.moved
        and any(percept.placement_relations[s][shown.placement, j] != NO_CONCEPT for s in RELATION_SPACES)
    ]
    if not related:
        return []
    place = percept.placements[shown.placement]
    distances = [float(np.linalg.norm(percept.location[j] - place)) for j in related]
    return [j for j, d in zip(related, distances, strict=True) if d <= NEARLY * min(distances)]
