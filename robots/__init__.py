"""Robots: what an arm is and how it moves, without physics.

- `load_robot(name or path)` reads a folder with a `robot.toml` and a URDF into a `RobotModel`; `list_robots()` names
  those that come with Showtell. A user adds a robot by pointing at such a folder; no code is needed.
- `RobotModel` has joints, limits, `arms`, a `Drive` where it has wheels, and `CameraMount`s. An `ArmModel` has its
  joints and `Gripper`, and Pinocchio's forward kinematics, Jacobian and inverse kinematics (an `IkResult`, for a pose,
  a position or what a `TaskMask` leaves of a pose), in the world in which the robot was `placed_at` a pose.
- `CollisionModel` tells whether a posture is free of the robot itself, of `Obstacle`s and with held things, and what
  is `Nearest`. `robots.trajectories` plans motions, `robots.visuals` and `robots.meshes` are for drawing,
  `robots.manipulability` measures how well a posture can move.
- `Pose` is a position and a quaternion in xyzw order; `ShowtellError` is the root of all errors meant for the user,
  `RobotError` those of this package.

Heavy modules (Pinocchio) load when `RobotModel` is first used.
"""

from typing import TYPE_CHECKING, Any

from .catalogue import list_robots, load_robot
from .errors import RobotError, ShowtellError
from .pose import Pose

if TYPE_CHECKING:
    from .arm_model import ArmModel
    from .collision import CollisionModel, Nearest, Obstacle
    from .gripper import Gripper
    from .ik_mask import TaskMask
    from .ik_result import IkResult
    from .model import CameraMount, Drive, RobotModel
    from .urdf import Mimic

__all__ = [
    "ArmModel",
    "CameraMount",
    "CollisionModel",
    "Drive",
    "Gripper",
    "IkResult",
    "Mimic",
    "Nearest",
    "Obstacle",
    "Pose",
    "RobotError",
    "RobotModel",
    "ShowtellError",
    "TaskMask",
    "list_robots",
    "load_robot",
]

_LAZY = {
    "ArmModel": "arm_model",
    "CameraMount": "model",
    "CollisionModel": "collision",
    "Drive": "model",
    "Gripper": "gripper",
    "IkResult": "ik_result",
    "Mimic": "urdf",
    "Nearest": "collision",
    "Obstacle": "collision",
    "RobotModel": "model",
    "TaskMask": "ik_mask",
}


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
