"""Perception: what the learner gets to see of a demo or a world, and how it puts that into its own symbols.

`observe_demo`, `observe_key_frames` and `observe_world` make an `Observation` (tracks with noise); `perceive` and
`percept_of` turn one into predicates, given the concepts learned so far.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from learning.perception.observation import Observation

if TYPE_CHECKING:
    from learning.perception.observe import KeyFrame, observe_demo, observe_key_frames, observe_world
    from learning.perception.predicates import perceive, percept_of

__all__ = [
    "KeyFrame",
    "Observation",
    "observe_demo",
    "observe_key_frames",
    "observe_world",
    "perceive",
    "percept_of",
]

_HOMES = {
    "KeyFrame": "observe",
    "observe_demo": "observe",
    "observe_key_frames": "observe",
    "observe_world": "observe",
    "perceive": "predicates",
    "percept_of": "predicates",
}


def __getattr__(name: str) -> Any:
    """Import on first use what needs heavier libraries."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
