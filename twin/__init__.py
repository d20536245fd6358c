"""The twin: scenes in PyBullet physics.

- `World.from_scene("board", seed=7)` stands a robot beside a board with blocks; `step(JointCommand)` simulates
  1/240 s, `state()` tells the truth (`WorldState`, `ObjectState`), `snapshot()` and `restore()` go back in time,
  `render()` draws. Blocks are grasped by friction; nothing snaps to cells. Worlds are deterministic and share nothing.
- `SceneSpec` and `ObjectSpec` say what a scene is made of, from code, a TOML file (`read_scene`) or a seed
  (`random_board`).
- `board` holds the geometry of the 8 x 8 board; `TwinError` and `SceneError` are this package's errors.

PyBullet, Pinocchio and pydantic load when a name that needs them is first used.
"""

from typing import TYPE_CHECKING, Any

from . import board
from .errors import SceneError, TwinError
from .state import JointCommand, ObjectState, WorldState

if TYPE_CHECKING:
    from .board_scene import random_board
    from .scene_spec import ObjectSpec, SceneSpec
    from .scenes import read_scene
    from .world import Snapshot, World

__all__ = [
    "JointCommand",
    "ObjectSpec",
    "ObjectState",
    "SceneError",
    "SceneSpec",
    "Snapshot",
    "TwinError",
    "World",
    "WorldState",
    "board",
    "random_board",
    "read_scene",
]

_LAZY = {
    "ObjectSpec": "scene_spec",
    "SceneSpec": "scene_spec",
    "Snapshot": "world",
    "World": "world",
    "random_board": "board_scene",
    "read_scene": "scenes",
}


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
