"""Distances for control loops: of all pairs that may not touch, each worked out only when it could matter.

Between two postures no distance changes by more than the levers of the joints allow. A pair whose distance was worked
out once is therefore known to be at least so far away for a while, and most of thousands of pairs are never looked at
again. What is said is exact or a lower bound, never a guess.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from .collision import CollisionModel
from .kinematics import rotation_matrix
from .model import RobotModel
from .obstacle import Obstacle
from .pose import FloatArray, Pose

IntArray = NDArray[np.int64]


class NearPairs:
    """The pairs of a collision model, and how far the robot's joints move the two of each towards each other.

    Attributes:
        robot: The robot.
        names: The two names of each pair, k of them.
        levers: Bound of the relative motion of each pair for each unit of motion, (k, nv + 2) [m/rad or m/m]: of
            Pinocchio's joints, then of the base's shift and turn.
        matrix: How driven joints move Pinocchio's, (nv, n).
        contacts: Pairs that handling things brings together: a finger or what is held, and a thing, (k,).
        whole_reach: How far each geometry's farthest point may be from the base's origin [m].
    """

    def __init__(self, collision: CollisionModel) -> None:
        """Take the pairs of a model, whose geometry must not be changed afterwards but through `place`."""
        self.robot = collision.robot
        self._model, self._geometry = collision._model, collision._geometry
        self._around, self._things = list(collision._around), list(collision.obstacles)
        self._carried = collision._carried
        self._in_hand = {
            index: thing
            for arm, indices in self._carried.items()
            for index, thing in zip(indices, collision.held[arm], strict=True)
        }
        self._in_world = [_placement(each.pose_obstacle_in_world) for each in self._things]
        pairs = [(int(each.first), int(each.second)) for each in self._geometry.collisionPairs]
        self._first = np.array([pair[0] for pair in pairs], dtype=np.int64)
        self._second = np.array([pair[1] for pair in pairs], dtype=np.int64)
        self.names = [(collision._names[a], collision._names[b]) for a, b in pairs]
        self._homed: Pose | None = None
        self._neutral = pin.neutral(self._model)
        self._plain = self._model.nq == self._model.nv
        self._offsets: tuple[tuple[float, ...], FloatArray] | None = None
        self.matrix = self._matrix()
        self._moved_by, reaches, self.whole_reach = _levers(self._model, self._geometry)
        around = np.zeros(self._geometry.ngeoms, dtype=bool)
        around[self._around] = True
        one, other = self._moved_by[self._first], self._moved_by[self._second]
        alone = one != other  # a joint that carries both does not move one against the other
        levers = np.where(alone & one, reaches[self._first], 0.0) + np.where(alone & other, reaches[self._second], 0.0)
        self._apart = around[self._second].astype(float) - around[self._first].astype(float)
        turning = np.abs(self._apart) * np.where(
            self._apart > 0, self.whole_reach[self._first], self.whole_reach[self._second]
        )
        self.levers: FloatArray = np.ascontiguousarray(np.column_stack((levers, np.abs(self._apart), turning)))
        thing = around.copy()
        thing[list(self._in_hand)] = True
        touching = _fingers(self._model, self._geometry, self.robot)
        touching[list(self._in_hand)] = True
        first, second = self._first, self._second
        self.contacts = (touching[first] & thing[second]) | (touching[second] & thing[first])
        self._sign = other.astype(float) - one.astype(float)

    def place(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]]) -> FloatArray:
        """Put the same obstacles and held things elsewhere; their number, order and shapes stay.

        Returns:
            By how much each pair's distance may have shrunk, (k,) [m].
        """
        shift = np.zeros(self._geometry.ngeoms)
        for number, each in enumerate(obstacles):
            if each.pose_obstacle_in_world is not self._things[number].pose_obstacle_in_world:
                shift[self._around[number]] = self._shift(self._around[number], self._things[number], each)
                self._in_world[number] = _placement(each.pose_obstacle_in_world)
                self._things[number] = each
                self._homed = None
        for arm, things in held.items():
            for index, each in zip(self._carried[arm], things, strict=True):
                shift[index] = self._shift(index, self._in_hand[index], each)
                self._in_hand[index] = each
                geometry = self._geometry.geometryObjects[index]
                frame = self._model.frames[geometry.parentFrame]
                geometry.placement = frame.placement * _placement(each.pose_obstacle_in_world)
        return np.asarray(shift[self._first] + shift[self._second])

    def home(self, base: Pose) -> None:
        """Place the obstacles for a base that stands at a pose: tracks at that pose are then quick."""
        if self._homed is None or not _same(self._homed, base):
            to_base = _placement(base).inverse()
            for index, in_world in zip(self._around, self._in_world, strict=True):
                self._geometry.geometryObjects[index].placement = to_base * in_world
            self._homed = base

    def _shift(self, index: int, before: Obstacle, after: Obstacle) -> float:
        """How far a thing's farthest point may have moved [m]."""
        one, other = before.pose_obstacle_in_world, after.pose_obstacle_in_world
        shape = self._geometry.geometryObjects[index].geometry
        reach = float(np.linalg.norm(shape.aabb_center)) + float(shape.aabb_radius)
        return float(np.linalg.norm(one.position - other.position)) + reach * _angle(one, other)

    def track(self) -> "PairTrack":
        """Follow a posture of its own."""
        return PairTrack(self)

    def positions(self, q: FloatArray, openings: Mapping[str, float]) -> FloatArray:
        """Positions (nv,) of all of Pinocchio's joints for driven ones (n,) and gaps of the fingers [m]."""
        key = tuple(openings.get(arm, np.inf) for arm in self.robot.arms)
        if self._offsets is None or self._offsets[0] != key:
            # At home, since what mimics others is held to its own limits, which zero may be beyond.
            home = self.robot.home
            self._offsets = key, self._vector(self.robot.expand(home, openings)) - self.matrix @ home
        return np.asarray(self.matrix @ q + self._offsets[1])

    def _vector(self, joints: Mapping[str, float]) -> FloatArray:
        vector = np.zeros(self._model.nv)
        for name, value in joints.items():
            vector[self._row(name)] = value
        return vector

    def _matrix(self) -> FloatArray:
        """How driven joints move all, (nv, n)."""
        matrix = np.zeros((self._model.nv, len(self.robot.joint_names)))
        for arm in self.robot.arms.values():
            start = self.robot.slice_of(arm.name).start
            for column, name in enumerate(arm.joint_names, start):
                matrix[self._row(name), column] = 1.0
            for each in arm.mimic:
                matrix[self._row(each.joint), start + arm.joint_names.index(each.source)] = each.ratio
        return matrix

    def _row(self, joint: str) -> int:
        return int(self._model.joints[self._model.getJointId(joint)].idx_v)


