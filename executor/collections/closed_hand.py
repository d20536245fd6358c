"""Pressing on a thing and pushing it with closed fingers, where the arm is firm and does not hide the thing."""

import numpy as np

from executor.collections.driven_grasps import moved, pose_of
from executor.collections.performance import PlannedDemo
from executor.collections.rehearsal import Rehearsal, Touch, turned
from executor.collections.sight_lines import SightLines
from robots.gripper import Gripper
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import FloatArray, Pose
from teleop.strokes import Grip, Manner, Press, Reach, Rest
from teleop.table_operator import difference
from twin import World
from twin.objects import ObjectModel

QUICK = 0.22
"""Speed of what is not shown [m/s]."""
SEEN = 0.4
"""At least so much of the object is seen by the robot's camera when the hand is at it."""
HIDDEN = 1.5
"""How little welcome a posture is that hides all of it."""
SQUEEZE = (3.0, 7.0)
"""With what force the hand presses down on a thing [N]."""
TIP_HEIGHT = (0.008, 0.025)
"""Least and largest height of the finger tips when they push [m]."""
PRESS_AIM = (0.0, 0.5)
"""Angle of the hand's direction to straight down when it presses [rad],"""
PUSH_AIM = (0.4, 1.2)
"""when it pushes,"""
LAY_AIM, LAY_BEYOND = (1.45, 1.62), 0.02
"""and when fingers are laid across a rim; the tool is then so far beyond its middle [m]."""
LEVEL = 0.0008
"""Both sides of a rim are touched within this height [m]."""
SUNK = 0.02
"""A top so far below the rim is no top [m]."""
RIM = 0.93
"""Where a rim is, as a part of half the width."""
FIRM = 13.0
"""Largest condition number of the arm where it presses or pushes."""
DRAWN, TRIED = 30, 10
"""Directions of the hand that are drawn, and of those in reach, tried in the mind."""


def manner(rng: np.random.Generator) -> Manner:
    """How the operator drives this time."""
    return Manner(tremble=float(rng.uniform(0.002, 0.006)), hesitation=float(rng.uniform(0.05, 0.25)))


