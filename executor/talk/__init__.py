"""Telling the robot on the page: what `showtell serve` adds to driving and recording.

- `Talk` extends the control loop (`teleop.loop_extension`): it reads commands, shows what would be done, does it on the
  very world that is seen, undoes it, and has demos learned. `make_talk` makes it, in the loop's process.
- `Student` learns demos in a process of its own, so that driving goes on meanwhile.
- `page/` holds what the browser loads for it.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from executor.talk.student import Student
    from executor.talk.talk import Talk, make_talk

_WHERE = {"Student": "student", "Talk": "talk", "make_talk": "talk"}

__all__ = ["Student", "Talk", "make_talk"]


def __getattr__(name: str) -> Any:
    """Load what is asked for: the student's process needs little of it."""
    from importlib import import_module

    if name not in _WHERE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
