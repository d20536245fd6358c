"""Random board scenes keep their rules."""

from collections import Counter

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from twin import SceneSpec, random_board
from twin.board import ALL_COLOURS_RGB, ALL_SHAPES, CELLS, COLOURS_RGB, cell_centre, nearest_cell


def cells(spec: SceneSpec) -> dict[tuple[int, int, int], str]:
    return {nearest_cell(np.array(each.position)): each.shape for each in spec.objects}


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_blocks_stand_in_cells_on_cubes_or_the_board(seed: int) -> None:
    spec = random_board(np.random.default_rng(seed), seed=seed)
    taken = cells(spec)
    assert 8 <= len(spec.objects) <= 14
    assert len(taken) == len(spec.objects)
    assert sorted(each.id for each in spec.objects) == list(range(len(spec.objects)))
    for each in spec.objects:
        x, y, z = nearest_cell(np.array(each.position))
        np.testing.assert_array_equal(each.position, cell_centre(x, y, z))
        assert 0 <= x < CELLS and 0 <= y < CELLS and 0 <= z < 4
        assert z == 0 or taken[x, y, z - 1] == "cube"


def test_scenes_are_varied_and_most_looks_are_unique() -> None:
    specs = [random_board(np.random.default_rng(seed)) for seed in range(200)]
    colours = Counter(each.colour for spec in specs for each in spec.objects)
    shapes = Counter(each.shape for spec in specs for each in spec.objects)
    assert set(colours) == set(COLOURS_RGB)
    assert min(shapes.values()) > 0.3 * sum(shapes.values())
    unique = stacked = total = 0
    for spec in specs:
        looks = Counter((each.colour, each.shape) for each in spec.objects)
        unique += sum(looks[each.colour, each.shape] == 1 for each in spec.objects)
        stacked += sum(each.position[2] > 0.03 for each in spec.objects)
        total += len(spec.objects)
    assert unique > 0.55 * total
    assert 0.1 * total < stacked < 0.5 * total


def test_all_looks_add_spheres_cylinders_and_black() -> None:
    specs = [random_board(np.random.default_rng(seed), all_looks=True) for seed in range(60)]
    assert {each.shape for spec in specs for each in spec.objects} == set(ALL_SHAPES)
    assert {each.colour for spec in specs for each in spec.objects} == set(ALL_COLOURS_RGB)
    bases = set()
    for spec in specs:
        taken = cells(spec)
        bases |= {taken[x, y, z - 1] for x, y, z in taken if z > 0}
    assert bases == {"cube", "cylinder"}