def press(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    """Closed fingers come down on the object's top from above it, and leave."""
    rehearsal = Rehearsal(world, arm)
    pose, model = pose_of(world, target), world.model_of(target)
    top = pose.position + [0.0, 0.0, float(model.half_extents[2])]
    # Either the finger tips come down on it, or the fingers are laid on it, or across its rim.
    tall = bool(model.half_extents[2] > model.half_extents[0])
    laid = rng.random() < 0.4 or (tall and not _covered(model))  # a light cup would tip over
    rim = 0.0 if _covered(model) else RIM * float(model.half_extents[0])
    sight = SightLines(world, arm, target)
    for key in _aimed(rehearsal, sight, top, LAY_AIM if laid else PRESS_AIM, LAY_BEYOND if laid else rim, rng):
        high = float(rng.uniform(0.05, 0.10))
        if laid:
            found = _laying(rehearsal, key, top, str(target), high)
        else:
            found = _tipping(rehearsal, key, top, rim, str(target), high)
        if found is None:
            continue
        above, touch = found
        speed = float(rng.uniform(0.05, 0.10))
        shown = (
            Rest(0.2),
            Reach(moved(touch, np.array([0.0, 0.0, 0.006])), speed, near=0.0015),
            Press(np.array([0.0, 0.0, -1.0]), float(rng.uniform(*SQUEEZE)), float(rng.uniform(0.8, 1.6))),
            Reach(above, speed, near=0.01),
            Rest(0.2),
        )
        return PlannedDemo(arm, target, shown, (Grip("close", 0.0), Reach(above, QUICK, near=0.006)), manner(rng))
    return None


def _laying(rehearsal: Rehearsal, key: Pose, top: FloatArray, thing: str, high: float) -> tuple[Pose, Pose] | None:
    """Where the tool is above a thing and when its fingers lie level on it; None where that is out of reach.

    Args:
        rehearsal: The arm.
        key: About where the tool is when it touches.
        top: The middle of the thing's top, (3,) [m].
        thing: The thing's name.
        high: How far up it begins [m].
    """
    for _ in range(4):
        found = _lowered(rehearsal, key, thing, high)
        if found is None:
            return None
        above, touch = found
        out = rotation_matrix(key.orientation_xyzw) @ rehearsal.arm.gripper.approach
        out = np.array([out[0], out[1], 0.0]) / np.hypot(out[0], out[1])
        sides = [(float((each.point_on_second - top) @ out), each.distance) for each in touch.near]
        near_gap, near_at = min(((gap, at) for at, gap in sides if at < 0.0), default=(0.0, 0.0))
        far_gap, far_at = min(((gap, at) for at, gap in sides if at >= 0.0), default=(0.0, 0.0))
        if abs(far_gap - near_gap) < LEVEL:
            return above, touch.tool
        lean = (far_gap - near_gap) / max(far_at - near_at, 0.01)
        axis = np.array([-out[1], out[0], 0.0])
        key = Pose(touch.tool.position, turned(lean * axis, key.orientation_xyzw))
    return None


def _lowered(rehearsal: Rehearsal, key: Pose, thing: str, high: float) -> tuple[Pose, Touch] | None:
    """Where the tool begins so high [m] above a thing, and how it touches it; None where that is out of reach."""
    above = moved(key, np.array([0.0, 0.0, high]))
    came = rehearsal.along(rehearsal.q, (Reach(above, QUICK),), 0.0)
    if came.reason:
        return None
    touch = rehearsal.until_touch(came.q, moved(key, np.array([0.0, 0.0, -0.03])), 0.0, thing)
    return None if touch is None else (above, touch)


def _tipping(
    rehearsal: Rehearsal, key: Pose, top: FloatArray, rim: float, thing: str, high: float
) -> tuple[Pose, Pose] | None:
    """Where the tool is above a thing and when its finger tips touch the top; None where that is out of reach.

    Args:
        rehearsal: The arm.
        key: About where the tool is when it touches.
        top: The middle of the thing's top, (3,) [m].
        rim: Where the rim is that is touched, outwards from the middle [m]; 0 for the middle.
        thing: The thing's name.
        high: How far up it begins [m].
    """
    found = _lowered(rehearsal, key, thing, high)
    if found is None:
        return None
    above, touch = found
    off = (top - touch.point)[:2]
    aside = np.array([*(off if rim == 0.0 else (0.0, 0.0)), 0.0])
    return moved(above, aside), moved(touch.tool, aside)


def push(world: World, arm: str, target: int, rng: np.random.Generator) -> PlannedDemo | None:
    """The closed hand comes beside the object, moves it along the table, and leaves."""
    rehearsal, alone = Rehearsal(world, arm), Rehearsal(world, arm, without={target})
    start, centre = rehearsal.q, pose_of(world, target).position
    height = min(float(rng.uniform(*TIP_HEIGHT)), 0.8 * float(world.model_of(target).half_extents[2]))
    sight = SightLines(world, arm, target)
    for at in _aimed(alone, sight, np.array([*centre[:2], height]), PUSH_AIM, 0.0, rng):
        angle = float(rng.uniform(-2.0, 2.0))  # not towards the robot
        way = np.array([np.cos(angle), np.sin(angle), 0.0])
        beside = moved(at, -float(rng.uniform(0.09, 0.12)) * way)
        above = moved(beside, np.array([0.0, 0.0, 0.08]))
        came = rehearsal.along(start, (Reach(above, QUICK), Reach(beside, QUICK)), 0.0)
        if came.reason:
            continue
        touched = rehearsal.until_touch(came.q, at, 0.0, str(target))
        if touched is None:
            continue
        touch = touched.tool
        goal = moved(touch, float(rng.uniform(0.055, 0.10)) * way)
        # The object gives way.
        if alone.along(came.q, (Reach(goal, QUICK),), 0.0).reason:
            continue
        back = moved(goal, -float(rng.uniform(0.03, 0.06)) * way)
        shown = (
            Rest(0.2),
            Reach(moved(touch, -0.01 * way), 0.12, near=0.005),
            Reach(goal, float(rng.uniform(0.03, 0.06)), near=0.004, patience=6.0),
            Rest(float(rng.uniform(0.1, 0.3))),
            Reach(back, 0.12, near=0.008),
            Rest(0.7),
        )
        before = (Grip("close", 0.0), Reach(above, QUICK, onwards=True), Reach(beside, QUICK, near=0.006))
        return PlannedDemo(arm, target, shown, before, manner(rng))
    return None


def _covered(model: ObjectModel) -> bool:
    """Whether an object has something in the middle of its top that can be pressed on."""
    top = float(model.half_extents[2])
    for part in model.parts:
        low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
        if (low[:2] < 0.0).all() and (high[:2] > 0.0).all() and high[2] > top - SUNK:
            return True
    return False


def _aimed(
    rehearsal: Rehearsal,
    sight: SightLines,
    tip: FloatArray,
    aim: tuple[float, float],
    beyond: float,
    rng: np.random.Generator,
) -> list[Pose]:
    """Poses of the tool in reach whose closed finger tips are at a point; those that are far from singular first.

    Args:
        rehearsal: The arm.
        sight: Lines along which the object is to be seen.
        tip: Where the tips are to be, (3,) [m].
        aim: Least and largest angle of the hand's direction to straight down [rad].
        beyond: How much farther outwards the tips are [m].
        rng: Source of chance.
    """
    found = []
    here = rehearsal.arm.forward_kinematics(rehearsal.q)
    for number in range(DRAWN):
        orientation, approach, out = _aiming(rehearsal.arm.gripper, tip, aim, rng)
        pose = Pose(tip + beyond * out, orientation)
        for _ in range(2):  # first to see how far the fingers reach below the tool frame there
            posture = rehearsal.arm.inverse_kinematics(
                pose, start=rehearsal.q, posture=rehearsal.q, tolerance=1e-4, max_restarts=2
            )
            if not posture.success:
                break
            below = rehearsal.below(posture.q, 0.0)
            level = approach[2] > -0.3  # fingers that lie level have no tip that points down
            aside = 0.0 if level else below * float(approach[:2] @ out[:2]) / -float(approach[2])
            pose = Pose(tip + (beyond - aside) * out + [0.0, 0.0, below], orientation)
        if posture.success and (bend := rehearsal.bend(posture.q)) < FIRM:
            seen = sight.seen(posture.q, 0.0)
            if seen >= SEEN:
                turn = float(np.linalg.norm(difference(here, pose)[1]))
                travel = float(np.abs(posture.q - rehearsal.q).max())
                effort = 0.6 * bend / FIRM - HIDDEN * seen + 0.5 * turn + 0.3 * travel
                found.append((effort + float(rng.uniform(0.0, 0.6)), number, pose))
    return [pose for _, _, pose in sorted(found)[:TRIED]]


def _aiming(
    gripper: Gripper, at: FloatArray, from_vertical: tuple[float, float], rng: np.random.Generator
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """A hand's orientation (xyzw), direction, and the level part of that: down and outwards, its fingers level.

    Args:
        gripper: The hand.
        at: Where it works, (3,) [m].
        from_vertical: Least and largest angle of its direction to straight down [rad].
        rng: Source of chance.
    """
    lean = float(rng.uniform(*from_vertical))
    heading = float(np.arctan2(at[1], at[0]) + rng.uniform(-0.7, 0.7))
    out = np.array([np.cos(heading), np.sin(heading), 0.0])
    approach = np.sin(lean) * out + np.array([0.0, 0.0, -np.cos(lean)])
    closing = float(rng.choice((-1.0, 1.0))) * np.array([-out[1], out[0], 0.0])
    world = np.column_stack((approach, closing, np.cross(approach, closing)))
    hand = np.column_stack((gripper.approach, gripper.closing, np.cross(gripper.approach, gripper.closing)))
    return quaternion_xyzw(world @ hand.T), approach, out