class PairTrack:
    """Distances along the way of one posture.

    Attributes:
        bounds: What each pair's distance is at least, (k,) [m]; exact where `exact`.
        exact: Which are worked out at this very posture, (k,).
    """

    def __init__(self, pairs: NearPairs) -> None:
        """Start with nothing known."""
        self._pairs = pairs
        self._data = pairs._model.createData()
        self._geometry_data = pin.GeometryData(pairs._geometry)
        self._results = self._geometry_data.distanceResults
        self.bounds: FloatArray = np.full(len(pairs.names), -np.inf)
        self.exact = np.zeros(len(pairs.names), dtype=bool)
        self._at: FloatArray | None = None
        self._base: Pose | None = None
        self._placed = False

    def shrink(self, by: FloatArray) -> None:
        """Things were placed elsewhere: distances may have shrunk by as much as `NearPairs.place` says, (k,) [m]."""
        self.bounds -= by
        self.exact &= by == 0.0
        self._placed = False

    def move(self, positions: FloatArray, base: Pose) -> None:
        """Go to a posture, (nv,) as `NearPairs.positions` gives it, with the base at a pose in the world."""
        if self._at is None or self._base is None:
            shift = turn = 0.0
            travel = np.zeros(len(positions))
        else:
            travel = np.abs(positions - self._at)
            shift = turn = 0.0
            if base is not self._base and not _same(base, self._base):
                shift = float(np.linalg.norm(base.position - self._base.position))
                turn = _angle(base, self._base)
        if travel.any() or shift or turn:
            self.bounds -= self._pairs.levers @ np.concatenate((travel, (shift, turn)))
            self.exact[:] = False
            self._placed = False
        self._at, self._base = positions, base

    def jump(self, positions: FloatArray, base: Pose) -> None:
        """Go to a posture as `move` does, with nothing known there: for looking at a few pairs only."""
        self._at, self._base, self._placed = positions, base, False
        self.bounds[:] = -np.inf
        self.exact[:] = False

    def below(self, thresholds: FloatArray) -> IntArray:
        """Pairs nearer than thresholds (k,) [m]; their distances are exact afterwards."""
        doubtful = np.flatnonzero((self.bounds < thresholds) & ~self.exact)
        if len(doubtful):
            self.refine(doubtful)
        return np.flatnonzero(self.bounds < thresholds)

    def refine(self, which: IntArray) -> FloatArray:
        """Work out distances of pairs [m]."""
        self._place()
        geometry, data, results = self._pairs._geometry, self._geometry_data, self._results
        compute = pin.computeDistance
        found = []
        for index in which.tolist():
            compute(geometry, data, index)
            found.append(results[index].min_distance)
        distances = np.array(found)
        self.bounds[which] = distances
        self.exact[which] = True
        return distances

    def gradients(self, which: IntArray) -> FloatArray:
        """How fast distances grow for each unit of speed, (len(which), n + 2): of driven joints, base's speed and turn.

        The distances must be exact. The two nearest points are taken as fixed to the things that they lie on: of two
        faces that turn against each other, others may come nearer.
        """
        pairs = self._pairs
        self._place()
        count = len(which)
        normals, points = np.empty((count, 3)), np.empty((count, 3))
        for row, index in enumerate(which.tolist()):
            result = self._results[index]
            normals[row], points[row] = result.normal, result.getNearestPoint1()
        jacobian = pin.computeJointJacobians(pairs._model, self._data)
        turning = np.cross(points, normals)
        per_joint = (normals @ jacobian[:3] + turning @ jacobian[3:]) * pairs._sign[which]
        apart = pairs._apart[which]
        base = np.column_stack((-apart * normals[:, 0], -apart * turning[:, 2]))
        return np.concatenate((per_joint @ pairs.matrix, base), axis=1)

    def _place(self) -> None:
        """Put all geometry where it is at this posture."""
        if self._placed:
            return
        pairs = self._pairs
        assert self._at is not None and self._base is not None  # `move` comes first
        q = self._at if pairs._plain else pin.integrate(pairs._model, pairs._neutral, self._at)
        pin.forwardKinematics(pairs._model, self._data, q)
        pin.updateGeometryPlacements(pairs._model, self._data, pairs._geometry, self._geometry_data)
        homed = pairs._homed
        if pairs._around and (homed is None or not (homed is self._base or _same(homed, self._base))):
            to_base = _placement(self._base).inverse()
            placed = self._geometry_data.oMg
            for index, in_world in zip(pairs._around, pairs._in_world, strict=True):
                placed[index] = to_base * in_world
        self._placed = True


