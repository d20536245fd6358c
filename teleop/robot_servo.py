"""The servo of a whole robot: all arms and the base, never beyond a limit, never into anything.

A step has four parts. Each arm's wish becomes joint velocities (`ArmServo`). Together with the base's they are brought
to what distances and position limits allow, by the nearest motion that approaches nothing too fast (`ServoGuard`,
`project`). Speeds change on the fastest way within acceleration and jerk limits (`ServoBrakes`). And the step is taken
only if braking from where it leads ends before every limit and every thing; else what is concerned brakes now.
"""

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np

from robots import RobotModel
from robots.kinematics import rotation_matrix
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose

from .arm_servo import ArmIntent, ArmServo
from .base_servo import rolled
from .drive_command import ArmWish, DriveCommand
from .errors import ServoError
from .servo_brakes import ServoBrakes, State
from .servo_camera import body_axes, camera_axes_in_base
from .servo_guard import Dampers, IntArray, ServoGuard
from .servo_input import why_to_stop
from .servo_projection import project
from .servo_reason import STOPPING, DriveReason
from .servo_result import ArmResult, RobotServoResult, ServoView

AGREE_WITHIN = 2e-3
"""Asked and executed twists that differ by less are the same [m/s, rad/s]: what holds the tool on its line is less."""
REST = 1e-4
"""Slower than this is standing still [m/s or rad/s]."""
_NOTHING: Mapping[str, Sequence[Obstacle]] = {}


