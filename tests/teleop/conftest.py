from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from teleop import Demo, ScriptedOperator, Task, record_demo
from twin import ObjectSpec, SceneSpec, World
from twin.board import cell_centre


def place(x: int, y: int, z: int) -> tuple[float, float, float]:
    a, b, c = cell_centre(x, y, z).tolist()
    return a, b, c


def scene_of(*blocks: tuple[tuple[int, int, int], str, str], **more: object) -> SceneSpec:
    """A scene from (cell, colour, shape) of each block; ids count from 0."""
    objects = tuple(
        ObjectSpec(id=number, shape=shape, colour=colour, position=place(*cell))
        for number, (cell, colour, shape) in enumerate(blocks)
    )
    return SceneSpec(objects=objects, **more)


@pytest.fixture(scope="session")
def small_scene() -> SceneSpec:
    return scene_of(((3, 3, 0), "red", "cube"), ((5, 2, 0), "blue", "cube"), ((5, 3, 0), "green", "prism"))


@pytest.fixture(scope="session")
def small_demo(small_scene: SceneSpec, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Demo]:
    """The red cube is put on the blue one."""
    path = tmp_path_factory.mktemp("demo") / "small.mcap"
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(0, cell_centre(5, 2, 1)), np.random.default_rng(1))
        yield record_demo(world, operator, path, utterances=("put the red cube on the blue cube",), truth={"moved": 0})


@pytest.fixture
def demo_bytes(small_demo: Demo) -> bytes:
    return Path(small_demo.path).read_bytes()
