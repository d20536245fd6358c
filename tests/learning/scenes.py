"""Percepts made by hand: a small board with exact symbols, for tests of language."""

import numpy as np

from learning.percept import NO_CONCEPT, Percept, ShownAction

SIDE = 4
"""Columns along each side of the small board."""
ABOVE, LEFT = 0, 1
"""Numbers of the direction concepts."""
TAKE, DROP, MOVE = 1, 2, 3

Block = tuple[int, int, int, int, int]
"""x, y, level, colour number, shape number (0 cube, 1 prism)."""


def percept_of_blocks(blocks: list[Block], held: int | None = None) -> Percept:
    """Perceive exactly, direction `LEFT` being one column further in y at the same level."""
    cells = [block[:3] for block in blocks]
    tops = {(x, y): -1 for x in range(SIDE) for y in range(SIDE)}
    support = dict(tops)
    for index, (x, y, z) in enumerate(cells):
        if index != held and z > tops[x, y]:
            tops[x, y], support[x, y] = z, index
    places = [(x, y, tops[x, y] + 1) for x, y in tops]
    return Percept(
        object_ids=np.arange(len(blocks)) + 10,
        location=np.array(cells, dtype=float).reshape(-1, 3),
        properties={
            "colour": np.array([block[3] for block in blocks]),
            "shape": np.array([block[4] for block in blocks]),
            "location": np.array([block[0] * SIDE + block[1] for block in blocks]),
        },
        relations={"direction": _directions(cells, cells), "distance": np.full((len(cells),) * 2, NO_CONCEPT)},
        placements=np.array(places, dtype=float),
        placement_properties={"location": np.array([x * SIDE + y for x, y, _ in places])},
        placement_relations={
            "direction": _directions(places, cells),
            "distance": np.full((len(places), len(cells)), NO_CONCEPT),
        },
        support=np.array([support[x, y] for x, y, _ in places]),
        clear=np.array([(x, y, z + 1) not in cells for x, y, z in cells]),
        held=held,
    )


def shown(blocks: list[Block], moved: int, column: tuple[int, int] | None, action: int = MOVE) -> ShownAction:
    """Say what was shown: a block moved to a column, or taken."""
    parts = (TAKE, DROP, MOVE) if action == MOVE else (action,)
    place = None if column is None else column[0] * SIDE + column[1]
    return ShownAction(action, parts, moved, place, np.zeros(3))


def _directions(things: list[tuple[int, int, int]], grounds: list[tuple[int, int, int]]) -> np.ndarray:
    matrix = np.full((len(things), len(grounds)), NO_CONCEPT)
    for i, (x, y, z) in enumerate(things):
        for j, (u, v, w) in enumerate(grounds):
            if (x - u, y - v, z - w) == (0, 0, 1):
                matrix[i, j] = ABOVE
            if (x - u, y - v, z - w) == (0, 1, 0):
                matrix[i, j] = LEFT
    return matrix
