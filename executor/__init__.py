"""The executor: from a sentence to a changed world, and the command line.

- `Executor(world, knowledge).execute(sentence)` looks at the scene, understands the sentence, turns the goal into a
  `MotionPlan` by following the learned action's states, moves the arm, looks again, and gives an `ExecutionReport`.
- `plan_motion` makes such a plan for one goal; `ExecutorError` is this package's error, `RefusalError` says why a goal
  cannot be carried out, `InputError` what is wrong with an argument.

`executor.cli` is the command line `showtell`; its commands are in `executor.commands`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from executor.errors import ExecutorError, InputError, RefusalError

if TYPE_CHECKING:
    from executor.executor import Executor
    from executor.motion_plan import MotionPlan, MoveGripper, MoveTool
    from executor.planner import plan_motion
    from executor.report import ExecutionReport, Outcome

__all__ = [
    "ExecutionReport",
    "Executor",
    "ExecutorError",
    "InputError",
    "MotionPlan",
    "MoveGripper",
    "MoveTool",
    "Outcome",
    "RefusalError",
    "plan_motion",
]

_HOMES = {
    "ExecutionReport": "report",
    "Executor": "executor",
    "MotionPlan": "motion_plan",
    "MoveGripper": "motion_plan",
    "MoveTool": "motion_plan",
    "Outcome": "report",
    "plan_motion": "planner",
}


def __getattr__(name: str) -> Any:
    """Load on first use what needs heavier libraries (PEP 562)."""
    if name in _HOMES:
        return getattr(import_module(f"executor.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
