"""What a hand that is closed on nothing needs to touch things: ways of holding it, and where it will touch."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from executor.arm_motions import SAMPLES, ArmMotions
from executor.handled import Handled
from robots.collision import CollisionModel
from robots.kinematics import quaternion_xyzw
from robots.pose import FloatArray, read_only
from robots.trajectories import Trajectory

DOWN = read_only([0.0, 0.0, -1.0])
ACROSS = (np.pi / 2, 0.0, -np.pi / 2, np.pi)
"""Directions [rad] in which its fingers close, from that in which it leans: their broad side ahead is best."""
NEARLY = 0.003
"""A hand so near to an object [m] will touch it there."""


@dataclass(frozen=True, slots=True)
class Approach:
    """A way to touch an object.

    Attributes:
        before: Posture from which the hand comes, (n,) [rad].
        way: From there straight on: nearly to a touch that leaves the object where it is, through one that pushes it.
        direction: Of the way, (3,) unit.
    """

    before: FloatArray
    way: Trajectory
    direction: FloatArray


def come_near(motions: ArmMotions, approach: Approach, object_id: int) -> Handled:
    """Bring the closed hand to where an approach begins."""
    return motions.go(approach.before, motions.around(detailed={object_id}))


def hand_turns(
    motions: ArmMotions, tilts: Sequence[float], middle: FloatArray, along: FloatArray | None = None
) -> Iterator[FloatArray]:
    """Orientations (xyzw) of a hand that leans along a push, or away from the robot, and closes any way."""
    outwards = middle - motions.arm.pose_base_in_world.position
    outwards = np.append(outwards[:2], 0.0) / np.linalg.norm(outwards[:2])
    for tilt in tilts:
        for lean in (outwards,) if along is None else (along, outwards) if tilt else (along,):
            heading = float(np.arctan2(lean[1], lean[0]))
            for across in ACROSS:
                yield _orientation(motions, heading + across, tilt, lean)


def contacts(
    motions: ArmMotions, whole: CollisionModel, way: Trajectory, object_id: int
) -> tuple[FloatArray, FloatArray | None]:
    """Points of an object that the hand first touches on a way, (n, 3) [m], and the posture there, (n,) [rad]."""
    openings = dict(zip(motions.world.robot.arms, motions.fingers.openings, strict=True))
    for q in way.sample(SAMPLES).position:
        if motions.free(whole, q, NEARLY, 0.0):
            continue
        posture = motions.world.commanded_positions
        posture[motions.joints] = q
        near = [pair for pair in whole.near(posture, NEARLY, openings) if str(object_id) in (pair.first, pair.second)]
        if near:
            return np.array([pair.point_on_second for pair in near]), q
    return np.empty((0, 3)), None


def _orientation(motions: ArmMotions, heading: float, tilt: float, lean: FloatArray) -> FloatArray:
    """Orientation (xyzw) of a hand that points down, leaning by an angle, and closes along `heading`."""
    gripper = motions.arm.gripper
    closing = np.array([np.cos(heading), np.sin(heading), 0.0])
    pointing = np.cos(tilt) * DOWN + np.sin(tilt) * lean
    closing = closing - (closing @ pointing) * pointing
    closing /= np.linalg.norm(closing)
    in_world = np.column_stack((pointing, closing, np.cross(pointing, closing)))
    in_tool = np.column_stack((gripper.approach, gripper.closing, np.cross(gripper.approach, gripper.closing)))
    return quaternion_xyzw(in_world @ in_tool.T)
