"""Random board scenes."""

import numpy as np

from .board import ALL_COLOURS_RGB, ALL_SHAPES, CELLS, COLOURS_RGB, FLAT_TOPPED, SHAPES, cell_centre
from .scene_spec import ObjectSpec, SceneSpec

FEWEST, MOST = 8, 14
HIGHEST_STACK = 4
STACKED = 0.35
"""Probability that a block goes on another one."""
REPEATED = 0.2
"""Probability that a block looks like an earlier one; the others are the only ones of their colour and shape."""


def random_board(rng: np.random.Generator, *, seed: int = 0, all_looks: bool = False) -> SceneSpec:
    """Make a board scene of 8 to 14 blocks, some of them stacked: cubes and prisms in eight colours.

    Nothing stands on a prism or a sphere, and stacks are at most four high. Most blocks are the only ones of their
    colour and shape, so that a sentence can name them by both.

    Args:
        rng: Where chance comes from.
        seed: Number written into the specification.
        all_looks: Whether spheres, cylinders and black take part too, which the public release does not have.
    """
    colours, shapes = (ALL_COLOURS_RGB, ALL_SHAPES) if all_looks else (COLOURS_RGB, SHAPES)
    looks = [(colour, shape) for colour in colours for shape in shapes]
    rng.shuffle(looks)
    chosen: list[tuple[str, str]] = []
    for _ in range(int(rng.integers(FEWEST, MOST + 1))):
        repeat = bool(chosen) and rng.random() < REPEATED
        chosen.append(chosen[rng.integers(len(chosen))] if repeat else looks.pop())
    heights = np.zeros((CELLS, CELLS), dtype=int)
    open_cells: set[tuple[int, int]] = set()
    cells = []
    for _, shape in chosen:
        bases = sorted(cell for cell in open_cells if heights[cell] < HIGHEST_STACK)
        if bases and rng.random() < STACKED:
            cell = bases[rng.integers(len(bases))]
        else:
            free = np.argwhere(heights == 0)
            x, y = free[rng.integers(len(free))]
            cell = (int(x), int(y))
        cells.append((*cell, int(heights[cell])))
        heights[cell] += 1
        if shape in FLAT_TOPPED:
            open_cells.add(cell)
        else:
            open_cells.discard(cell)
    order = rng.permutation(len(chosen))
    objects = [
        {"id": number, "colour": chosen[at][0], "shape": chosen[at][1], "position": tuple(cell_centre(*cells[at]))}
        for number, at in enumerate(order)
    ]
    return SceneSpec(objects=tuple(ObjectSpec.model_validate(each) for each in objects), seed=seed)
