"""Commands at a table carried out by Baxter and the Mico: from a sentence and what the camera sees to motion.

`TableDoer` understands a step in the perceived scene, finds a place for its goal, plays the learned action and looks
again; `Executor` uses it for worlds that are tables.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from executor.tables.table_doer import TableDoer

__all__ = ["TableDoer"]

_HOMES = {"TableDoer": "table_doer"}


def __getattr__(name: str) -> Any:
    """Load a name when it is asked for (PEP 562)."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
