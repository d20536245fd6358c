"""Distances of a robot to itself and to things around it (coal, through Pinocchio): the geometry that planners ask."""

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from .kinematics import configuration, rotation_matrix, whole_model
from .model import RobotModel
from .obstacle import FLOOR, Obstacle
from .pose import FloatArray, Pose, read_only

__all__ = ["FLOOR", "CollisionModel", "NearPair", "Nearest", "Obstacle"]


@dataclass(frozen=True, slots=True)
class Nearest:
    """The nearest pair.

    Attributes:
        distance: Between the two [m]; negative when they overlap.
        first: Link of the robot.
        second: Another link, or an obstacle's name.
    """

    distance: float
    first: str
    second: str


@dataclass(frozen=True, slots=True)
class NearPair:
    """Two things and where they are nearest.

    Attributes:
        distance: Between the two [m]; negative when they overlap.
        first: Link of the robot.
        second: Another link, or an obstacle's name.
        point_on_first: The nearest point of the first in the world, (3,) [m].
        point_on_second: That of the second, (3,) [m].
    """

    distance: float
    first: str
    second: str
    point_on_first: FloatArray
    point_on_second: FloatArray

    def __post_init__(self) -> None:
        """Freeze the points."""
        object.__setattr__(self, "point_on_first", read_only(self.point_on_first))
        object.__setattr__(self, "point_on_second", read_only(self.point_on_second))


