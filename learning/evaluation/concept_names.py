"""Names of concepts for scoring: the true value that a concept stands for most often (design section 6)."""

from collections import Counter, defaultdict

import numpy as np

from learning.concept_id import ACTION_SPACE, Concept
from learning.percept import NO_CONCEPT, IntArray, Percept
from learning.train_robots.layout import Cell
from learning.train_robots.scene import Scene
from twin.board import CELLS, nearest_cell

OCTANTS = ("front", "front left", "left", "backward left", "backward", "backward right", "right", "front right")
"""Horizontal directions counter-clockwise from +x."""


def true_place(cell: Cell) -> str:
    """Name the place of a cell: corners and edges by their side, else `inner`; the robot looks along +x."""
    x, y, _ = cell
    depth = {0: "back", CELLS - 1: "front"}.get(x)
    side = {0: "right", CELLS - 1: "left"}.get(y)
    if depth and side:
        return f"{depth} {side} corner"
    if depth or side:
        return f"{depth or side} edge"
    return "inner"


def true_relation(thing: Cell, ground: Cell) -> str:
    """Name where a cell is as seen from another, with the public relations where there is one.

    `above` and `below` in one column; else by the nearest of eight horizontal directions: `front` (+x), `backward`,
    `left` (+y), `right`, and their mixtures.
    """
    dx, dy, dz = (a - b for a, b in zip(thing, ground, strict=True))
    if dx == dy == 0:
        return "above" if dz > 0 else "below"
    octant = round(float(np.arctan2(dy, dx)) / (np.pi / 4)) % 8
    return ("front", "front left", "left", "backward left", "backward", "backward right", "right", "front right")[
        octant
    ]


def true_distance(thing: Cell, ground: Cell) -> str:
    """Name how far a cell is from another: `same column`, `adjacent` (the public label), or a number of cells."""
    steps = max(abs(thing[0] - ground[0]), abs(thing[1] - ground[1]))
    return {0: "same column", 1: "adjacent"}.get(steps, f"{steps} cells")


class ConceptTally:
    """Counts how often each concept stood for each true value."""

    def __init__(self) -> None:
        self._counts: defaultdict[Concept, Counter[str]] = defaultdict(Counter)

    def add(self, percept: Percept, action: int | None, scene: Scene) -> None:
        """Count one scene.

        Args:
            percept: The scene before the action; object ids are indices in the before layout.
            action: Action concept that the scene shows, None when not known.
            scene: The truth.
        """
        blocks = [scene.before.blocks[int(number)] for number in percept.object_ids]
        cells = [block.cell for block in blocks]
        for space, values in (
            ("colour", [block.colour for block in blocks]),
            ("shape", [block.shape for block in blocks]),
            ("location", [true_place(cell) for cell in cells]),
        ):
            for number, value in zip(percept.properties[space], values, strict=True):
                self._count(space, int(number), value)
        places = [nearest_cell(place) for place in percept.placements]
        for space, numbers in percept.relations.items():
            self._count_relations(space, numbers, cells, cells)
        for space, numbers in percept.placement_relations.items():
            self._count_relations(space, numbers, places, cells)
        if action is not None and action != NO_CONCEPT and scene.move is not None:
            self._count(ACTION_SPACE, action, scene.move.kind)

    def names(self) -> dict[Concept, str]:
        """Return the most frequent true value of every concept seen (the first in the alphabet of equals)."""
        return {
            concept: min(counts, key=lambda value: (-counts[value], value)) for concept, counts in self._counts.items()
        }

    def _count(self, space: str, number: int, value: str) -> None:
        if number != NO_CONCEPT:
            self._counts[Concept(space, number)][value] += 1

    def _count_relations(self, space: str, numbers: IntArray, things: list[Cell], grounds: list[Cell]) -> None:
        value_of = true_distance if space == "distance" else true_relation
        for i, j in np.argwhere(numbers != NO_CONCEPT):
            self._count(space, int(numbers[i, j]), value_of(things[i], grounds[j]))
