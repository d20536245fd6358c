"""Trying a hand's way in the mind before it is driven: does the arm reach, turn and keep clear all along?

The servo turns twists into joint velocities of least size. The same is done here along straight lines, in coarse steps
and without time, with the servo's own pairs of things that may not come near each other.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from robots.arm_model import ArmModel
from robots.collision import CollisionModel, NearPair
from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.near_pairs import NearPairs
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose
from teleop.arm_servo import LENGTH
from teleop.servo_guard import STOP
from teleop.strokes import Reach
from teleop.table_operator import difference
from twin import World

STEP, TURN_STEP = 0.012, 0.08
"""Distance [m] and angle [rad] between two looks."""
ROOM = STOP + 0.0015
"""Least distance of what may not touch [m]: the servo would slow down nearer than this."""
APART = 0.0015
"""Least distance of open fingers from things [m]."""
BENT = 18.0
"""Largest condition number of the weighted Jacobian: above 17 the servo slows what leads to singular postures."""
WEIGHTS = np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])
LIMIT_ROOM = 0.04
"""Least distance of joints from their limits [rad]."""
FINE = 0.002
"""Distance between two looks for a touch [m]."""
TABLE = "table"
"""Name of what objects stand on."""
OFF = 0.002
"""An arm that cannot follow its line strays by more than this [m]."""


@dataclass(frozen=True, slots=True)
class Rehearsed:
    """How a way went.

    Attributes:
        q: Posture of the arm at its end, (n,) [rad].
        reason: Why it cannot be driven; empty when it can.
    """

    q: FloatArray
    reason: str = ""


@dataclass(frozen=True, slots=True)
class Touch:
    """A hand that just touches a thing.

    Attributes:
        tool: Where the tool is.
        near: Pairs of the arm and the thing's parts, the nearest first.
    """

    tool: Pose
    near: tuple[NearPair, ...]

    @property
    def point(self) -> FloatArray:
        """The touched point, (3,) [m]."""
        return self.near[0].point_on_second


class Rehearsal:
    """One arm among things that stay where they are.

    Attributes:
        arm: The arm.
        q: Where the arm's drives are told to be, (n,) [rad].
    """

    def __init__(
        self, world: World, arm: str, held: int | None = None, tool: Pose | None = None, without: Collection[int] = ()
    ) -> None:
        """Take the world as it stands.

        Args:
            world: The world.
            arm: Name of the arm.
            held: An object that the hand holds.
            tool: Where the tool is when it has grasped that object, where the object is now; None for where it is.
            without: Objects that do not count.
        """
        self._robot = world.placed_robot
        self.arm: ArmModel = self._robot.arms[arm]
        self._joints = self._robot.slice_of(arm)
        self._whole = world.commanded_positions
        self.q: FloatArray = self._whole[self._joints].copy()
        self._openings: Mapping[str, float] = dict(zip(self._robot.arms, world.commanded_openings, strict=True))
        around = world.obstacles(without=without)
        things: dict[str, Sequence[Obstacle]] = {}
        if held is not None:
            number = list(self._robot.arms).index(arm)
            frame = tool or world.state().arms[number].pose_tool_in_world
            things = {arm: [_seen_from(frame, each) for each in around if each.name == str(held)]}
            around = [each for each in around if each.name != str(held)]
        self._model = CollisionModel(self._robot, around, things, moving=[arm])
        self._pairs = NearPairs(self._robot, around, things)
        self._track = self._pairs.track()
        base = self._robot.pose_base_in_world
        self._base = base

    def along(
        self, start: FloatArray, ways: Sequence[Reach], opening: float | None = None, touching: float = APART
    ) -> Rehearsed:
        """Go along straight lines, one after the other.

        Args:
            start: Posture to start from, (n,) [rad].
            ways: The lines.
            opening: Gap of the fingers meanwhile [m]; None for what they were told.
            touching: Least distance of fingers and what is held from things [m]; negative where they shall touch.
        """
        q = start.copy()
        for way in ways:
            done = self._line(q, way.pose, opening, touching)
            if done.reason:
                return done
            q = done.q
        return Rehearsed(q)

    def until_touch(self, start: FloatArray, goal: Pose, opening: float, thing: str) -> Touch | None:
        """What is so when the fingers first touch a thing on a straight line to a pose.

        Args:
            start: Posture at the line's start, (n,) [rad]; nothing is touched there.
            goal: Where the line ends.
            opening: Gap of the fingers [m].
            thing: Name of what is to be touched.

        Returns:
            The touch; None where the line ends before, something else is in the way, or the arm cannot follow.
        """
        here = self.arm.forward_kinematics(start)
        off, turn = difference(here, goal)
        q = start
        for part in np.linspace(0.0, 1.0, max(round(float(np.linalg.norm(off)) / FINE), 2))[1:]:
            at = Pose(here.position + off * part, turned(turn * part, here.orientation_xyzw))
            done = self._line(q, at, opening, 0.0)
            if done.reason:
                touched = done.reason.startswith("no room") and done.reason.endswith(f" {thing}")
                return Touch(at, self._near(done.q, opening, thing)) if touched else None
            q = done.q
        return None

    def _near(self, q: FloatArray, opening: float, thing: str) -> tuple[NearPair, ...]:
        """Pairs of the arm and a thing's parts, the nearest first."""
        self._whole[self._joints] = q
        near = self._model.near(self._whole, np.inf, {**self._openings, self.arm.name: opening})
        return tuple(each for each in near if each.second == thing)

    def below(self, q: FloatArray, opening: float) -> float:
        """How far the fingers reach below the tool frame at a posture over the table [m].

        Args:
            q: The posture, (n,) [rad].
            opening: Gap of the fingers [m].
        """
        self.free(q, opening)
        over = [index for index in np.flatnonzero(self._pairs.contacts) if TABLE in self._pairs.names[int(index)]]
        return float(self.arm.forward_kinematics(q).position[2] - self._track.refine(np.array(over)).min())

    def bend(self, q: FloatArray) -> float:
        """Condition number of the weighted Jacobian at a posture (n,) [rad]."""
        values = np.linalg.svd(WEIGHTS[:, None] * self.arm.jacobian(q), compute_uv=False)
        return float(values[0] / values[-1])

    def free(self, q: FloatArray, opening: float | None = None, touching: float = APART) -> str:
        """Name what is too near at a posture; empty when nothing is."""
        self._whole[self._joints] = q
        openings = dict(self._openings)
        if opening is not None:
            openings[self.arm.name] = opening
        self._track.move(self._pairs.positions(self._whole, openings), self._base)
        least = np.where(self._pairs.contacts, touching, ROOM)
        near = self._track.below(least)
        if not len(near):
            return ""
        first, second = self._pairs.names[int(near[int(np.argmin(self._track.bounds[near]))])]
        return f"{first} too near to {second}"

    def _line(self, q: FloatArray, goal: Pose, opening: float | None, touching: float) -> Rehearsed:
        here = self.arm.forward_kinematics(q)
        off, turn = difference(here, goal)
        steps = max(round(np.linalg.norm(off) / STEP), round(np.linalg.norm(turn) / TURN_STEP), 1)
        lower, upper = self.arm.lower + LIMIT_ROOM, self.arm.upper - LIMIT_ROOM
        for step in range(1, steps + 1):
            at = Pose(here.position + off * (step / steps), turned(turn * (step / steps), here.orientation_xyzw))
            for _ in range(3):
                shift, rotation = difference(self.arm.forward_kinematics(q), at)
                left, values, right = np.linalg.svd(WEIGHTS[:, None] * self.arm.jacobian(q), full_matrices=False)
                if values[0] > BENT * values[-1]:
                    return Rehearsed(q, "out of reach: nearly singular")
                q = q + right.T @ ((left.T @ (WEIGHTS * np.concatenate((shift, rotation)))) / values)
                if max(np.abs(shift).max(), np.abs(rotation).max() * LENGTH) < OFF:
                    break
            if (q < lower).any() or (q > upper).any():
                return Rehearsed(q, "out of reach: a joint at its limit")
            if near := self.free(q, opening, touching):
                return Rehearsed(q, f"no room: {near}")
        return Rehearsed(q)


def turned(vector: FloatArray, orientation_xyzw: FloatArray) -> FloatArray:
    """An orientation after a turn by a rotation vector (3,) [rad] about the world's axes."""
    angle = float(np.linalg.norm(vector))
    if angle < 1e-9:
        return orientation_xyzw
    x, y, z = (vector / angle).tolist()
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    rotation = np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * (skew @ skew)
    return quaternion_xyzw(rotation @ rotation_matrix(orientation_xyzw))


def _seen_from(frame: Pose, thing: Obstacle) -> Obstacle:
    """The same thing with its pose in a frame."""
    back, where = rotation_matrix(frame.orientation_xyzw).T, thing.pose_obstacle_in_world
    turned = np.ascontiguousarray(back @ rotation_matrix(where.orientation_xyzw))
    return replace(
        thing, pose_obstacle_in_world=Pose(back @ (where.position - frame.position), quaternion_xyzw(turned))
    )