class CollisionModel:
    """All links of a robot with the things around it and what it holds. Not safe to share between threads.

    Left out are pairs that cannot collide or may touch: neighbours in the tree, the fingers of one gripper, links that
    overlap in the home posture or in nearly every other (they are built so), and the pairs that the robot's file names.

    Attributes:
        robot: The robot, where it stands.
        obstacles: Things around it.
        held: Things that move with a tool, by arm; their poses are in the tool's frame.
    """

    def __init__(
        self,
        robot: RobotModel,
        obstacles: Sequence[Obstacle] = (),
        held: Mapping[str, Sequence[Obstacle]] | None = None,
        *,
        may_touch: Sequence[tuple[str, str]] = (),
        moving: Sequence[str] | None = None,
    ) -> None:
        """Build the geometry.

        Args:
            robot: The robot, where it stands.
            obstacles: Things around it.
            held: Things in the grippers, by arm; `pose_obstacle_in_world` is then the pose in the tool frame.
            may_touch: Pairs of a link's or a held thing's name and an obstacle's name whose contact is intended.
            moving: Arms that will move; pairs that stand still while only these do are left out. None takes all.

        Raises:
            RobotError: `held` or `moving` names an arm that the robot does not have.
        """
        for arm in (*(held or {}), *(moving or ())):
            robot.slice_of(arm)
        self.robot = robot
        self.obstacles = tuple(obstacles)
        self.held = {arm: tuple(things) for arm, things in (held or {}).items()}
        self._model = whole_model(robot.urdf_path)
        self._data = self._model.createData()
        self._geometry, own_pairs = _robot_geometry(robot)
        own = self._geometry.ngeoms
        base = self._base = robot.pose_base_in_world
        to_base = pin.SE3(rotation_matrix(base.orientation_xyzw), np.array(base.position)).inverse()
        held_by = {
            arm: [self._add(thing, robot.arms[arm].tool_frame) for thing in things] for arm, things in self.held.items()
        }
        carried = [index for things in held_by.values() for index in things]
        around = [self._add(thing, None, to_base) for thing in self.obstacles]
        self._around, self._carried = around, held_by
        names = [_name(self._model, each) for each in self._geometry.geometryObjects]
        allowed = {frozenset(pair) for pair in may_touch} | robot.may_touch
        if robot.drive is not None:
            allowed |= {frozenset((link, FLOOR)) for link in robot.drive.on_floor}
        pairs = list(own_pairs)
        for arm, things in held_by.items():
            hand = self._hand(arm)
            pairs += [(link, index) for index in things for link in range(own) if names[link] not in hand]
        pairs += [
            (one, other) for first, second in combinations(held_by.values(), 2) for one in first for other in second
        ]
        for thing in around:
            pairs += [
                (mover, thing)
                for mover in (*range(own), *carried)
                # What the base is bolted to is not hit by it.
                if frozenset((names[mover], names[thing])) not in allowed and self._moves(mover)
            ]
        self._geometry.removeAllCollisionPairs()
        still = set() if moving is None else self._still(moving)
        for first, second in pairs:
            if first in still and second in still:
                continue
            if frozenset((names[first], names[second])) not in allowed:
                self._geometry.addCollisionPair(pin.CollisionPair(first, second))
        self._names = names
        self._geometry_data = pin.GeometryData(self._geometry)
        self._margin = 0.0

    def free(self, q: FloatArray, openings: Mapping[str, float] | None = None, margin: float = 0.0) -> bool:
        """Whether nothing is nearer than a margin [m] to what it may not touch.

        Args:
            q: Driven positions of all arms, (n,) [rad].
            openings: Gap of the fingers by arm [m]; open where not given.
            margin: Smallest distance allowed [m].
        """
        if margin != self._margin:
            for request in self._geometry_data.collisionRequests:
                request.security_margin = margin
            self._margin = margin
        return not pin.computeCollisions(
            self._model, self._data, self._geometry, self._geometry_data, self._configuration(q, openings), True
        )

    def place_base(self, pose_base_in_world: Pose) -> None:
        """Stand the robot elsewhere among the same obstacles; what it holds moves with it."""
        self._base = pose_base_in_world
        to_base = _placement(pose_base_in_world).inverse()
        for index, thing in zip(self._around, self.obstacles, strict=True):
            self._geometry.geometryObjects[index].placement = to_base * _placement(thing.pose_obstacle_in_world)

    def nearest(self, q: FloatArray, openings: Mapping[str, float] | None = None) -> Nearest:
        """The nearest pair of what may not touch; see `free`. Distances below 0 are depths of penetration."""
        if len(self._geometry.collisionPairs) == 0:
            return Nearest(float("inf"), "", "")
        index = pin.computeDistances(
            self._model, self._data, self._geometry, self._geometry_data, self._configuration(q, openings)
        )
        pair = self._geometry.collisionPairs[index]
        distance = float(self._geometry_data.distanceResults[index].min_distance)
        return Nearest(distance, self._names[pair.first], self._names[pair.second])

    def near(self, q: FloatArray, within: float, openings: Mapping[str, float] | None = None) -> list[NearPair]:
        """All pairs of what may not touch that are nearer than `within` [m], the nearest first; see `nearest`."""
        if len(self._geometry.collisionPairs) == 0:
            return []
        pin.computeDistances(
            self._model, self._data, self._geometry, self._geometry_data, self._configuration(q, openings)
        )
        to_world = _placement(self._base)
        found = []
        for pair, result in zip(self._geometry.collisionPairs, self._geometry_data.distanceResults, strict=True):
            if result.min_distance < within:
                points = (to_world.act(result.getNearestPoint1()), to_world.act(result.getNearestPoint2()))
                names = self._names[pair.first], self._names[pair.second]
                found.append(NearPair(float(result.min_distance), *names, *points))
        return sorted(found, key=lambda each: each.distance)

    def _configuration(self, q: FloatArray, openings: Mapping[str, float] | None) -> FloatArray:
        return configuration(self._model, self.robot.expand(q, openings or {}))

    def _add(self, thing: Obstacle, frame: str | None, to_base: Any = None) -> int:
        """Add a thing that is fixed to a frame, or to the world; returns its number."""
        placement = _placement(thing.pose_obstacle_in_world)
        joint = parent = 0
        if frame is None:
            placement = to_base * placement
        else:
            parent = self._model.getFrameId(frame)
            joint = self._model.frames[parent].parentJoint
            placement = self._model.frames[parent].placement * placement
        return int(
            self._geometry.addGeometryObject(
                pin.GeometryObject(f"thing:{thing.name}", joint, parent, placement, _shape(thing))
            )
        )

    def _moves(self, index: int) -> bool:
        return int(self._geometry.geometryObjects[index].parentJoint) != 0 or self.robot.drive is not None

    def _still(self, moving: Sequence[str]) -> set[int]:
        """Geometries that do not move when only some arms do."""
        swept: set[int] = set()
        for arm in moving:
            first = self._model.getJointId(self.robot.arms[arm].joint_names[0])
            swept |= {int(joint) for joint in self._model.subtrees[first]}
        return {
            index for index, each in enumerate(self._geometry.geometryObjects) if int(each.parentJoint) not in swept
        }

    def _hand(self, arm: str) -> set[str]:
        """Links of an arm's hand: what the last joint carries, which may touch what is held."""
        return {_name(self._model, each) for each in _hand_geometries(self._model, self._geometry, self.robot, arm)}


def _name(model: Any, geometry: Any) -> str:
    """A thing's name, or that of the link to which a geometry belongs."""
    if str(geometry.name).startswith("thing:"):
        return str(geometry.name)[len("thing:") :]
    return str(model.frames[geometry.parentFrame].name)


