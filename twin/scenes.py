"""From what a user calls a scene to its specification."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from robots.validation import read_toml

from .board_scene import random_board
from .errors import SceneError
from .ordering_scene import random_ordering
from .scene_spec import SceneSpec
from .tabletop_scene import random_tabletop

SCENES: dict[str, Callable[..., SceneSpec]] = {
    "board": random_board,
    "board-all": partial(random_board, all_looks=True),
    "tabletop": random_tabletop,
    "ordering": random_ordering,
}
"""The scenes that are made from a seed, by name."""


def resolve_scene(scene: str | Path | SceneSpec, seed: int = 0) -> SceneSpec:
    """Give the specification of a scene.

    Args:
        scene: A name in `SCENES`, the path of a scene TOML, or a specification, which is given back.
        seed: Decides a random scene.

    Raises:
        SceneError: The scene is unknown or wrong; names file, field and value.
    """
    if isinstance(scene, SceneSpec):
        return scene
    if isinstance(scene, str) and scene in SCENES:
        return SCENES[scene](np.random.default_rng(seed), seed=seed)
    path = Path(scene)
    if not path.is_file():
        raise SceneError(
            f"scene {str(scene)!r} is unknown: use {', '.join(map(repr, SCENES))} or the path of a scene's TOML file"
        )
    return read_scene(path)


def read_scene(path: Path) -> SceneSpec:
    """Read a scene TOML: the keys of `SceneSpec`, with one `[[objects]]` table an object.

    Raises:
        SceneError: The file cannot be read, is not TOML, or a value is wrong; names file, field and value.
    """
    return read_toml(path, SceneSpec, SceneError)
