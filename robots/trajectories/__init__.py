"""Trajectories: how joints and bases move within their limits, and around what stands in the way.

Nothing here knows a robot: limits are arrays, kinematics and geometry are functions that the caller passes in.

- `move_joints`: from one state to a posture (Ruckig). `follow_waypoints`: through many postures without stopping.
  `move_straight`: the tool on a line. All give a `Trajectory` within position, velocity, acceleration and jerk limits,
  which `check_limits` measures.
- `plan_path` and `plan_motion` ask `is_free` whether a posture touches something and go around with OMPL if need be;
  `plan_together` does so for several arms at once. `drive_base` brings a wheeled base to a pose.

Ruckig, SciPy and OMPL load when they are first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .base import BaseLimits, BaseTrajectory
    from .drive import BaseMotion, drive_base
    from .errors import MotionError
    from .joints import JointTrajectory, move_joints
    from .limits import JointLimits
    from .motion import MotionPlan, plan_motion
    from .path_trajectory import PathTrajectory, follow_waypoints
    from .planning import PlanResult, plan_path
    from .straight import StraightMotion, move_straight
    from .together import JointMotion, plan_together
    from .tool_limits import ToolLimits
    from .trajectory import LimitReport, Samples, Trajectory, check_limits

_WHERE = {
    "BaseLimits": "base",
    "BaseMotion": "drive",
    "BaseTrajectory": "base",
    "JointLimits": "limits",
    "JointMotion": "together",
    "JointTrajectory": "joints",
    "LimitReport": "trajectory",
    "MotionError": "errors",
    "MotionPlan": "motion",
    "PathTrajectory": "path_trajectory",
    "PlanResult": "planning",
    "Samples": "trajectory",
    "StraightMotion": "straight",
    "ToolLimits": "tool_limits",
    "Trajectory": "trajectory",
    "check_limits": "trajectory",
    "drive_base": "drive",
    "follow_waypoints": "path_trajectory",
    "move_joints": "joints",
    "move_straight": "straight",
    "plan_motion": "motion",
    "plan_path": "planning",
    "plan_together": "together",
}

__all__ = [
    "BaseLimits",
    "BaseMotion",
    "BaseTrajectory",
    "JointLimits",
    "JointMotion",
    "JointTrajectory",
    "LimitReport",
    "MotionError",
    "MotionPlan",
    "PathTrajectory",
    "PlanResult",
    "Samples",
    "StraightMotion",
    "ToolLimits",
    "Trajectory",
    "check_limits",
    "drive_base",
    "follow_waypoints",
    "move_joints",
    "move_straight",
    "plan_motion",
    "plan_path",
    "plan_together",
]


def __getattr__(name: str) -> Any:
    """Load a name when it is asked for (PEP 562)."""
    if name in _WHERE:
        return getattr(import_module(f".{_WHERE[name]}", __name__), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
