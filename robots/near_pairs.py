"""Distances for control loops: of all pairs that may not touch, each worked out only when it could matter.

Between two postures no distance changes by more than the levers of the joints allow. A pair whose distance was worked
out once is therefore known to be at least so far away for a while. After that a plane between the two, found or carried
along, says it again (`near_kernel`). Distances are worked out only of pairs that are as near as matters. What is said
is exact or a lower bound, never a guess. No bound is higher than what coal would say, so that it makes no difference
which of them happen to be known.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import overload

import numpy as np

from .model import RobotModel
from .near_kernel import BoolArray, IntArray, Scene, packed, unpacked
from .near_shapes import RobotShapes, Shape, pose_row
from .obstacle import FLOOR, Obstacle
from .pair_track import PairTrack, angle_between
from .pose import FloatArray, Pose

KEPT = 16
"""For so many gaps of the fingers what they add is kept."""
_NOTHING: Mapping[str, Sequence[Obstacle]] = {}


class PairNames(Sequence[tuple[str, str]]):
    """The two names of each pair, put together when they are asked for: few of thousands are."""

    def __init__(self, names: Sequence[str], firsts: Sequence[int], seconds: Sequence[int]) -> None:
        """Take the names of all shapes, and the two shapes of each pair."""
        self._names, self._firsts, self._seconds = names, firsts, seconds

    def __len__(self) -> int:
        """How many pairs there are."""
        return len(self._firsts)

    @overload
    def __getitem__(self, index: int) -> tuple[str, str]: ...

    @overload
    def __getitem__(self, index: slice) -> Sequence[tuple[str, str]]: ...

    def __getitem__(self, index: int | slice) -> tuple[str, str] | Sequence[tuple[str, str]]:
        """The names of a pair, or of some."""
        if isinstance(index, slice):
            return PairNames(self._names, self._firsts[index], self._seconds[index])
        return self._names[self._firsts[index]], self._names[self._seconds[index]]


class NearPairs:
    """The pairs that may not touch, and how far the robot's joints move the two of each towards each other.

    Pairs are those of `CollisionModel`, in the same order.

    Attributes:
        robot: The robot.
        names: The two names of each pair, k of them.
        firsts: The first shape of each pair, k of them.
        seconds: The second of each.
        solids: All shapes for coal, g of them: of links, of what is held, of what is around.
        carried: How many of the shapes joints carry; they come first.
        scene: All as arrays: views of `whole` and `numbers`.
        whole: What the compiled loops take; see `near_kernel.packed`.
        numbers: What they take besides.
        version: Counts how often what is around was placed.
        matrix: How driven joints move Pinocchio's, (nv, n).
        moved_by: Which motions of driven joints, and of the base, change distances of each pair, (k, n + 2).
        contacts: Pairs that handling things brings together: a finger or what is held, and a thing, (k,).
    """

    def __init__(
        self,
        robot: RobotModel,
        obstacles: Sequence[Obstacle] = (),
        held: Mapping[str, Sequence[Obstacle]] = _NOTHING,
        own: RobotShapes | None = None,
    ) -> None:
        """Build the geometry.

        Args:
            robot: The robot.
            obstacles: Things around it.
            held: Things in the grippers, by arm; `pose_obstacle_in_world` is then the pose in the tool's frame.
            own: The robot's shapes, to be quick where they were made before.

        Raises:
            RobotError: `held` names an arm that the robot does not have.
        """
        for arm in held:
            robot.slice_of(arm)
        self.robot = robot
        self.own = RobotShapes(robot) if own is None else own
        self._things = list(obstacles)
        shapes, self._held = list(self.own.shapes), {}
        in_hand: list[Obstacle] = []
        for arm, things in held.items():
            self._held[arm] = range(len(shapes), len(shapes) + len(things))
            shapes += [self.own.held(arm, thing) for thing in things]
            in_hand += things
        self._in_hand = dict(enumerate(in_hand, len(self.own.shapes)))
        self.carried = len(shapes)
        shapes += [self.own.around(thing) for thing in obstacles]
        self.solids = [each.solid for each in shapes]
        self._reaches = [float(np.linalg.norm(each.ball[:3])) + float(each.ball[3]) for each in shapes]
        first, second = self._chosen(shapes)
        self.whole, self.numbers = packed(self._made(shapes, first, second))
        self.scene = Scene(*unpacked(self.whole, self.numbers))
        self.version = 0
        self.firsts, self.seconds = first.tolist(), second.tolist()
        self.names = PairNames([each.name for each in shapes], self.firsts, self.seconds)
        thing, touching = np.zeros(len(shapes), dtype=np.bool_), np.zeros(len(shapes), dtype=np.bool_)
        thing[len(self.own.shapes) :] = True
        touching[self.own.fingers] = True
        touching[len(self.own.shapes) : self.carried] = True
        self.contacts: BoolArray = (touching[first] & thing[second]) | (touching[second] & thing[first])
        self._columns = self.own.columns
        self.matrix = self._matrix()
        self.moved_by = self._moving()
        self._still, self._added = self._open(), dict[tuple[float, ...], FloatArray]()
        self._row: tuple[Pose, FloatArray] | None = None
        self._rows: tuple[Pose, FloatArray] | None = None

    def place(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]] = _NOTHING) -> FloatArray:
        """Put the same obstacles and held things elsewhere; their number, order and shapes stay.

        Returns:
            By how much each pair's distance may have shrunk, (k,) [m].
        """
        shift = np.zeros(len(self.solids))
        for number, each in enumerate(obstacles):
            if each.pose_obstacle_in_world is not self._things[number].pose_obstacle_in_world:
                index = self.carried + number
                shift[index] = self._shift(index, self._things[number], each)
                self.scene.frame[index] = pose_row(each.pose_obstacle_in_world)
                self._things[number] = each
                self.version += 1
        for arm, things in held.items():
            for index, each in zip(self._held[arm], things, strict=True):
                if each.pose_obstacle_in_world is not self._in_hand[index].pose_obstacle_in_world:
                    shift[index] = self._shift(index, self._in_hand[index], each)
                    shape = self.own.held(arm, each)
                    self.scene.frame[index] = shape.frame
                    chain = self.own.chain(shape)
                    self.scene.reach[index, : len(chain)] = [reach for _, _, reach in chain]
                    self._in_hand[index] = each
        return np.asarray(shift[self.scene.first] + shift[self.scene.second])

    def track(self) -> PairTrack:
        """Follow a posture of its own."""
        return PairTrack(self)

    def positions(self, q: FloatArray, openings: Mapping[str, float]) -> FloatArray:
        """Positions (nv,) of all of Pinocchio's joints for driven ones (n,) and gaps of the fingers [m]."""
        return np.asarray(self.matrix @ q + self._still + self._fingers(openings))

    def positions_after(self, positions: FloatArray, way: FloatArray) -> FloatArray:
        """Positions (nv,) where driven joints have gone a way (n,), or (n + 2,) with the base's."""
        return np.asarray(positions + self.matrix @ way[: self.matrix.shape[1]])

    def rows_of(self, bases: Sequence[Pose]) -> FloatArray:
        """Poses of the base as `row_of` gives them, (m, 12)."""
        if any(base is not bases[0] for base in bases):
            return np.array([self.row_of(base) for base in bases])
        if self._rows is None or self._rows[0] is not bases[0] or len(self._rows[1]) != len(bases):
            self._rows = bases[0], np.tile(self.row_of(bases[0]), (len(bases), 1))
        return self._rows[1]

    def row_of(self, base: Pose) -> FloatArray:
        """A pose of the base as rotation matrix, row by row, and position, (12,)."""
        if self._row is None or self._row[0] is not base:
            self._row = base, pose_row(base)
        return self._row[1]

    def gone(self, sums: FloatArray, which: IntArray) -> FloatArray:
        """How far the two of each pair go at most, one against the other, by sums of levers, (len(which),) [m]."""
        return np.asarray(sums[self.scene.one[which]] + sums[self.scene.other[which]])

    def _moving(self) -> BoolArray:
        """Which motions of driven joints, and of the base, change distances of each pair, (k, n + 2)."""
        scene = self.scene
        rows, width = scene.reach.shape
        # Of each shape, what joints from the d-th on do, for d from 0 to the last.
        moves = np.zeros((rows, width + 1, len(self.matrix) + 2), dtype=np.bool_)
        for d in reversed(range(width)):
            moves[:, d] = moves[:, d + 1]
            some = np.flatnonzero(scene.reach[:, d] > 0.0)
            moves[some, d, scene.lever[some, d]] = True
        cells = moves.reshape(-1, moves.shape[2])
        driven = (cells[:, :-2].astype(np.float64) @ (self.matrix != 0.0)) > 0.0
        cells = np.concatenate((driven, cells[:, -2:]), axis=1)
        return np.asarray(cells[scene.one] | cells[scene.other])

    def _chosen(self, shapes: Sequence[Shape]) -> tuple[IntArray, IntArray]:
        """Which shapes make the pairs, (k,) each; see `CollisionModel`."""
        own, robot = self.own, self.robot
        pairs = [own.pairs]
        links = np.arange(len(own.shapes))
        for arm, indices in self._held.items():
            outside = links[[i not in own.hands[arm] for i in links.tolist()]]
            pairs += [np.column_stack((outside, np.full(len(outside), index))) for index in indices]
        for left, right in combinations(self._held.values(), 2):
            pairs.append(np.array([(a, b) for a in left for b in right], dtype=np.int64).reshape(-1, 2))
        movers = np.array([*own.movers, *range(len(own.shapes), self.carried)], dtype=np.int64)
        around = np.arange(self.carried, len(shapes))
        pairs.append(np.column_stack((np.tile(movers, len(around)), np.repeat(around, len(movers)))))
        allowed = set(robot.may_touch)
        if robot.drive is not None:
            allowed |= {frozenset((link, FLOOR)) for link in robot.drive.on_floor}
        named: dict[str, list[int]] = {}
        for index, shape in enumerate(shapes):
            named.setdefault(shape.name, []).append(index)
        may = np.zeros((len(shapes), len(shapes)), dtype=np.bool_)
        for pair in allowed:
            one, other = (*pair, *pair)[:2]
            for index in named.get(one, []):
                may[index, named.get(other, [])] = True
        chosen = np.concatenate(pairs)
        chosen = chosen[~(may | may.T)[chosen[:, 0], chosen[:, 1]]]
        return np.ascontiguousarray(chosen[:, 0]), np.ascontiguousarray(chosen[:, 1])

    def _made(self, shapes: Sequence[Shape], first: IntArray, second: IntArray) -> Scene:
        """All as arrays."""
        chains = self.own.chains + [self.own.chain(each) for each in shapes[len(self.own.shapes) : self.carried]]
        size = self.carried + 1, max((len(each) for each in chains), default=0)
        chain, lever, reach = np.zeros(size, dtype=np.int64), np.zeros(size, dtype=np.int64), np.zeros(size)
        moved = np.zeros((self.carried, self.own.model.nv), dtype=np.int64)
        for row, links in enumerate(chains):
            where = row, slice(len(links))
            chain[where], lever[where], reach[where] = zip(*links, strict=True)
            moved[row, lever[row, 2 : len(links)]] = 1
        # The base and joints that carry both are the first ones of both chains; the base moves all but what is around.
        common, both = np.zeros(len(first), dtype=np.int64), np.flatnonzero(second < self.carried)
        common[both] = 2 + (moved @ moved.T)[first[both], second[both]]
        stops, joints = np.cumsum([len(each.points) for each in shapes]).tolist(), self.own.joints
        starts = [0, *stops[:-1]]
        return Scene(
            parent=joints.parent,
            slides=joints.slides,
            motion=joints.motion,
            solid=np.array([(each.kind, each.joint, a, b) for each, a, b in zip(shapes, starts, stops, strict=True)]),
            chain=chain,
            lever=lever,
            first=first,
            second=second,
            one=first * (size[1] + 1) + common,
            other=np.minimum(second, self.carried) * (size[1] + 1) + common,
            joint_frame=joints.frame,
            joint_axis=joints.axis,
            form=np.array([each.form for each in shapes]),
            frame=np.array([each.frame for each in shapes]),
            points=np.concatenate([each.points for each in shapes]),
            reach=reach,
            plane=np.zeros((len(first), 3)),
        )

    def _shift(self, index: int, before: Obstacle, after: Obstacle) -> float:
        """How far a thing's farthest point may have moved [m]."""
        one, other = before.pose_obstacle_in_world, after.pose_obstacle_in_world
        return float(np.linalg.norm(one.position - other.position)) + self._reaches[index] * angle_between(one, other)

    def _fingers(self, openings: Mapping[str, float]) -> FloatArray:
        """What fingers that are not open add to the positions of all joints, (nv,)."""
        key = tuple(openings.get(name, arm.gripper.max_opening) for name, arm in self.robot.arms.items())
        if key not in self._added:
            if len(self._added) > KEPT:
                self._added.clear()
            told: dict[str, float] = {}
            for arm, opening in zip(self.robot.arms.values(), key, strict=True):
                told |= dict(zip(arm.gripper.joints, arm.gripper.joints_at(opening), strict=True))
            told |= {each.joint: each.follow(told[each.source]) for each in self.robot.finger_mimic}
            added = np.zeros(len(self._still))
            for name, value in told.items():
                added[self._columns[name]] = value - self._still[self._columns[name]]
            self._added[key] = added
        return self._added[key]

    def _open(self) -> FloatArray:
        """What is added to the positions of all joints, (nv,), while fingers are open."""
        # At home, since what mimics others is held to its own limits, which zero may be beyond.
        vector = np.zeros(len(self.matrix))
        for name, value in self.robot.expand(self.robot.home, {}).items():
            vector[self._columns[name]] = value
        return vector - self.matrix @ self.robot.home

    def _matrix(self) -> FloatArray:
        """How driven joints move all, (nv, n)."""
        matrix = np.zeros((self.own.model.nv, len(self.robot.joint_names)))
        for arm in self.robot.arms.values():
            start = self.robot.slice_of(arm.name).start
            for column, name in enumerate(arm.joint_names, start):
                matrix[self._columns[name], column] = 1.0
            for each in arm.mimic:
                matrix[self._columns[each.joint], start + arm.joint_names.index(each.source)] = each.ratio
        return matrix
