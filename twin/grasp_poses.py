"""Grasp poses for an object where it lies: where a gripper's tool frame must be, and how far it opens."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from robots.gripper import Gripper
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose

from .objects.model import Grasp, ObjectModel

CLEARANCE = 0.002
"""Least room [m] between each open finger and the object."""
BITE = 0.0005
"""Fingers must close at least this much [m] below an object's width to press on it."""


@dataclass(frozen=True, slots=True)
class GraspPose:
    """One way to hold an object where it lies.

    Attributes:
        pose_tool_in_world: The tool frame when the fingers close.
        approach: Direction in which the hand comes, (3,) unit, in the world.
        opening: Gap of the fingers before they close [m].
        width: Width of what is held [m].
        grasp: The grasp in the object frame.
    """

    pose_tool_in_world: Pose
    approach: FloatArray
    opening: float
    width: float
    grasp: Grasp


def grasp_poses(
    model: ObjectModel,
    pose_object_in_world: Pose,
    gripper: Gripper,
    *,
    depths: Sequence[float] = (0.0,),
    openings: Sequence[float] = (),
    tilts: Sequence[float] = (0.0,),
) -> list[GraspPose]:
    """Propose grasps from an object's shape, the steadiest first, whether or not an arm reaches them.

    Each grasp of the object's shape is tried with the hand turned either way about its approach, and with the approach
    tilted about the line between the pads, which touch the same places then.

    Args:
        model: The object.
        pose_object_in_world: Where it is.
        gripper: The fingers.
        depths: How much farther than the middle of the pads the hand goes in along its approach [m], best first.
        openings: Gaps more than the object's width to come with [m], best first; the widest opening is tried before.
        tilts: Angles of the approach to that of the object's grasp [rad], best first.

    Returns:
        Proposals; empty if no part of the object fits between the fingers.
    """
    turn = rotation_matrix(pose_object_in_world.orientation_xyzw)
    in_tool = _frame(gripper.approach, gripper.closing)
    proposals = []
    for tilt in tilts:
        for grasp in model.grasps:
            if not gripper.min_opening + BITE <= grasp.width <= gripper.max_opening - 2 * CLEARANCE:
                continue
            gaps = [gripper.max_opening]
            gaps += [grasp.width + more for more in openings if grasp.width + more < gripper.max_opening]
            closing = turn @ grasp.closing
            approach = _tilted(turn @ grasp.approach, closing, tilt)
            centre = turn @ grasp.centre + pose_object_in_world.position
            turns = [quaternion_xyzw(_frame(approach, sign * closing) @ in_tool.T) for sign in (1.0, -1.0)]
            poses = [Pose(centre + depth * approach, orientation) for depth in depths for orientation in turns]
            proposals += [GraspPose(pose, approach, gap, grasp.width, grasp) for pose in poses for gap in gaps]
    return proposals


def _tilted(vector: FloatArray, about: FloatArray, angle: float) -> FloatArray:
    """A vector (3,) turned about a unit vector at a right angle to it."""
    return np.asarray(np.cos(angle) * vector + np.sin(angle) * np.cross(about, vector))


def _frame(approach: FloatArray, closing: FloatArray) -> FloatArray:
    """Rotation matrix (3, 3) whose columns are the approach, the closing direction and what completes them."""
    return np.column_stack((approach, closing, np.cross(approach, closing)))