def _hand_geometries(model: Any, geometry: Any, robot: RobotModel, arm: str) -> list[Any]:
    """Geometries carried by the last joint of an arm or by joints behind it."""
    last = model.getJointId(robot.arms[arm].joint_names[-1])
    if robot.arms[arm].mimic:
        last = model.frames[model.getFrameId(robot.arms[arm].tool_frame)].parentJoint
    behind = {int(joint) for joint in model.subtrees[last]}
    return [each for each in geometry.geometryObjects if int(each.parentJoint) in behind]


def _robot_geometry(robot: RobotModel) -> tuple[Any, list[tuple[int, int]]]:
    """A copy of a robot's convex geometry that can be added to, and the pairs that may not touch."""
    # All that it depends on: two files may describe one URDF differently, and a URDF may be written anew.
    hands = tuple((arm.joint_names[-1], arm.tool_frame) for arm in robot.arms.values())
    postures = robot.home.tobytes(), tuple(robot.locked.items())
    key = robot.urdf_path, robot.urdf_path.stat().st_mtime, robot.may_touch, robot.joint_names, hands, postures
    if key not in _MADE:
        _MADE[key] = _make_geometry(robot)
    geometry, pairs = _MADE[key]
    return geometry.copy(), pairs


_MADE: dict[Hashable, tuple[Any, list[tuple[int, int]]]] = {}
_TRIED = 60
"""Postures in which pairs are tried; one that touches in nearly all of them is built so."""


def _make_geometry(robot: RobotModel) -> tuple[Any, list[tuple[int, int]]]:
    model = whole_model(robot.urdf_path)
    geometry = pin.buildGeomFromUrdf(model, str(robot.urdf_path), pin.GeometryType.COLLISION)
    for each in geometry.geometryObjects:
        each.geometry = _convex(each.geometry)
        each.meshScale = np.ones(3)
    hands = [{each.name for each in _hand_geometries(model, geometry, robot, arm)} for arm in robot.arms]
    parents = list(model.parents)
    pairs = []
    for first, second in combinations(range(geometry.ngeoms), 2):
        one, other = geometry.geometryObjects[first], geometry.geometryObjects[second]
        a, b = int(one.parentJoint), int(other.parentJoint)
        neighbours = a == b or parents[a] == b or parents[b] == a
        same_hand = any(one.name in hand and other.name in hand for hand in hands)
        if not neighbours and not same_hand:
            pairs.append((first, second))
    return geometry, _apart(robot, model, geometry, pairs)


def _apart(robot: RobotModel, model: Any, geometry: Any, pairs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """The pairs that are apart at home and not always together elsewhere."""
    for first, second in pairs:
        geometry.addCollisionPair(pin.CollisionPair(first, second))
    data, geometry_data = model.createData(), pin.GeometryData(geometry)
    rng = np.random.default_rng(0)  # fixed: which pairs count is a property of the robot
    lower, upper = (np.where(np.isinf(each), np.sign(each) * np.pi, each) for each in (robot.lower, robot.upper))
    touching = np.zeros(len(pairs))
    for number in range(_TRIED + 1):
        q = robot.home if number == 0 else rng.uniform(lower, upper)
        pin.computeCollisions(model, data, geometry, geometry_data, configuration(model, robot.expand(q, {})), False)
        hits = np.array([result.isCollision() for result in geometry_data.collisionResults])
        touching += hits * (_TRIED if number == 0 else 1)
    geometry.removeAllCollisionPairs()
    return [pair for pair, count in zip(pairs, touching, strict=True) if count < 0.95 * _TRIED]


def _convex(geometry: Any) -> Any:
    """A mesh's convex hull, as PyBullet takes it too; primitives as they are."""
    if isinstance(geometry, coal.BVHModelBase):
        geometry.buildConvexHull(True, "Qt")
        return geometry.convex
    return geometry


def _placement(pose: Pose) -> Any:
    return pin.SE3(rotation_matrix(pose.orientation_xyzw), np.array(pose.position))


def _shape(thing: Obstacle) -> Any:
    """The shape of an obstacle for coal."""
    if thing.kind == "box":
        return coal.Box(*thing.size)
    if thing.kind == "sphere":
        return coal.Sphere(*thing.size)
    if thing.kind == "cylinder":
        return coal.Cylinder(*thing.size)
    points = coal.StdVec_Vec3s()
    assert thing.corners is not None  # checked by Obstacle
    for corner in thing.corners:
        points.append(np.array(corner))
    return coal.Convex.convexHull(points, False, "")
