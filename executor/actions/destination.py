"""Whether a grasp suits a destination: the hand must reach there too, above it and at it, and have room to open."""

import numpy as np

from executor.actions.things import pose_of
from executor.arm_motions import WAY_CLEARANCE, ArmMotions, moved
from executor.grasp_choice import GENTLE, TABLE_CLEARANCE, way_back
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose
from twin.grasp_poses import GraspPose

TURNS = (0.0, 0.5, -0.5, 1.0, -1.0, 1.57, -1.57, 2.2, -2.2, 3.14)
"""Turns about the vertical [rad] that are tried where a carry without one is out of reach."""


class Destination:
    """Accepts grasps with which an object can be set down at its destination, turned about the vertical if need be.

    Args:
        motions: The arm, with an empty hand.
        object_id: The object, where it stands before it is taken.
        goal: Where its centre shall come to rest, (3,) [m].
        lift: Height from which it is lowered there [m].

    Attributes:
        turn: Turn about the vertical with which the accepted grasp reaches the destination [rad].
        above: Posture above the destination then, (n,) [rad]; None before a grasp was accepted.
    """

    def __init__(self, motions: ArmMotions, object_id: int, goal: FloatArray, lift: float) -> None:
        self.turn = 0.0
        self.above: FloatArray | None = None
        self._motions = motions
        self._centre = pose_of(motions.world.state(), object_id).position
        self._goal = np.asarray(goal, dtype=np.float64)
        self._up = np.array([0.0, 0.0, lift])
        self._around = motions.around(without={object_id})

    def __call__(self, grip: GraspPose, posture: FloatArray) -> bool:
        """Whether a grasp, with the hand at a posture (n,) [rad], can be brought to the destination."""
        motions = self._motions
        for turn in TURNS:
            there = turned(grip.pose_tool_in_world, self._centre, self._goal, turn)
            above = motions.reach(moved(there, self._up), posture)
            if above is None or not motions.free(self._around, above, WAY_CLEARANCE, grip.opening):
                continue
            rest = motions.reach(there, above)  # known before a way there is planned, as for grasps
            if rest is None or not motions.free(self._around, rest, 0.0, grip.opening):
                continue
            down = motions.plan_straight(above, there, GENTLE).trajectory
            if down is None:
                continue
            at = down.at(down.duration)[0]
            if not motions.free(self._around, at, TABLE_CLEARANCE, grip.opening):
                continue
            if way_back(motions, at, self._around, grip.opening) is not None:
                self.turn, self.above = turn, above
                return True
        return False


def turned(tool: Pose, centre: FloatArray, goal: FloatArray, turn: float) -> Pose:
    """Where the tool is when an object it holds has come from `centre` to `goal`, (3,) [m], turned by an angle."""
    about = rotation_matrix(np.array([0.0, 0.0, np.sin(turn / 2), np.cos(turn / 2)]))
    position = goal + about @ (tool.position - centre)
    return Pose(position, quaternion_xyzw(about @ rotation_matrix(tool.orientation_xyzw)))
