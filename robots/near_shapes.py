"""A robot and things as arrays, for compiled loops: its tree of joints, convex shapes, and how far joints move them."""

from collections.abc import Hashable
from dataclasses import dataclass, replace
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from .collision import CollisionModel, _shape
from .model import RobotModel
from .near_kernel import BOX, CLOUD, CYLINDER, SPHERE, IntArray
from .obstacle import Obstacle
from .pose import FloatArray, Pose

KNOWN = 100
"""So many different things' shapes are kept."""


@dataclass(frozen=True, slots=True)
class Joints:
    """A tree of joints; the first is the base, which turns about its vertical axis.

    Attributes:
        parent: Number of the joint that carries each, (j,).
        frame: Pose of each in its parent's, (j, 12).
        axis: Unit axis, (j, 3).
        slides: 1 for those that slide rather than turn, (j,).
        motion: Which of all motions is theirs, (j,): of nv positions, then of the base's shift and turn.
    """

    parent: IntArray
    frame: FloatArray
    axis: FloatArray
    slides: IntArray
    motion: IntArray


@dataclass(frozen=True, slots=True)
class Shape:
    """One convex shape.

    Attributes:
        name: Of its link, or of the thing.
        solid: The same for coal.
        joint: That carries it; 0 for what none does.
        frame: Its pose in the joint's frame, or in the world, (12,): rotation matrix, row by row, and position.
        kind: See `near_kernel`.
        form: See `near_kernel.Scene`, (7,) [m].
        points: Of a cloud, (p, 3) [m].
    """

    name: str
    solid: Any
    joint: int
    frame: FloatArray
    kind: int
    form: FloatArray
    points: FloatArray

    @property
    def ball(self) -> FloatArray:
        """Centre and radius of a ball around it, (4,) [m]."""
        return self.form[3:]

    def reach(self) -> float:
        """How far its farthest point may be from the joint's origin [m]."""
        turn, shift = self.frame[:9].reshape(3, 3), self.frame[9:]
        return float(np.linalg.norm(turn @ self.ball[:3] + shift)) + float(self.ball[3])


class RobotShapes:
    """What pairs need of a robot alone; it is the same whatever things are around.

    Attributes:
        robot: The robot.
        model: Pinocchio's.
        joints: Its tree.
        columns: Which of all positions is that of each joint, by name.
        shapes: Its links' shapes.
        chains: What moves each of them; see `chain`.
        pairs: Those that may not touch, (k, 2).
        hands: Which shapes belong to each arm's hand, and may touch what it holds.
        tools: The joint that carries each arm's tool, and the tool's pose there, (12,).
        movers: Shapes that move against the world.
        fingers: Shapes that fingers carry.
    """

    def __init__(self, robot: RobotModel) -> None:
        """Take the robot's own geometry."""
        self.robot = robot
        bare = CollisionModel(robot)
        self.model, geometry = bare._model, bare._geometry
        self.joints = _joints(self.model)
        named = list(self.model.names)[1:]
        self.columns = {name: int(column) for name, column in zip(named, self.joints.motion[1:], strict=True)}
        self.shapes = [
            make_shape(name, each.geometry, int(each.parentJoint), _row(each.placement))
            for name, each in zip(bare._names, geometry.geometryObjects, strict=True)
        ]
        self.pairs: IntArray = np.array(
            [(int(each.first), int(each.second)) for each in geometry.collisionPairs], dtype=np.int64
        ).reshape(-1, 2)
        hands = {arm: bare._hand(arm) for arm in robot.arms}
        self.hands = {arm: {i for i, each in enumerate(self.shapes) if each.name in hands[arm]} for arm in hands}
        self.tools = {}
        for name, arm in robot.arms.items():
            frame = self.model.frames[self.model.getFrameId(arm.tool_frame)]
            self.tools[name] = int(frame.parentJoint), _row(frame.placement)
        self.movers = [i for i in range(len(self.shapes)) if bare._moves(i)]
        fingers = [name for arm in robot.arms.values() for name in arm.gripper.joints]
        behind = {int(each) for name in fingers for each in self.model.subtrees[self.model.getJointId(name)]}
        self.fingers = [i for i, each in enumerate(self.shapes) if each.joint in behind]
        self._links = self._lengths()
        self.chains = [self.chain(each) for each in self.shapes]
        self._known: dict[Hashable, Shape] = {}
        self._standing: dict[int, tuple[Obstacle, Shape]] = {}

    def held(self, arm: str, thing: Obstacle) -> Shape:
        """The shape of a thing that an arm holds, its pose being in the tool's frame."""
        joint, tool = self.tools[arm]
        frame = composed(tool, pose_row(thing.pose_obstacle_in_world))
        return replace(self._shape_of(thing), name=thing.name, joint=joint, frame=frame)

    def around(self, thing: Obstacle) -> Shape:
        """The shape of a thing that stands in the world."""
        known = self._standing.get(id(thing))
        if known is None or known[0] is not thing:
            if len(self._standing) > KNOWN:
                self._standing.clear()
            frame = pose_row(thing.pose_obstacle_in_world)
            known = self._standing[id(thing)] = thing, replace(self._shape_of(thing), name=thing.name, frame=frame)
        return known[1]

    def chain(self, shape: Shape) -> list[tuple[int, int, float]]:
        """What moves a shape, the base first: joints, which of all motions is theirs, and how far it may be from them.

        The base's shift and turn come first. How far the shape's farthest point may be is in m/rad, or 1 for shifts.
        """
        found = []
        reach, joint = shape.reach(), shape.joint
        while joint:
            found.append((joint, int(self.joints.motion[joint]), 1.0 if self.joints.slides[joint] else reach))
            reach += self._links[joint]
            joint = int(self.joints.parent[joint])
        nv = int(self.model.nv)
        return [(0, nv, 1.0), (0, nv + 1, reach), *found[::-1]]

    def _shape_of(self, thing: Obstacle) -> Shape:
        """A thing's shape, somewhere; made once for all that are alike."""
        key = thing.kind, thing.size, b"" if thing.corners is None else thing.corners.tobytes()
        if key not in self._known:
            if len(self._known) > KNOWN:
                self._known.clear()
            self._known[key] = make_shape("", _shape(thing), 0, np.zeros(12))
        return self._known[key]

    def _lengths(self) -> list[float]:
        """How far each joint's frame may be from that of the one that carries it [m]."""
        far = np.linalg.norm(self.joints.frame[:, 9:], axis=1).tolist()
        for k in np.flatnonzero(self.joints.slides).tolist():
            where = self.model.joints[k].idx_q
            far[k] += max(abs(self.model.lowerPositionLimit[where]), abs(self.model.upperPositionLimit[where]))
        return [float(each) for each in far]


