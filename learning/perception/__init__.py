"""Perception: what the learner gets to see of a demo or a world, and how it puts that into its own symbols.

`perceive_any` makes an `Observation` of any demo: of the board (`observe_demo`, true tracks with noise), or of a table
as a camera saw it (`observe_camera_demo`); `perceive_demos` does so for many demos and keeps the results.
`observe_world`, `observe_camera_world` and `observe_key_frames` look at what is no demo. `perceive` and `percept_of`
turn an observation into predicates, given the concepts learned so far.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from learning.perception.observation import Observation

if TYPE_CHECKING:
    from learning.perception.observation_file import load_observation
    from learning.perception.observe import (
        KeyFrame,
        observe_demo,
        observe_key_frames,
        observe_world,
        perceive_any,
    )
    from learning.perception.observe_camera import observe_camera_demo, observe_camera_world
    from learning.perception.predicates import perceive, percept_of
    from learning.perception.stage import perceive_demos

__all__ = [
    "KeyFrame",
    "Observation",
    "load_observation",
    "observe_camera_demo",
    "observe_camera_world",
    "observe_demo",
    "observe_key_frames",
    "observe_world",
    "perceive",
    "perceive_any",
    "perceive_demos",
    "percept_of",
]

_HOMES = {
    "KeyFrame": "observe",
    "load_observation": "observation_file",
    "observe_camera_demo": "observe_camera",
    "observe_camera_world": "observe_camera",
    "observe_demo": "observe",
    "observe_key_frames": "observe",
    "observe_world": "observe",
    "perceive": "predicates",
    "perceive_any": "observe",
    "perceive_demos": "stage",
    "percept_of": "predicates",
}


def __getattr__(name: str) -> Any:
    """Import on first use what needs heavier libraries."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