class RobotServo:
    """Turns wishes into joint velocities and a base's speeds.

    `step` depends on its arguments, on what `watch` was told, and on what the last steps did. Arms with fewer than six
    joints follow the linear part of a twist; what they cannot do is named in the result.
    """

    def __init__(
        self,
        robot: RobotModel,
        obstacles: Sequence[Obstacle] = (),
        held: Mapping[str, Sequence[Obstacle]] | None = None,
    ) -> None:
        """Make a servo for a robot among things.

        Args:
            robot: The robot, where it stands.
            obstacles: Things around it, in the world.
            held: Things in the grippers, by arm, their poses in the tool's frame.
        """
        self.robot = robot
        self._brakes = ServoBrakes(robot)
        self._arms = {name: ArmServo(robot, arm) for name, arm in robot.arms.items()}
        self._slices = {name: robot.slice_of(name) for name in robot.arms}
        self._n, self._d = len(robot.joint_names), len(self._brakes.names)
        self._camera = camera_axes_in_base(robot)
        self._state: State | None = None
        self._openings: dict[str, float] = {}
        self._guard = ServoGuard(robot, obstacles, held)

    def reset(self) -> None:
        """Forget what was commanded: the next step starts from measured speeds and openings."""
        self._state = None
        self._openings = {}
        for arm in self._arms.values():
            arm.rest()

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves or is about to."""
        return self._state is None or self._brakes.is_rest(self._state)

    def watch(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]] = _NOTHING) -> None:
        """Tell what is around and what is held now; cheap while only places change."""
        if not self._guard.watch(obstacles, held):
            self._guard = ServoGuard(self.robot, obstacles, held)

    def step(self, command: DriveCommand, view: ServoView, dt: float) -> RobotServoResult:
        """Choose what to execute during the next control period.

        Args:
            command: What is wanted; never raises for what is wrong with it, but brakes and names it.
            view: What is true now.
            dt: Control period [s].

        Raises:
            ServoError: The view is not of this robot or not finite, or `dt` is not a period.
        """
        q = self._checked(view, dt)
        base = view.pose_base_in_world or self.robot.pose_base_in_world
        turn = rotation_matrix(base.orientation_xyzw)
        if self._state is None:
            self._state = self._brakes.first([*view.dq.tolist(), *([0.0] * (self._d - self._n))])
        if not self._openings:
            self._openings = {
                name: view.openings.get(name, arm.gripper.max_opening) for name, arm in self.robot.arms.items()
            }
        stop, why = why_to_stop(command, self.robot)
        widest = self._widest(view)
        self._guard.look(q, widest, base)
        cramped = self._grip(command, view) if stop is DriveReason.NONE else set()
        if (told := self._widest(view)) != widest:
            self._guard.look(q, told, base)
        intents = self._intents(command if stop is DriveReason.NONE else DriveCommand(), q, turn, view, dt)
        wanted = self._wanted(intents, command, stop)
        reasons = {name: (each.reason, each.detail) for name, each in intents.items()} | {
            "base": (DriveReason.NONE, "")
        }
        reasons |= {name: (DriveReason.COLLISION, "no room for the fingers to open") for name in cramped}
        target = self._limited(wanted, intents, q, reasons) if wanted.any() else wanted
        velocity = self._advance(target, stop is DriveReason.NONE, q, base, dt, reasons)
        if stop is DriveReason.NONE:
            for arm in self._arms.values():
                arm.proceed(dt)
        return self._result(command, stop, why, intents, velocity, turn, reasons)

    def _checked(self, view: ServoView, dt: float) -> FloatArray:
        if view.q.shape != (self._n,) or not ServoBrakes.finite(view.q.tolist()):
            raise ServoError(f"q must be {self._n} finite values for {self.robot.name}, got {view.q!r}")
        if self._state is None and (view.dq.shape != (self._n,) or not ServoBrakes.finite(view.dq.tolist())):
            raise ServoError(f"dq must be {self._n} finite values for {self.robot.name}, got {view.dq!r}")
        if not 0.0 < dt < 1.0:
            raise ServoError(f"dt is {dt}, allowed above 0 up to 1 s")
        return view.q

    def _widest(self, view: ServoView) -> dict[str, float]:
        """Gaps to keep distance with [m]: fingers that were told to open will soon be there."""
        return {name: max(view.openings.get(name, told), told) for name, told in self._openings.items()}

    def _grip(self, command: DriveCommand, view: ServoView) -> set[str]:
        """Tell the fingers what to do; returns the arms whose fingers have no room to open."""
        cramped = set()
        for name, wish in command.arms.items():
            widest = self.robot.arms[name].gripper.max_opening
            if wish.gripper == "close":
                self._openings[name] = 0.0
            elif wish.gripper == "open" and self._openings[name] != widest:
                if self._guard.has_room(self._widest(view) | {name: widest}):
                    self._openings[name] = widest
                else:
                    cramped.add(name)
        return cramped

    def _intents(
        self, command: DriveCommand, q: FloatArray, turn: FloatArray, view: ServoView, dt: float
    ) -> dict[str, ArmIntent]:
        """What each arm would do."""
        intents = {}
        for name, arm in self._arms.items():
            wish = command.arms.get(name, ArmWish())
            axes: FloatArray | None = None
            if wish.frame == "world":
                axes = turn.T
            elif wish.frame == "base":
                axes = np.eye(3)
            elif wish.frame == "camera":
                axes = self._camera if view.camera_xyzw is None else turn.T @ body_axes(view.camera_xyzw)
            intents[name] = arm.intend(wish, command.speed_ratio, q[self._slices[name]], axes, dt)
        return intents

    def _wanted(self, intents: Mapping[str, ArmIntent], command: DriveCommand, stop: DriveReason) -> FloatArray:
        """Speeds that are wanted, (d,)."""
        wanted = np.zeros(self._d)
        if stop is not DriveReason.NONE:
            return wanted
        for name, intent in intents.items():
            wanted[self._slices[name]] = intent.velocity
        if self._d > self._n:
            wanted[self._n :] = command.speed_ratio * np.array(command.base)
        return wanted

    def _limited(
        self,
        wanted: FloatArray,
        intents: Mapping[str, ArmIntent],
        q: FloatArray,
        reasons: dict[str, tuple[DriveReason, str]],
    ) -> FloatArray:
        """The nearest speeds to the wanted ones within velocity limits, distances and room to the position limits."""
        target = self._scaled(wanted.copy(), reasons)
        free = target != 0.0
        inverse_weight = np.eye(self._d)
        for name, intent in intents.items():
            where = self._slices[name]
            free[where] &= intent.free
            if free[where].any():
                free[where] = intent.free
                inverse_weight[where, where] = intent.inverse_weight
        columns = np.flatnonzero(free)
        dampers = self._guard.dampers(target, self._brakes.half_times(target))
        down, up = self._brakes.room(q)
        ends = [(i, sign) for i in columns.tolist() for sign, room in ((-1.0, up[i]), (1.0, down[i]))
                if room < self._brakes.velocity[i]]  # fmt: skip
        limits = np.zeros((len(ends), self._d))
        least = np.zeros(len(ends))
        for row, (i, sign) in enumerate(ends):
            limits[row, i] = sign
            least[row] = -(up[i] if sign < 0.0 else down[i])
        base = self._base_rows(target)
        rows = np.concatenate((dampers.rows, limits, base[0]))
        # Where columns are left out, what they do is nothing: their target is rest.
        found, held = project(
            target[columns],
            inverse_weight[np.ix_(columns, columns)],
            rows[:, columns],
            np.concatenate((dampers.least, least, base[1])),
        )
        target[columns] = found
        self._explain(held, dampers, ends, rows, reasons)
        return self._scaled(target, reasons)

    def _base_rows(self, target: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Rows that keep the base from doing more than asked, or the opposite, to make way for something."""
        rows, least = [], []
        for i in range(self._n, self._d):
            if target[i]:
                row = np.zeros(self._d)
                row[i] = -np.sign(target[i])
                rows += [row, -row]
                least += [-abs(target[i]), 0.0]
        return np.array(rows).reshape(-1, self._d), np.array(least)

    def _scaled(self, speeds: FloatArray, reasons: dict[str, tuple[DriveReason, str]]) -> FloatArray:
        """Speeds of each arm, and of the base, brought into their limits along their direction."""
        over = np.abs(speeds) / self._brakes.velocity
        if over.max() > 1.0:
            for name, where in (*self._slices.items(), ("base", slice(self._n, self._d))):
                if where.start < where.stop and (ratio := float(over[where].max())) > 1.0:
                    speeds[where] /= ratio
                    worst = where.start + int(np.argmax(over[where]))
                    _note(reasons, name, DriveReason.VELOCITY_LIMIT, self._brakes.names[worst])
        return speeds

    def _explain(
        self,
        held: FloatArray,
        dampers: Dampers,
        ends: Sequence[tuple[int, float]],
        rows: FloatArray,
        reasons: dict[str, tuple[DriveReason, str]],
    ) -> None:
        """Name what holds each arm back."""
        if not held.any():
            return
        count = len(dampers.pairs)
        for name, where in (*self._slices.items(), ("base", slice(self._n, self._d))):
            concerned = held[:count] * np.abs(rows[:count, where]).sum(axis=1)
            if concerned.any():
                self._note_pair(reasons, name, int(dampers.pairs[int(np.argmax(concerned))]))
            for row, (i, _) in enumerate(ends):
                if held[count + row] > 0.0 and where.start <= i < where.stop:
                    _note(reasons, name, DriveReason.POSITION_LIMIT, self._brakes.names[i])

    def _note_pair(self, reasons: dict[str, tuple[DriveReason, str]], name: str, pair: int) -> None:
        reason = DriveReason.CONTACT if self._guard.contacts[pair] else DriveReason.COLLISION
        _note(reasons, name, reason, "{} and {}".format(*self._guard.names[pair]))

    def _advance(
        self,
        target: FloatArray,
        together: bool,
        q: FloatArray,
        base: Pose,
        dt: float,
        reasons: dict[str, tuple[DriveReason, str]],
    ) -> FloatArray:
        """Take the step towards the target speeds from which braking is safe, or brake. Returns the speeds (d,)."""
        assert self._state is not None
        goal = target.tolist()
        state = self._within_positions(goal, together, q, dt, reasons)
        bad = self._offending(state, q, base, dt)
        if len(bad):
            # Only what moves the pairs that came too near brakes; where that is not enough, everything does.
            moved = self._guard.moved_by(bad)
            for name, where in (*self._slices.items(), ("base", slice(self._n, self._d))):
                if moved[where].any():
                    moved[where] = True
                    if any(goal[where]):
                        self._note_pair(reasons, name, int(bad[0]))
            goal = np.where(moved, 0.0, target).tolist()
            state = self._within_positions(goal, False, q, dt, reasons)
            if any(goal) and len(self._offending(state, q, base, dt)):
                state = self._brakes.after(self._state, [0.0] * self._d, dt)
        self._state = state
        return np.array(state[0])

    def _within_positions(
        self, goal: list[float], together: bool, q: FloatArray, dt: float, reasons: dict[str, tuple[DriveReason, str]]
    ) -> State:
        """The state after the period, joints that would overrun their position limits braking."""
        assert self._state is not None
        here = q.tolist()
        if together:
            state = self._brakes.together(self._state, goal, dt)
            if not self._brakes.overrun(state, None, here, dt):
                return state
        # Each on its own from here: a joint that waits for the others brakes too late.
        while True:
            state = self._brakes.after(self._state, goal, dt)
            over = [i for i in self._brakes.overrun(state, goal, here, dt) if goal[i]]
            if not over:
                return state
            for i in over:
                goal[i] = 0.0
                name = next(name for name, where in self._slices.items() if where.start <= i < where.stop)
                _note(reasons, name, DriveReason.POSITION_LIMIT, self._brakes.names[i])

    def _offending(self, state: State, q: FloatArray, base: Pose, dt: float) -> IntArray:
        """Pairs that keep a state from being taken."""
        way = self._brakes.way(state, dt)
        if way is None:
            return np.zeros(0, dtype=np.int64)
        bases = [base] * len(way)
        if self._d > self._n and way[:, self._n :].any():
            bases = rolled(base, way[:, self._n :])
        return self._guard.offending(way, bases)

    def _result(
        self,
        command: DriveCommand,
        stop: DriveReason,
        why: str,
        intents: Mapping[str, ArmIntent],
        velocity: FloatArray,
        turn: FloatArray,
        reasons: dict[str, tuple[DriveReason, str]],
    ) -> RobotServoResult:
        """Compare what is done with what was asked."""
        arms = {}
        lines: list[str] = []
        moves = asks = False
        for name, intent in intents.items():
            where = self._slices[name]
            executed = intent.jacobian @ velocity[where]
            reason, detail = reasons[name]
            if stop is not DriveReason.NONE:
                reason, detail = stop, why
                self._arms[name].follow(intent.jacobian, velocity[where])
            else:
                differs = bool(np.abs(executed - intent.asked).max() > AGREE_WITHIN)
                if reason in _HOLDING:
                    self._arms[name].follow(intent.jacobian, velocity[where])
                if not differs:
                    reason, detail = DriveReason.NONE, ""
                elif reason is DriveReason.NONE:
                    reason = DriveReason.ACCELERATION_LIMIT
            asks |= bool(intent.asked.any())
            moves |= bool(np.abs(executed).max() > REST)
            if reason is not DriveReason.NONE:
                lines.append(f"{name}: {reason}" + (f" ({detail})" if detail else ""))
            arms[name] = ArmResult(_turned(turn, intent.asked), _turned(turn, executed), reason, detail)
        base_asked, base_twist = np.zeros(2), np.zeros(2)
        base_reason, base_detail = DriveReason.NONE, ""
        if stop is DriveReason.NONE:
            base_asked = command.speed_ratio * np.array(command.base)
        if self._d > self._n:
            base_twist = velocity[self._n :]
        if np.abs(base_twist - base_asked).max() > AGREE_WITHIN:
            base_reason, base_detail = reasons["base"]
            if self._d == self._n:
                base_reason, base_detail = DriveReason.UNREACHABLE, f"{self.robot.name} has no wheels"
            elif base_reason is DriveReason.NONE:
                base_reason = DriveReason.ACCELERATION_LIMIT
            if stop is DriveReason.NONE:
                lines.append(f"base: {base_reason}" + (f" ({base_detail})" if base_detail else ""))
        if stop is not DriveReason.NONE:
            base_reason, base_detail = stop, why
            lines = [f"{stop} ({why})"]
        asks |= bool(base_asked.any())
        moves |= bool(np.abs(base_twist).max() > REST)
        state: Literal["ok", "slowed", "stopped"] = "ok"
        if lines:
            state = "stopped" if stop in STOPPING or (asks and not moves) else "slowed"
        return RobotServoResult(
            velocity[: self._n],
            base_twist,
            base_asked,
            self._openings,
            arms,
            base_reason,
            base_detail,
            state,
            lines[0] if lines else "",
        )


_HOLDING = frozenset(
    (DriveReason.COLLISION, DriveReason.CONTACT, DriveReason.POSITION_LIMIT, DriveReason.VELOCITY_LIMIT)
)
"""Reasons for which an arm goes on from what it does, not from what it was asked."""
_ORDER = list(DriveReason)


def _note(reasons: dict[str, tuple[DriveReason, str]], name: str, reason: DriveReason, detail: str) -> None:
    """Keep the reason that comes first in `DriveReason`."""
    before = reasons[name][0]
    if before is DriveReason.NONE or _ORDER.index(reason) < _ORDER.index(before):
        reasons[name] = reason, detail


def _turned(rotation: FloatArray, twist: FloatArray) -> FloatArray:
    return np.concatenate((rotation @ twist[:3], rotation @ twist[3:]))
