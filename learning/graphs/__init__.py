"""Graphs: a demo as a sequence of constant qualitative states, and the graphlets cut from it (thesis 3.3.4)."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from learning.graphs.action_graphlet import ActionGraphlet
from learning.graphs.action_library import ActionLibrary
from learning.graphs.graphlet_state import GraphletState, Side

if TYPE_CHECKING:
    from learning.graphs.action_states import action_of
    from learning.graphs.graphlets import Graphlet
    from learning.graphs.state_graph import StateGraph

__all__ = ["ActionGraphlet", "ActionLibrary", "Graphlet", "GraphletState", "Side", "StateGraph", "action_of"]

_HOMES = {"Graphlet": "graphlets", "StateGraph": "state_graph", "action_of": "action_states"}


def __getattr__(name: str) -> Any:
    """Import on first use what needs heavier libraries."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
