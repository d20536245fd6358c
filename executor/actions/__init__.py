"""Actions as motion plans: learned action graphlets played on any robot of the twin, and tried in new scenes.

`plan_action` turns a graphlet into motion primitives by what changes between its states; `ActionPlayer` carries them
out; `fault_of` judges by physics. `showtell evaluate actions` puts them together.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from executor.actions.action_plan import ActionPlan, plan_action
    from executor.actions.player import ActionPlayer, Played
    from executor.actions.quantities import Quantities, quantities_of
    from executor.actions.success import fault_of

__all__ = ["ActionPlan", "ActionPlayer", "Played", "Quantities", "fault_of", "plan_action", "quantities_of"]

_HOMES = {
    "ActionPlan": "action_plan",
    "ActionPlayer": "player",
    "Played": "player",
    "Quantities": "quantities",
    "fault_of": "success",
    "plan_action": "action_plan",
    "quantities_of": "quantities",
}


def __getattr__(name: str) -> Any:
    """Load a name when it is asked for (PEP 562)."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
