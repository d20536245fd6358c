"""Learning: from demos and the sentences that describe them to knowledge, and from new sentences to goals.

- `Learner`: one incremental pass over demos (`observe`); its `knowledge` is all that is kept.
- `Knowledge`: concepts, graphlets, K, Φ, Π as one readable JSON file.
- `Interpreter`: sentence and scene to an RCL tree and a `Goal` (`learning.interpretation`).
- `load_demos`: the demos of a directory, from `teleop`.
- `learning.perception`, `.concepts`, `.graphs`: what is seen; `.grounding`, `.grammar`: what is said;
  `.train_robots`: the public commands; `.evaluation`: scoring, which alone knows what is true.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from learning.interpretation import Goal, Interpretation, Interpreter
    from learning.knowledge import Knowledge
    from learning.learner import Learner
    from teleop import load_demos

__all__ = ["Goal", "Interpretation", "Interpreter", "Knowledge", "Learner", "load_demos"]

_HOMES = {
    "Goal": "learning.interpretation",
    "Interpretation": "learning.interpretation",
    "Interpreter": "learning.interpretation",
    "Knowledge": "learning.knowledge",
    "Learner": "learning.learner",
    "load_demos": "teleop",
}


def __getattr__(name: str) -> Any:
    """Import on first use what needs heavier libraries."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)
