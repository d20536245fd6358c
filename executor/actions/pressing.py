"""Pressing an object from above: a way straight down on which it is met around its middle."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from executor.actions.closed_hand import DOWN, Approach, contacts, hand_turns
from executor.actions.things import corners_of
from executor.arm_motions import WAY_CLEARANCE, ArmMotions, moved
from executor.grasp_choice import GENTLE
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from robots.trajectories import ToolLimits, Trajectory

FEELING = ToolLimits(0.03, 0.3, 6.0, 0.2, 2.0, 30.0)
"""Tool limits on the way to a touch."""
TILTS = (0.0, 0.3, 0.6, 0.9, 1.2, 1.4)
"""Tilts [rad] of the hand that are tried: the last ones lay it across a rim."""
ABOVE = (0.05, 0.08, 0.12)
"""How far [m] above an object's top the tool starts down, the first where the hand is free."""
DEPTHS = (0.10, 0.07, 0.04, 0.02, 0.0, -0.015)
"""How far [m] below the top the tool goes at most, the first that is free: into what is hollow, if it must."""
SHORT = 0.003
"""So far [m] above what is pressed the hand goes on by feeling."""
AIMINGS = 3
"""How often the hand's aim is corrected so that what touches is over the middle."""
RIM = 0.4
"""What is met nowhere nearer to the middle than this part of half the width is a rim."""
LAID = 1.1
"""From this tilt [rad] on a hand lies across a rim; a steeper one goes in and sticks:"""
WEDGED = 0.75
"""that is as bad as to meet it so much farther from the middle."""
CENTRED = 0.25
"""What is pressed within this part of half its width from its middle does not tip at all,"""
STEADY = 0.6
"""and within this part not if the hand lies on it broadly."""


def press_approach(motions: ArmMotions, object_id: int) -> Approach | str:
    """A way straight down onto an object, so that it is met around the middle of its top; or why there is none.

    What is open above is met at its bottom by fingers that fit in, or across its rim.

    Raises:
        TwinError: There is no such object.
    """
    corners = corners_of(motions.world, object_id)
    whole = motions.around(detailed={object_id})
    beside = motions.around(without={object_id})
    reached, best = False, None
    for tilt in TILTS:
        for turn in hand_turns(motions, (tilt,), (corners.min(axis=0) + corners.max(axis=0)) / 2):
            for meeting in _aimed(motions, whole, beside, corners, turn, object_id):
                reached = True
                if meeting.rim and tilt < LAID:
                    meeting = replace(meeting, off=meeting.off + WEDGED)
                if best is None or meeting.off < best.off:
                    best = meeting
            if best is not None and best.off < CENTRED:
                break
        if best is not None and best.off < STEADY:
            break
    if best is not None and best.off < 1.0:
        near = _until(motions, best.way, best.touching)
        if near is not None:
            return Approach(best.way.at(0.0)[0], near, DOWN)
    if not reached:
        return "out of reach: no free way brings the hand down onto the object"
    return "no room: the hand meets the object only beside its middle"


@dataclass(frozen=True, slots=True)
class _Meeting:
    """How a way down meets an object.

    Attributes:
        way: The way.
        touching: Posture at which the hand touches first, (n,) [rad].
        off: Distance of the middle of what is met from the object's, in half widths.
        rim: Whether nothing near the middle is met.
    """

    way: Trajectory
    touching: FloatArray
    off: float
    rim: bool


def _aimed(
    motions: ArmMotions,
    whole: CollisionModel,
    beside: CollisionModel,
    corners: FloatArray,
    turn: FloatArray,
    object_id: int,
) -> Iterator[_Meeting]:
    """Ways down with a hand held one way, each aimed better than the one before, until it is centred."""
    lower, upper = corners.min(axis=0), corners.max(axis=0)
    middle, half = (lower + upper) / 2, float((upper - lower)[:2].min()) / 2
    aim = np.array(middle[:2])
    for _ in range(AIMINGS):
        way = _way_down(motions, whole, beside, Pose(np.append(aim, upper[2]), turn), float(upper[2] - lower[2]))
        if way is None:
            return
        met, touching = contacts(motions, whole, way, object_id)
        if touching is None:
            return
        away = np.linalg.norm(met[:, :2] - middle[:2], axis=1)
        aside = middle[:2] - met[:, :2].mean(axis=0)
        off = float(np.linalg.norm(aside)) / half
        yield _Meeting(way, touching, off, float(away.min()) > RIM * half)
        if off < CENTRED:
            return
        aim = aim + aside


def _way_down(
    motions: ArmMotions, whole: CollisionModel, beside: CollisionModel, top: Pose, height: float
) -> Trajectory | None:
    """A way straight down from above a pose of the tool at an object's top, as deep as may be; None without one."""
    for above in ABOVE:
        before = motions.reach(moved(top, -above * DOWN), motions.arm.home)
        if before is None:
            return None
        if not motions.free(whole, before, WAY_CLEARANCE, 0.0):
            continue
        for depth in DEPTHS:
            if depth < height:
                way = motions.plan_straight(before, moved(top, depth * DOWN), FEELING).trajectory
                if way is not None and motions.way_free(beside, way, WAY_CLEARANCE, 0.0, back=True):
                    return way
        return None
    return None


def _until(motions: ArmMotions, way: Trajectory, touching: FloatArray) -> Trajectory | None:
    """The part of a way down that ends a little above the posture where the hand touches."""
    forward = motions.arm.forward_kinematics
    before = way.at(0.0)[0]
    start, end = forward(before), forward(touching)
    length = max(float(start.position[2] - end.position[2]) - SHORT, 0.0)
    return motions.plan_straight(before, moved(start, length * DOWN), GENTLE).trajectory
