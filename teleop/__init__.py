"""Teleoperation: from a gamepad to motion, and onto disk.

- `GamepadState` (W3C standard layout) becomes a `TwistCommand` through a `GamepadMapping`, and joint velocities within
  all limits through a `Servo` (`ServoResult` tells what was asked, what was executed and why they differ).
- For whole robots: `DriveMapping` makes a `DriveCommand` (an `ArmWish` for each arm, the base) of a gamepad,
  `RobotServo` keeps all limits and distances, a `DriveSession` drives a world. `teleop.devices` are gamepad, keyboard
  and page; `drive_by_hand` drives at this machine, `teleop.server` serves the page.
- `Recording` starts, stops, keeps and discards demos; `trim_demo`, `repair_demo`, `add_utterances` and `label_demo`
  rewrite them safely; `DemoPlayer` plays one again.
- `ScriptedOperator` does a `Task` with a gamepad like a person; `random_task` makes a task with a sentence for it.
- `record_demo` records an operator at work; `load_demo` and `load_demos` read demos back, also truncated ones;
  `check_replay` simulates a demo's inputs afresh and compares.
- `write_truth` and `read_truth` keep what is true of a demo beside it, for scoring only.
- `TeleopError` and its `DemoError`, `ServoError`, `TaskError` are this package's errors.

Ruckig, Pinocchio, PyBullet and MCAP load when a name that needs them is first used.
"""

from typing import TYPE_CHECKING, Any

from .drive_command import ArmWish, DriveCommand
from .errors import DemoError, ServoError, TaskError, TeleopError
from .gamepad import GamepadState
from .gamepad_mapping import GamepadMapping, TwistCommand

if TYPE_CHECKING:
    from .demo import Demo
    from .demo_reader import IncompleteDemoWarning, is_whole, load_demo, load_demos
    from .drive_mapping import DriveMapping
    from .drive_session import DriveSession
    from .hand_loop import drive_by_hand
    from .record import Operator, record_demo
    from .recorder import Recorder
    from .recording import Recording
    from .repair import add_utterances, label_demo, repair_demo
    from .replay import DemoPlayer, ReplayReport, check_replay
    from .robot_servo import RobotServo
    from .scripted_operator import ScriptedOperator
    from .sentences import DescribedTask, random_task
    from .servo import Servo, ServoReason, ServoResult, ServoState
    from .session import Session
    from .task import Task
    from .trim import trim_demo
    from .truth import read_truth, truth_path, write_truth

_LAZY = {
    "Demo": "demo",
    "DemoPlayer": "replay",
    "DescribedTask": "sentences",
    "DriveMapping": "drive_mapping",
    "DriveSession": "drive_session",
    "IncompleteDemoWarning": "demo_reader",
    "Operator": "record",
    "Recorder": "recorder",
    "Recording": "recording",
    "ReplayReport": "replay",
    "RobotServo": "robot_servo",
    "ScriptedOperator": "scripted_operator",
    "Servo": "servo",
    "ServoReason": "servo",
    "ServoResult": "servo",
    "ServoState": "servo",
    "Session": "session",
    "Task": "task",
    "add_utterances": "repair",
    "check_replay": "replay",
    "drive_by_hand": "hand_loop",
    "is_whole": "demo_reader",
    "label_demo": "repair",
    "load_demo": "demo_reader",
    "load_demos": "demo_reader",
    "random_task": "sentences",
    "read_truth": "truth",
    "record_demo": "record",
    "repair_demo": "repair",
    "trim_demo": "trim",
    "truth_path": "truth",
    "write_truth": "truth",
}

__all__ = [
    "ArmWish",
    "Demo",
    "DemoError",
    "DemoPlayer",
    "DescribedTask",
    "DriveCommand",
    "DriveMapping",
    "DriveSession",
    "GamepadMapping",
    "GamepadState",
    "IncompleteDemoWarning",
    "Operator",
    "Recorder",
    "Recording",
    "ReplayReport",
    "RobotServo",
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
    "add_utterances",
    "check_replay",
    "drive_by_hand",
    "is_whole",
    "label_demo",
    "load_demo",
    "load_demos",
    "random_task",
    "read_truth",
    "record_demo",
    "repair_demo",
    "trim_demo",
    "truth_path",
    "write_truth",
]


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
