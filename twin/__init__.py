"""The twin: scenes in PyBullet physics.

- `World.from_scene("board", seed=7)` stands a robot beside a board with blocks; `step(JointCommand)` simulates
  1/240 s, `state()` tells the truth (`WorldState`, `ObjectState`), `snapshot()` and `restore()` go back in time,
  `render()` draws. `"tabletop"` is Baxter's table, `"ordering"` the Mico's. Objects are grasped by friction; nothing
  snaps or sticks. Worlds are deterministic and share nothing.
- `SceneSpec` and `ObjectSpec` say what a scene is made of, from code, a TOML file (`read_scene`) or a seed
  (`random_board`); `twin.objects` has the objects.
- `twin.grasp_poses` proposes where a gripper can hold an object, `SlipMonitor` tells whether it slips; an `ArmState`
  has the forces felt at the wrist.
- `LiveCamera` is a camera that the robot carries; `SceneView` tells what cameras see of a recorded state, for the
  renderers of `twin.camera`, in other processes too.
- `board` holds the geometry of the 8 x 8 board; `TwinError` and `SceneError` are this package's errors.

PyBullet, Pinocchio and pydantic load when a name that needs them is first used.
"""

from typing import TYPE_CHECKING, Any

from . import board
from .errors import SceneError, TwinError
from .state import ArmState, JointCommand, ObjectState, WorldState

if TYPE_CHECKING:
    from .board_scene import random_board
    from .grasp_poses import GraspPose
    from .live_camera import LiveCamera
    from .scene_spec import ObjectSpec, SceneSpec
    from .scene_view import RobotState, SceneView, robot_state
    from .scenes import read_scene
    from .slip import Slip, SlipMonitor
    from .world import Snapshot, World

__all__ = [
    "ArmState",
    "GraspPose",
    "JointCommand",
    "LiveCamera",
    "ObjectSpec",
    "ObjectState",
    "RobotState",
    "SceneError",
    "SceneSpec",
    "SceneView",
    "Slip",
    "SlipMonitor",
    "Snapshot",
    "TwinError",
    "World",
    "WorldState",
    "board",
    "random_board",
    "read_scene",
    "robot_state",
]

_LAZY = {
    "GraspPose": "grasp_poses",
    "LiveCamera": "live_camera",
    "ObjectSpec": "scene_spec",
    "RobotState": "scene_view",
    "SceneSpec": "scene_spec",
    "SceneView": "scene_view",
    "Slip": "slip",
    "SlipMonitor": "slip",
    "Snapshot": "world",
    "World": "world",
    "random_board": "board_scene",
    "read_scene": "scenes",
    "robot_state": "scene_view",
}


def __getattr__(name: str) -> Any:
    """Load the heavy names when they are asked for (PEP 562)."""
    if name in _LAZY:
        from importlib import import_module

        return getattr(import_module(f".{_LAZY[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
