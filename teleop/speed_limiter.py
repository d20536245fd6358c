"""Wanted speeds brought to what limits, distances and the room to position limits allow, by the nearest motion."""

from collections.abc import Mapping, Sequence

import numpy as np

from robots import RobotModel
from robots.ik_kernel import compiled
from robots.near_kernel import BoolArray, IntArray
from robots.pose import FloatArray

from .arm_servo import ArmIntent, ArmServo
from .servo_brakes import ServoBrakes
from .servo_guard import Dampers, ServoGuard
from .servo_notes import BASE, ServoNotes
from .servo_projection import project
from .servo_reason import DriveReason


class SpeedLimiter:
    """For a robot with n joints and d speeds in all: those of a driven base come last.

    Attributes:
        groups: Speeds of each arm and of the base.
    """

    def __init__(self, robot: RobotModel, brakes: ServoBrakes, arms: Mapping[str, ArmServo]) -> None:
        """Take a robot, its limits and its arms."""
        self._brakes, self._arms = brakes, arms
        self._n, self._d = len(robot.joint_names), len(brakes.names)
        self.groups = {name: robot.slice_of(name) for name in robot.arms}
        if self._d > self._n:
            self.groups[BASE] = slice(self._n, self._d)
        self._bounds = np.array([[where.start, where.stop] for where in self.groups.values()], dtype=np.int64)

    def limited(
        self,
        wanted: FloatArray,
        intents: Mapping[str, ArmIntent],
        q: FloatArray,
        guard: ServoGuard,
        notes: ServoNotes,
    ) -> FloatArray:
        """The nearest speeds (d,) to wanted ones (d,) at q (n,) [rad]; what holds them back is noted."""
        target = self._scaled(wanted.copy(), notes)
        free = target != 0.0
        for name, intent in intents.items():
            free[self.groups[name]] = intent.free
        columns = _may_move(free, target, self._bounds)
        dampers = guard.dampers(target, self._brakes.half_times(target))
        ends, limits, room = self._ends(columns, q)
        base, most = self._base_rows(target)
        rows = np.concatenate((dampers.rows, limits, base))
        least = np.concatenate((dampers.least, room, most))
        # Where columns are left out, what they do is nothing: their target is rest.
        if not len(rows) or min((rows @ target - least).tolist()) >= 0.0:
            return target
        kept = rows[:, columns]
        inverse_weight = np.eye(self._d)
        for name, intent in intents.items():
            where = self.groups[name]
            if any(free[where].tolist()):
                inverse_weight[where, where] = self._arms[name].inverse_weight(intent.jacobian)
        found, held = project(target[columns], inverse_weight[np.ix_(columns, columns)], kept, least)
        target[columns] = found
        self._explain(held, dampers, ends, rows, guard, notes)
        return self._scaled(target, notes)

    def _ends(self, columns: IntArray, q: FloatArray) -> tuple[list[int], FloatArray, FloatArray]:
        """Joints near their position limits, rows (k, d) of what they may not do, and how far they may (k,)."""
        down, up = self._brakes.room(q)
        joints, rows, least = _near_ends(columns, down, up, self._brakes.velocity, self._d)
        return joints.tolist(), rows, least

    def _base_rows(self, target: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rows that keep the base from doing more than asked, or the opposite, to make way for something."""
        if self._n == self._d:
            return np.zeros((0, self._d)), np.zeros(0)
        rows, least = [], []
        for i in range(self._n, self._d):
            if target[i]:
                row = np.zeros(self._d)
                row[i] = -np.sign(target[i])
                rows += [row, -row]
                least += [-abs(target[i]), 0.0]
        return np.array(rows).reshape(-1, self._d), np.array(least)

    def _scaled(self, speeds: FloatArray, notes: ServoNotes) -> FloatArray:
        """Speeds of each arm, and of the base, brought into their limits along their direction."""
        over = np.abs(speeds) / self._brakes.velocity
        if max(over.tolist()) > 1.0:
            for name, where in self.groups.items():
                if (ratio := float(over[where].max())) > 1.0:
                    speeds[where] /= ratio
                    worst = where.start + int(np.argmax(over[where]))
                    notes.note(name, DriveReason.VELOCITY_LIMIT, self._brakes.names[worst])
        return speeds

    def _explain(
        self,
        held: FloatArray,
        dampers: Dampers,
        ends: Sequence[int],
        rows: FloatArray,
        guard: ServoGuard,
        notes: ServoNotes,
    ) -> None:
        """Name what holds each arm back."""
        count = len(dampers.pairs)
        for name, where in self.groups.items():
            concerned = held[:count] * np.abs(rows[:count, where]).sum(axis=1)
            if concerned.any():
                note_pair(notes, guard, name, int(dampers.pairs[int(np.argmax(concerned))]))
            for row, i in enumerate(ends):
                if held[count + row] > 0.0 and where.start <= i < where.stop:
                    notes.note(name, DriveReason.POSITION_LIMIT, self._brakes.names[i], slides=True)


def note_pair(notes: ServoNotes, guard: ServoGuard, name: str, pair: int) -> None:
    """Note a pair that holds an arm, or the base, back or turns it off its way."""
    reason = DriveReason.CONTACT if guard.contacts[pair] else DriveReason.COLLISION
    notes.note(name, reason, "{} and {}".format(*guard.names[pair]), slides=True)


@compiled
def _may_move(free: BoolArray, target: FloatArray, bounds: IntArray) -> IntArray:
    """Speeds that avoiding things may change: those that may move (d,), of arms some of whose joints are to move."""
    for group in range(bounds.shape[0]):
        moves = False
        for i in range(bounds[group, 0], bounds[group, 1]):
            moves = moves or (free[i] and target[i] != 0.0)
        if not moves:
            free[bounds[group, 0] : bounds[group, 1]] = False
    return np.flatnonzero(free)


@compiled
def _near_ends(
    columns: IntArray, down: FloatArray, up: FloatArray, velocity: FloatArray, d: int
) -> tuple[IntArray, FloatArray, FloatArray]:
    """See `SpeedLimiter._ends`: for what may move (k,) the room to both sides beside its speed limit, (d,) each."""
    joints, rows, least = np.empty(2 * columns.size, dtype=np.int64), np.zeros((2 * columns.size, d)), np.empty(2 * d)
    count = 0
    for i in columns:
        for sign, room in ((-1.0, up[i]), (1.0, down[i])):
            if room < velocity[i]:
                joints[count], rows[count, i], least[count] = i, sign, -room
                count += 1
    return joints[:count], rows[:count], least[:count]
