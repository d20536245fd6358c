"""Choosing a grasp: of all that an object's shape offers, the first that an arm reaches and leaves freely."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from executor.arm_motions import SAMPLES, WAY_CLEARANCE, ArmMotions, moved
from executor.holders import holders
from robots.collision import CollisionModel
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from robots.trajectories import ToolLimits, Trajectory
from twin.grasp_poses import GraspPose, grasp_poses

APPROACH = 0.08
"""How far [m] before the grasp the hand comes onto the straight way to it."""
BACK = (1.0, 0.6, 0.3)
"""Parts of that way by which it draws back."""
UPWARDS = 0.7
"""A hand that points down by this much (cosine) may go straight up too: what stood between its fingers stays."""
DEPTHS = (0.012, 0.006, 0.0, -0.006)
"""How much deeper than the middle of the pads the hand goes in where there is room [m]."""
OPENINGS = (0.016, 0.010)
"""Narrower openings than the widest, more than the object's width [m]: between neighbours, inside a bowl."""
TILTS = (0.0, 0.35, -0.35, 0.8, -0.8)
"""Angles [rad] by which the hand comes from another side about the line between the pads."""
MOST_WAYS, MOST_ASKED = 150, 20
"""So many straight ways to grasps are planned at most, and so many grasps are looked at for what comes after them."""
TABLE_CLEARANCE = 0.0015
"""Least distance [m] of the open hand from everything when it is at the grasp."""
GENTLE = ToolLimits(0.15, 0.6, 6.0, 0.8, 3.0, 30.0)
"""Tool limits near objects."""


@dataclass(frozen=True, slots=True)
class ChosenGrasp:
    """A grasp that can be come to.

    Attributes:
        grip: The grasp.
        before: Posture before it, (n,) [rad].
        way: From there straight to the grasp.
    """

    grip: GraspPose
    before: FloatArray
    way: Trajectory


Accepts = Callable[[GraspPose, FloatArray], bool]
"""Whether a grasp suits what comes after it, given also the posture (n,) [rad] at its end."""


def choose_grasp(
    motions: ArmMotions, object_id: int, lift: float, accepts: Accepts = lambda grip, posture: True
) -> ChosenGrasp | str:
    """The first grasp that the arm reaches freely and lifts the object from, or why there is none.

    The effort is bounded by counts, not by time, so that equal worlds give equal grasps.

    Args:
        motions: The arm.
        object_id: The object.
        lift: How far up it must be possible to lift it [m].
        accepts: Whether a grasp that can be reached suits what comes after it.

    Raises:
        TwinError: There is no such object.
    """
    world, arm = motions.world, motions.arm
    thing = world.model_of(object_id)
    pose = next(each.pose_object_in_world for each in world.state().objects if each.id == object_id)
    proposals = grasp_poses(thing, pose, arm.gripper, depths=DEPTHS, openings=OPENINGS, tilts=TILTS)
    if not proposals:
        return "no grasp: no part of the object fits between the fingers"
    model = motions.around(detailed={object_id})
    # What of the hand is not made to touch the object must not push it away when the fingers close.
    closed = motions.around(detailed={object_id}, may_touch={object_id})
    # The object itself is lifted with the hand.
    lifted = motions.around(detailed=holders(world, object_id), without={object_id})
    reached = free = False
    ways = asked = 0
    tool, before, there = None, None, None
    for proposal in proposals:
        if proposal.pose_tool_in_world is not tool:  # those that follow differ in their opening only
            tool = proposal.pose_tool_in_world
            before = motions.reach(moved(tool, -APPROACH * proposal.approach), arm.home)
            there = None if before is None else motions.reach(tool, before)
        if before is None or there is None:
            continue
        reached = True
        if not motions.free(model, before, WAY_CLEARANCE, proposal.opening):
            continue
        free = True
        # Among other things most hands touch something at the grasp: that is known before a way there is planned.
        if not motions.free(model, there, 0.0, proposal.opening):
            continue
        if ways == MOST_WAYS or asked == MOST_ASKED:
            break
        ways += 1
        way = motions.plan_straight(before, proposal.pose_tool_in_world, GENTLE).trajectory
        if way is None or not motions.way_free(model, way, TABLE_CLEARANCE, proposal.opening, back=True):
            continue
        end = way.at(way.duration)[0]
        if not motions.free(closed, end, TABLE_CLEARANCE, proposal.width):
            continue
        up = motions.plan_straight(end, moved(proposal.pose_tool_in_world, np.array([0.0, 0.0, lift])), GENTLE)
        if up.trajectory is not None and motions.free(
            lifted, up.trajectory.sample(SAMPLES).position[-1], WAY_CLEARANCE, proposal.opening
        ):
            asked += 1
            if accepts(proposal, end):
                return ChosenGrasp(proposal, before, way)
            before = None  # with another opening it suits no better
    if not reached:
        return "out of reach: no posture brings the hand to any grasp of the object"
    if asked:
        return "no way on: no grasp that can be reached suits what comes after it"
    if not free:
        return "no room: the hand would touch something before every grasp"
    return "no room: the hand would touch something on the way into or out of every grasp"


def way_back(
    motions: ArmMotions, start: FloatArray, around: CollisionModel | None = None, opening: float | None = None
) -> Trajectory | None:
    """The way of the hand straight back from a grasp at a posture (n,) [rad], or up if it must; None if there is none.

    A hand that came from above goes up as it goes back.

    Args:
        motions: The arm.
        start: The posture.
        around: What the hand may not meet on its way; None: it may meet anything.
        opening: Gap between its fingers [m]; None: that to which they are told.
    """
    at = motions.arm.forward_kinematics(start)
    approach = rotation_matrix(at.orientation_xyzw) @ motions.arm.gripper.approach
    back = _straight(motions, start, -approach, around, opening)
    if back is None and -approach[2] >= UPWARDS:
        return way_up(motions, start, around, opening)
    return back


def way_up(
    motions: ArmMotions, start: FloatArray, around: CollisionModel | None = None, opening: float | None = None
) -> Trajectory | None:
    """The way of the hand straight up from a posture (n,) [rad]; None if there is none. Arguments as above."""
    return _straight(motions, start, np.array([0.0, 0.0, 1.0]), around, opening)


def _straight(
    motions: ArmMotions, start: FloatArray, way: FloatArray, around: CollisionModel | None, opening: float | None
) -> Trajectory | None:
    """A straight way from a posture along `way` (3,), as far as an arm may draw back that meets nothing."""
    at = motions.arm.forward_kinematics(start)
    for part in BACK:
        leaving = motions.plan_straight(start, moved(at, part * APPROACH * way), GENTLE).trajectory
        if leaving is not None and (around is None or motions.way_free(around, leaving, 0.0, opening)):
            return leaving
    return None
