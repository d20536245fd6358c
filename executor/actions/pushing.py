"""Pushing an object along the table: a low way against its side and on, in a direction with room."""

from collections.abc import Iterator

import numpy as np

from executor.actions.closed_hand import Approach, contacts, hand_turns
from executor.actions.things import corners_of
from executor.arm_motions import WAY_CLEARANCE, ArmMotions, moved
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from robots.trajectories import ToolLimits, Trajectory
from twin.world import TABLE_X, TABLE_Y

PUSHING = ToolLimits(0.06, 0.3, 6.0, 0.2, 2.0, 30.0)
"""Tool limits while something is pushed."""
TILTS = (0.3, 0.0, 0.6, 0.9, 1.2)
"""Tilts [rad] of the hand that are tried: its finger tips go ahead."""
BESIDE = (0.04, 0.06, 0.08, 0.10, 0.13)
"""How far [m] beside an object's side the tool starts, the first where the hand is free."""
LOWEST = tuple(np.arange(0.004, 0.08, 0.006).tolist())
"""Heights [m] of the tool over the table that are tried: low, so that what is pushed does not topple."""
STABLE = 0.8
"""What is pushed higher than this part of the distance of its base's edge topples where friction is as at worst."""
BASE = 0.005
"""So much [m] of an object's height is its base."""
ROOM = 0.03
"""Distance [m] of what is pushed from the edges of the table and from other things at the end."""
HEADINGS = 24
"""Directions that are tried."""
OVERRUN = 0.03
"""How much farther [m] than needed a push is planned: contact may be felt late."""


def push_approach(motions: ArmMotions, object_id: int, way: float, rng: np.random.Generator) -> Approach | str:
    """A way along the table against an object's side and on by `way` [m], in any direction that has room.

    Raises:
        TwinError: There is no such object.
    """
    corners = corners_of(motions.world, object_id)
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    whole = motions.around(detailed={object_id})
    beside = motions.around(without={object_id})
    reached, best = False, None
    for heading in _headings(float(rng.uniform(-np.pi, np.pi))):
        along = np.array([np.cos(heading), np.sin(heading), 0.0])
        if not _room_to_push(motions, object_id, corners, along, way):
            continue
        side = middle - float(np.max((middle - corners) @ along)) * along
        base = corners[corners[:, 2] < corners[:, 2].min() + BASE]
        edge = float(np.max((base - middle) @ along))  # over which it would topple
        for turn in hand_turns(motions, TILTS, middle, along):
            low = _lowest(motions, beside, side, turn)
            if low is None:
                continue
            reached = True
            for off in BESIDE:
                start = Pose(np.append((side - off * along)[:2], low[1]), turn)
                stroke = _stroke(motions, low[0], start, (off + way + OVERRUN) * along)
                if stroke is None:
                    break
                before = stroke.at(0.0)[0]
                if not motions.free(whole, before, WAY_CLEARANCE, 0.0):
                    continue
                if motions.way_free(beside, stroke, WAY_CLEARANCE / 2, 0.0):
                    met, _ = contacts(motions, whole, stroke, object_id)
                    height = float(met[0, 2] - corners[:, 2].min()) if len(met) else np.inf
                    if height < STABLE * edge:
                        return Approach(before, stroke, along)
                    if best is None or height / edge < best[0]:
                        best = height / edge, Approach(before, stroke, along)
                break
    if best is not None:
        return best[1]
    if not reached:
        return "out of reach: no posture brings the hand beside the object in a direction with room to push"
    return "no room: no straight way along the table pushes the object"


def _lowest(
    motions: ArmMotions, beside: CollisionModel, side: FloatArray, turn: FloatArray
) -> tuple[FloatArray, float] | None:
    """The lowest posture of a hand at an object's side that is clear of the table, and the tool's height [m]."""
    near = motions.arm.home
    for height in LOWEST:
        q = motions.reach(Pose(np.array([side[0], side[1], height]), turn), near)
        if q is None:
            return None
        near = q
        if motions.free(beside, q, WAY_CLEARANCE, 0.0):
            return q, height
    return None


def _stroke(motions: ArmMotions, at: FloatArray, start: Pose, by: FloatArray) -> Trajectory | None:
    """A straight way of the tool from a pose by (3,) [m] that passes near the posture `at`, found on its middle."""
    back = motions.plan_straight(at, start, PUSHING).trajectory
    if back is None:
        return None
    return motions.plan_straight(back.at(back.duration)[0], moved(start, by), PUSHING).trajectory


def _room_to_push(motions: ArmMotions, object_id: int, corners: FloatArray, along: FloatArray, way: float) -> bool:
    """Whether an object that is pushed so far stays on the table and apart from other things."""
    ends = corners[:, :2] + (way + ROOM) * along[:2]
    if motions.world.spec.kind == "table" and not (
        np.all(ends >= [TABLE_X[0], TABLE_Y[0]]) and np.all(ends <= [TABLE_X[1], TABLE_Y[1]])
    ):
        return False
    aside = np.array([-along[1], along[0], 0.0])
    lower, upper = (corners @ aside).min() - ROOM, (corners @ aside).max() + ROOM
    front = float((corners @ along).max())
    for other in motions.world.state().objects:
        if other.id == object_id:
            continue
        its = corners_of(motions.world, other.id, other.pose_object_in_world)
        in_lane = (its @ aside).max() > lower and (its @ aside).min() < upper
        ahead = (its @ along).max() > front - 0.01 and (its @ along).min() < front + way + ROOM
        if in_lane and ahead:
            return False
    return True


def _headings(first: float) -> Iterator[float]:
    """Directions all around, the nearest to the first one first [rad]."""
    for number in range(HEADINGS):
        yield first + (-1) ** number * ((number + 1) // 2) * 2 * np.pi / HEADINGS
