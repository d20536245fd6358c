"""Robots: what an arm is and how it moves, without physics.

- `load_robot(name or path)` reads a folder with a `robot.toml` and a URDF into a `RobotModel`; `list_robots()` names
  those that come with Showtell. A user adds a robot by pointing at such a folder; no code is needed.
- `RobotModel` has joints, limits, gripper, and Pinocchio's forward kinematics, Jacobian and position inverse
  kinematics (an `IkResult`), all in the frame of the world in which the robot was `placed_at` a pose.
- `Pose` is a position and a quaternion in xyzw order; `ShowtellError` is the root of all errors meant for the user,
  `RobotError` those of this package.

Heavy modules (Pinocchio) load when `RobotModel` is first used.
"""

from typing import TYPE_CHECKING, Any

from .catalogue import list_robots, load_robot
from .errors import RobotError, ShowtellError
from .pose import Pose

if TYPE_CHECKING:
    from .inverse_kinematics import IkResult
    from .model import Gripper, RobotModel
    from .urdf import Mimic

__all__ = [
    "Gripper",
    "IkResult",
    "Mimic",
    "Pose",
    "RobotError",
    "RobotModel",
    "ShowtellError",
    "list_robots",
    "load_robot",
]

_LAZY = {"Gripper": "model", "IkResult": "inverse_kinematics", "Mimic": "urdf", "RobotModel": "model"}


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
