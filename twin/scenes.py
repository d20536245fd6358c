"""From what a user calls a scene to its specification."""

from pathlib import Path

import numpy as np

from robots.validation import read_toml

from .board_scene import random_board
from .errors import SceneError
from .scene_spec import SceneSpec

SCENES = ("board",)
"""Names of the scenes that are made from a seed."""


def resolve_scene(scene: str | Path | SceneSpec, seed: int = 0) -> SceneSpec:
    """Give the specification of a scene.

    Args:
        scene: `"board"`, the path of a scene TOML, or a specification, which is given back.
        seed: Decides a random scene.

    Raises:
        SceneError: The scene is unknown or wrong; names file, field and value.
    """
    if isinstance(scene, SceneSpec):
        return scene
    if scene == "board":
        return random_board(np.random.default_rng(seed), seed=seed)
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
