"""Random tabletop and ordering scenes keep their rules for many seeds."""

from itertools import combinations

import numpy as np
import pytest

from twin import SceneSpec
from twin.errors import SceneError
from twin.objects import CATALOGUES
from twin.objects.overlap import footprint_depth
from twin.ordering_scene import REGION_X as ORDER_X
from twin.ordering_scene import REGION_Y as ORDER_Y
from twin.scenes import resolve_scene
from twin.tabletop_scene import CLEARANCE, REGION_X, REGION_Y, random_tabletop

SEEDS = range(200)


@pytest.fixture(scope="module")
def tables() -> list[SceneSpec]:
    return [resolve_scene("tabletop", seed) for seed in SEEDS]


def test_tabletop_objects_stand_apart_on_the_table(tables: list[SceneSpec]) -> None:
    for spec in tables:
        assert (spec.name, spec.kind, spec.robot) == ("tabletop", "table", "baxter")
        assert 4 <= len(spec.objects) <= 6
        assert len({each.model for each in spec.objects}) == len(spec.objects)
        for each in spec.objects:
            assert REGION_X[0] <= each.position[0] <= REGION_X[1]
            assert REGION_Y[0] <= each.position[1] <= REGION_Y[1]
            assert each.position[2] == each.half_extents[2]
        for one, other in combinations(spec.objects, 2):
            offset = np.subtract(other.position, one.position)
            depth = footprint_depth(one.half_extents, other.half_extents, offset, one.yaw, other.yaw)
            assert depth <= -CLEARANCE + 1e-12


def test_every_object_of_the_tabletop_comes_up(tables: list[SceneSpec]) -> None:
    assert {each.model for spec in tables for each in spec.objects} == set(CATALOGUES["tabletop"])


def test_objects_stand_at_given_places_each_at_another_one() -> None:
    places = [(x, y) for x in (0.53, 0.77) for y in (0.25, 0.0, -0.25)]
    taken = set()
    for seed in SEEDS:
        spec = random_tabletop(np.random.default_rng(seed), places=places, about=0.02)
        near = [
            index
            for each in spec.objects
            for index, (x, y) in enumerate(places)
            if abs(each.position[0] - x) <= 0.02 and abs(each.position[1] - y) <= 0.02
        ]
        assert len(near) == len(set(near)) == len(spec.objects)
        taken |= set(near)
    assert taken == set(range(6))


def test_too_few_places_are_refused() -> None:
    with pytest.raises(SceneError, match="up to 6 objects, got 2 places"):
        random_tabletop(np.random.default_rng(0), places=[(0.5, 0.0), (0.7, 0.0)])


def test_ordering_has_one_object_and_each_comes_up() -> None:
    specs = [resolve_scene("ordering", seed) for seed in SEEDS]
    for spec in specs:
        (only,) = spec.objects
        assert (spec.name, spec.kind, spec.robot) == ("ordering", "table", "mico_segway")
        assert ORDER_X[0] <= only.position[0] <= ORDER_X[1]
        assert ORDER_Y[0] <= only.position[1] <= ORDER_Y[1]
    assert {spec.objects[0].model for spec in specs} == set(CATALOGUES["ordering"])


@pytest.mark.parametrize("name", ["board-all", "tabletop", "ordering"])
def test_scenes_depend_on_the_seed_alone(name: str) -> None:
    assert resolve_scene(name, 5) == resolve_scene(name, 5)
    assert resolve_scene(name, 5) != resolve_scene(name, 6)
    assert resolve_scene(name, 5).seed == 5
    assert SceneSpec.model_validate_json(resolve_scene(name, 5).model_dump_json()) == resolve_scene(name, 5)