def _same(one: Pose, other: Pose) -> bool:
    return bool((one.position == other.position).all() and (one.orientation_xyzw == other.orientation_xyzw).all())


def _angle(one: Pose, other: Pose) -> float:
    """Angle between two orientations [rad], from the chord: exact also for tiny ones."""
    first, second = one.orientation_xyzw, other.orientation_xyzw
    chord = min(float(np.linalg.norm(first - second)), float(np.linalg.norm(first + second)))
    return 4.0 * float(np.arcsin(min(0.5 * chord, 1.0)))


def _placement(pose: Pose) -> Any:
    return pin.SE3(rotation_matrix(pose.orientation_xyzw), np.asarray(pose.position))


def _levers(model: Any, geometry: Any) -> tuple[NDArray[np.bool_], FloatArray, FloatArray]:
    """Which joints move each geometry, how far its farthest point may be from each, and from the base's origin.

    Returns:
        (g, nv), (g, nv) [m/rad, or 1 for sliding joints], (g,) [m].
    """
    moved = np.zeros((geometry.ngeoms, model.nv), dtype=bool)
    reaches = np.zeros((geometry.ngeoms, model.nv))
    whole = np.zeros(geometry.ngeoms)
    for number, each in enumerate(geometry.geometryObjects):
        shape = each.geometry
        shape.computeLocalAABB()
        reach = float(np.linalg.norm(each.placement.act(np.asarray(shape.aabb_center)))) + float(shape.aabb_radius)
        for joint in reversed(list(model.supports[each.parentJoint])[1:]):
            column = int(model.joints[joint].idx_v)
            slides = model.joints[joint].shortname().startswith("JointModelP")
            moved[number, column] = True
            reaches[number, column] = 1.0 if slides else reach
            reach += float(np.linalg.norm(model.jointPlacements[joint].translation))
            if slides:
                low, high = (limit[model.joints[joint].idx_q] for limit in _limits(model))
                reach += max(abs(low), abs(high))
        whole[number] = reach
    return moved, reaches, whole


def _fingers(model: Any, geometry: Any, robot: RobotModel) -> NDArray[np.bool_]:
    """Which geometries fingers carry, (g,)."""
    joints = [name for arm in robot.arms.values() for name in arm.gripper.joints]
    carried = {int(each) for name in joints for each in model.subtrees[model.getJointId(name)]}
    return np.array([int(each.parentJoint) in carried for each in geometry.geometryObjects])


def _limits(model: Any) -> tuple[FloatArray, FloatArray]:
    return model.lowerPositionLimit, model.upperPositionLimit