def make_shape(name: str, solid: Any, joint: int, frame: FloatArray) -> Shape:
    """A convex shape of coal, carried by a joint."""
    solid.computeLocalAABB()
    centre = np.asarray(solid.aabb_center)
    kind, size, points = CLOUD, np.zeros(3), np.zeros((0, 3))
    if isinstance(solid, coal.Box):
        kind, size = BOX, np.asarray(solid.halfSide)
        radius = float(np.linalg.norm(size))
    elif isinstance(solid, coal.Sphere):
        kind, size = SPHERE, np.full(3, solid.radius)
        radius = float(solid.radius)
    elif isinstance(solid, coal.Cylinder):
        kind, size = CYLINDER, np.array([solid.radius, solid.halfLength, 0.0])
        radius = float(np.linalg.norm(size))
    else:
        if isinstance(solid, coal.ConvexBase):
            points = np.array(solid.points())
        else:  # some other kind, which is inside the box around it
            box = solid.aabb_local
            points = np.array([np.where(corner, box.max_, box.min_) for corner in np.ndindex(2, 2, 2)])
        radius = float(np.linalg.norm(points - centre, axis=1).max())
    return Shape(name, solid, joint, frame, kind, np.concatenate((size, centre, [radius])), points)


def pose_row(pose: Pose) -> FloatArray:
    """A pose as rotation matrix, row by row, and position, (12,)."""
    x, y, z, w = pose.orientation_xyzw.tolist()
    s = 2.0 / (x * x + y * y + z * z + w * w)
    # Numbers rather than arrays: a third of the time.
    turn = (
        *(1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)),
        *(s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)),
        *(s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)),
    )
    return np.array((*turn, *pose.position.tolist()))


def composed(one: FloatArray, other: FloatArray) -> FloatArray:
    """Product of two poses (12,)."""
    turn = one[:9].reshape(3, 3)
    return np.concatenate(((turn @ other[:9].reshape(3, 3)).ravel(), turn @ other[9:] + one[9:]))


def _row(placement: Any) -> FloatArray:
    return np.concatenate((np.asarray(placement.rotation).ravel(), np.asarray(placement.translation)))


def _joints(model: Any) -> Joints:
    """Pinocchio's tree. Joints with several axes, which nothing drives, stay where they are."""
    count, neutral = int(model.njoints), pin.neutral(model)
    frame, axis = np.zeros((count, 12)), np.zeros((count, 3))
    slides, motion = np.ones(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    frame[0, [0, 4, 8]] = axis[0, 2] = 1.0
    slides[0], motion[0] = 0, int(model.nv) + 1
    for k in range(1, count):
        joint = model.joints[k]
        frame[k], motion[k] = _row(model.jointPlacements[k]), int(joint.idx_v)
        if joint.nv == 1:
            data = joint.createData()
            joint.calc(data, neutral)
            way = np.asarray(data.S).reshape(6)
            slides[k] = int(way[:3].any())
            axis[k] = way[:3] if slides[k] else way[3:]
    return Joints(np.array(model.parents, dtype=np.int64), frame, axis, slides, motion)
