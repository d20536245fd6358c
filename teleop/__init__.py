"""Teleoperation: from a gamepad to motion, and onto disk.

- `GamepadState` (W3C standard layout) becomes a `TwistCommand` through a `GamepadMapping`, and joint velocities within
  all limits through a `Servo` (`ServoResult` tells what was asked, what was executed and why they differ).
- `ScriptedOperator` does a `Task` with a gamepad like a person; `random_task` makes a task with a sentence for it.
- `record_demo` records an operator at work; `load_demo` and `load_demos` read demos back, also truncated ones;
  `check_replay` simulates a demo's inputs afresh and compares.
- `write_truth` and `read_truth` keep what is true of a demo beside it, for scoring only.
- `TeleopError` and its `DemoError`, `ServoError`, `TaskError` are this package's errors.

Ruckig, Pinocchio, PyBullet and MCAP load when a name that needs them is first used.
"""

from typing import TYPE_CHECKING, Any

from .errors import DemoError, ServoError, TaskError, TeleopError
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping, TwistCommand

if TYPE_CHECKING:
    from .demo import Demo
    from .demo_reader import IncompleteDemoWarning, is_whole, load_demo, load_demos
    from .record import Operator, record_demo
    from .recorder import Recorder
    from .replay import ReplayReport, check_replay
    from .scripted_operator import ScriptedOperator
    from .sentences import DescribedTask, random_task
    from .servo import Servo, ServoReason, ServoResult, ServoState
    from .session import Session
    from .task import Task
    from .truth import read_truth, truth_path, write_truth

_LAZY = {
    "Demo": "demo",
    "DescribedTask": "sentences",
    "IncompleteDemoWarning": "demo_reader",
    "Operator": "record",
    "Recorder": "recorder",
    "ReplayReport": "replay",
    "ScriptedOperator": "scripted_operator",
    "Servo": "servo",
    "ServoReason": "servo",
    "ServoResult": "servo",
    "ServoState": "servo",
    "Session": "session",
    "Task": "task",
    "check_replay": "replay",
    "is_whole": "demo_reader",
    "load_demo": "demo_reader",
    "load_demos": "demo_reader",
    "random_task": "sentences",
    "read_truth": "truth",
    "record_demo": "record",
    "truth_path": "truth",
    "write_truth": "truth",
}

__all__ = [
    "Demo",
    "DemoError",
    "DescribedTask",
    "GamepadMapping",
    "GamepadState",
    "IncompleteDemoWarning",
    "Operator",
    "Recorder",
    "ReplayReport",
    "ScriptedOperator",
    "Servo",
    "ServoError",
    "ServoReason",
    "ServoResult",
    "ServoState",
    "Session",
    "Task",
    "TaskError",
    "TeleopError",
    "TwistCommand",
    "check_replay",
    "is_whole",
    "load_demo",
    "load_demos",
    "random_task",
    "read_truth",
    "record_demo",
    "truth_path",
    "write_truth",
]


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
