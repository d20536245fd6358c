"""A percept as sets: what each concept is true of, kept as bit masks (thesis 5.3.3, query).

Bit i of an object mask is object i of the percept; bit m of a placement mask is placement m. A query of an RCL
element against the predicates is then an intersection of integers.
"""

from collections import defaultdict
from collections.abc import Mapping
from functools import cached_property

import numpy as np

from learning.concept_id import OBJECT_SPACES, RELATION_SPACES, Concept
from learning.percept import NO_CONCEPT, IntArray, Percept


def bits(mask: int) -> list[int]:
    """List the positions of the set bits, lowest first."""
    found = []
    while mask:
        low = mask & -mask
        found.append(low.bit_length() - 1)
        mask ^= low
    return found


class SceneSets:
    """The predicates of a percept as masks."""

    def __init__(self, percept: Percept, bearing_shapes: frozenset[int] | None = None) -> None:
        """Index a percept.

        Args:
            percept: Predicates of the scene.
            bearing_shapes: Shape concepts that something can rest on, None when that is not known yet.
        """
        self.percept = percept
        self.all_objects = (1 << len(percept.object_ids)) - 1
        self.clear = _mask_of(np.asarray(percept.clear).nonzero()[0])
        self.held = 0 if percept.held is None else 1 << percept.held
        self.objects: dict[Concept, int] = {}
        for space in OBJECT_SPACES:
            for concept, mask in _masks_by_number(percept.properties[space]).items():
                self.objects[Concept(space, concept)] = mask
        self.places: dict[Concept, int] = {
            Concept("location", number): mask
            for number, mask in _masks_by_number(percept.placement_properties["location"]).items()
        }
        self.relations_of_objects = _relation_masks(percept.relations)
        self.relations_of_places = _relation_masks(percept.placement_relations)
        self.usable_places = self._usable_places(bearing_shapes)

    def _usable_places(self, bearing_shapes: frozenset[int] | None) -> int:
        mask = 0
        shapes = self.percept.properties["shape"]
        for place, below in enumerate(self.percept.support):
            if below == self.percept.held:
                continue
            if below < 0 or bearing_shapes is None or int(shapes[below]) in bearing_shapes:
                mask |= 1 << place
        return mask

    @cached_property
    def column_of(self) -> list[int]:
        """Index of the placement straight above or below each object (nearest on the table plane)."""
        flat = self.percept.placements[:, :2]
        return [int(np.argmin(np.sum((flat - p[:2]) ** 2, axis=1))) for p in self.percept.location]

    def related(self, concept: Concept, ground: int) -> tuple[int, int]:
        """Give the objects and the placements that stand in a relation to any object of the mask `ground`."""
        objects = places = 0
        of_objects = self.relations_of_objects.get(concept, {})
        of_places = self.relations_of_places.get(concept, {})
        for j in bits(ground):
            objects |= of_objects.get(j, 0)
            places |= of_places.get(j, 0)
        return objects, places


def _mask_of(indices: IntArray) -> int:
    mask = 0
    for index in indices:
        mask |= 1 << int(index)
    return mask


def _masks_by_number(numbers: IntArray) -> dict[int, int]:
    masks: defaultdict[int, int] = defaultdict(int)
    for index, number in enumerate(numbers):
        if number != NO_CONCEPT:
            masks[int(number)] |= 1 << index
    return masks


def _relation_masks(relations: Mapping[str, IntArray]) -> dict[Concept, dict[int, int]]:
    masks: dict[Concept, dict[int, int]] = {}
    for space in RELATION_SPACES:
        matrix = relations.get(space)
        if matrix is None:
            continue
        for i, j in np.argwhere(matrix != NO_CONCEPT):
            row = masks.setdefault(Concept(space, int(matrix[i, j])), {})
            row[int(j)] = row.get(int(j), 0) | 1 << int(i)
    return masks
