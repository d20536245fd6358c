"""Whether an arm reaches a thing at all, by kinematics alone: from where its base stands, or from where it could."""

import numpy as np

from executor.actions.destination import TURNS, turned
from executor.actions.things import pose_of
from executor.arm_motions import moved
from executor.grasp_choice import APPROACH, TILTS
from robots.arm_model import ArmModel
from robots.pose import FloatArray, Pose
from twin import World
from twin.grasp_poses import grasp_poses

MOST = 24
"""Hands around a thing that are looked at, spread evenly over all."""


def reaches(world: World, arm: str, object_id: int, goal: FloatArray | None = None, base: Pose | None = None) -> bool:
    """Whether some posture brings an arm's hand around an object, and from there to where it shall rest.

    Args:
        world: The twin; nothing in it moves.
        arm: Name of the arm.
        object_id: The object.
        goal: Where its centre shall come to rest, (3,) [m]; None where it goes nowhere.
        base: Where the robot's base would stand; None: where it is.

    Raises:
        TwinError: There is no such object.
    """
    model = world.placed_robot.arms[arm] if base is None else world.robot.placed_at(base).arms[arm]
    thing, pose = world.model_of(object_id), pose_of(world.state(), object_id)
    grasps = grasp_poses(thing, pose, model.gripper, tilts=TILTS)
    for grasp in grasps[:: max(1, round(len(grasps) / MOST))]:
        tool = grasp.pose_tool_in_world
        before = _posture(model, moved(tool, -APPROACH * grasp.approach), model.home)
        if before is None or (at := _posture(model, tool, before)) is None:
            continue
        if goal is None:
            return True
        if any(_posture(model, turned(tool, pose.position, goal, turn), at) is not None for turn in TURNS):
            return True
    return False


def _posture(arm: ArmModel, tool: Pose, near: FloatArray) -> FloatArray | None:
    """A posture for a pose of the tool; of an arm with few joints, for its place alone."""
    if len(arm.joint_names) >= 6:
        found = arm.inverse_kinematics(tool, start=near, posture=near, tolerance=1e-5, max_restarts=2)
    else:
        found = arm.inverse_kinematics(tool.position, start=near)
    return np.asarray(found.q) if found.success else None
