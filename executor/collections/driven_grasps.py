"""Which grasp a person would drive to: one that the arm reaches along straight lines, and carries from."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from executor.collections.rehearsal import BENT, Rehearsal
from executor.grasp_choice import DEPTHS, TILTS
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from teleop.strokes import Reach
from teleop.table_operator import difference
from twin import World
from twin.grasp_poses import GraspPose, grasp_poses

BEFORE = (0.05, 0.10)
"""How far before the grasp the hand comes onto the straight way to it, at least and at most [m]."""
MOST_LOOKED_AT = 80
"""So many grasps are asked for a posture at most,"""
MOST_TRIED = 14
"""and so many of those with a comfortable one are tried in the mind."""
OVER = 0.10
"""How much higher a way round goes [m]."""
WIDE = 0.010
"""Least distance of the fingers from things on the way to the point before the grasp [m]."""
CLOSED_ROOM = 0.0015
"""Least distance from the object of what of the hand is not made to touch it, when the fingers are closed [m]."""


@dataclass(frozen=True, slots=True)
class ChosenGrasp:
    """A grasp and the way to it.

    Attributes:
        grasp: The grasp.
        ways: Straight lines to it; the last one ends there.
        q: Posture at the grasp, (n,) [rad].
    """

    grasp: GraspPose
    ways: tuple[Reach, ...]
    q: FloatArray


def reachable_grasps(
    world: World,
    rehearsal: Rehearsal,
    object_id: int,
    rng: np.random.Generator,
    speed: float,
    dislike: Callable[[FloatArray], float] | None = None,
) -> Iterator[ChosenGrasp]:
    """Grasps that the arm can be driven to from where it is, in a loosely shuffled order.

    Args:
        world: The world.
        rehearsal: The arm, its hand empty and open.
        object_id: What is to be grasped.
        rng: Source of chance.
        speed: Speed of the way there [m/s]; the end of it is slower.
        dislike: What makes a posture (n,) less welcome, 0 for nothing.
    """
    arm = rehearsal.arm
    start = rehearsal.q
    here = arm.forward_kinematics(start)
    closed = _Closed(world, arm.name, object_id)
    for proposal in _comfortable(world, rehearsal, object_id, rng, dislike)[:MOST_TRIED]:
        tool = proposal.pose_tool_in_world
        before = moved(tool, -float(rng.uniform(*BEFORE)) * proposal.approach)
        near = Reach(before, speed, near=0.008, aligned=0.04)
        last = Reach(tool, min(0.6 * speed, 0.12), near=0.0025)
        for round_about in _ways_round(here, before, proposal.approach, speed):
            come = rehearsal.along(start, (*round_about, near), proposal.opening, WIDE)
            done = come if come.reason else rehearsal.along(come.q, (last,), proposal.opening)
            if not done.reason and closed.free(done.q, proposal.width):
                yield ChosenGrasp(proposal, (*round_about, near, last), done.q)
                break


def _comfortable(
    world: World,
    rehearsal: Rehearsal,
    object_id: int,
    rng: np.random.Generator,
    dislike: Callable[[FloatArray], float] | None,
) -> list[GraspPose]:
    """Grasps for which the arm has a posture, those first that are far from singular and need little turning."""
    arm, start = rehearsal.arm, rehearsal.q
    here = arm.forward_kinematics(start)
    thing, pose = world.model_of(object_id), pose_of(world, object_id)
    proposals = grasp_poses(thing, pose, arm.gripper, depths=DEPTHS, tilts=TILTS)
    steadiness = np.arange(len(proposals)) / max(len(proposals), 1)
    order = np.argsort(steadiness + rng.uniform(0.0, 1.0, len(proposals)))[:MOST_LOOKED_AT]
    found = []
    for number in order.tolist():
        tool = proposals[number].pose_tool_in_world
        posture = arm.inverse_kinematics(tool, start=start, posture=start, tolerance=1e-4, max_restarts=2)
        if not posture.success or (bend := rehearsal.bend(posture.q)) > BENT:
            continue
        turn = float(np.linalg.norm(difference(here, tool)[1]))
        travel = float(np.abs(posture.q - start).max())
        effort = 0.6 * bend / BENT + 0.6 * turn + 0.3 * travel + 0.3 * steadiness[number] + float(rng.uniform(0.0, 0.5))
        found.append((effort + (dislike(posture.q) if dislike else 0.0), number))
    return [proposals[number] for _, number in sorted(found)]


class _Closed:
    """A hand with the fingers closed on an object: only what is made to touch it may."""

    def __init__(self, world: World, arm: str, object_id: int) -> None:
        robot = world.placed_robot
        touching = [(link, str(object_id)) for link in robot.arms[arm].gripper.touching]
        self._model = CollisionModel(robot, world.obstacles({object_id}), moving=[arm], may_touch=touching)
        self._whole = world.commanded_positions
        self._joints = robot.slice_of(arm)
        self._openings = dict(zip(robot.arms, world.commanded_openings, strict=True))
        self._arm = arm

    def free(self, q: FloatArray, width: float) -> bool:
        self._whole[self._joints] = q
        return self._model.free(self._whole, self._openings | {self._arm: width}, CLOSED_ROOM)


def _ways_round(start: Pose, before: Pose, approach: FloatArray, speed: float) -> Sequence[tuple[Reach, ...]]:
    """Ways to the point before a grasp: straight, or over a point above it, or around it."""
    above = Pose(before.position + [0.0, 0.0, OVER], before.orientation_xyzw)
    behind = Pose(before.position - OVER * approach + [0.0, 0.0, 0.3 * OVER], before.orientation_xyzw)
    return [(), *((Reach(each, speed, onwards=True),) for each in (above, behind))]


def pose_of(world: World, object_id: int) -> Pose:
    """Where an object is now."""
    return next(each.pose_object_in_world for each in world.state().objects if each.id == object_id)


def moved(pose: Pose, by: FloatArray) -> Pose:
    """A pose shifted by (3,) [m]."""
    return Pose(pose.position + by, pose.orientation_xyzw)
