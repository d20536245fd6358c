"""The servo of a whole robot: all arms and the base, never beyond a limit, never into anything.

A step has four parts. Each arm's wish becomes joint velocities that slow down early for what lies ahead, so that
straight lines stay straight (`ArmServo`). Together with the base's they are brought to what distances allow, by the
nearest motion that approaches nothing too fast (`SpeedLimiter`, `ServoGuard`). Speeds change within acceleration and
jerk limits (`ServoBrakes`). And the step is taken only if braking from where it leads ends before every limit and every
thing; else what is concerned brakes now.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from robots import RobotModel
from robots.kinematics import rotation_matrix
from robots.near_kernel import BoolArray, IntArray
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose

from .arm_servo import ArmIntent, ArmServo
from .base_servo import rolled
from .drive_command import ArmWish, DriveCommand
from .errors import ServoError
from .finger_servo import FingerServo
from .servo_brakes import ServoBrakes, State
from .servo_camera import body_axes, camera_axes_in_base
from .servo_guard import ServoGuard
from .servo_input import why_to_stop
from .servo_notes import ServoNotes
from .servo_outcome import outcome
from .servo_reason import DriveReason
from .servo_result import RobotServoResult, ServoView
from .speed_limiter import SpeedLimiter, note_pair

_NOTHING: Mapping[str, Sequence[Obstacle]] = {}
_SAME: FloatArray = np.eye(3)


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
        self._limiter = SpeedLimiter(robot, self._brakes, self._arms)
        self._slices = {name: robot.slice_of(name) for name in robot.arms}
        self._n, self._d = len(robot.joint_names), len(self._brakes.names)
        self._camera = camera_axes_in_base(robot)
        self._state: State | None = None
        self._rolling = (0.0, 0.0)
        base = robot.pose_base_in_world
        self._turned = base, rotation_matrix(base.orientation_xyzw)
        self._fingers = FingerServo(robot)
        self._guard = ServoGuard(robot, obstacles, held)
        self._warm_up()

    def reset(self, base_twist: tuple[float, float] = (0.0, 0.0)) -> None:
        """Forget what was commanded: the next step starts from measured speeds and openings.

        Args:
            base_twist: Speed [m/s] and turning speed [rad/s] with which a base on wheels rolls now.
        """
        self._state = None
        self._rolling = base_twist
        self._fingers.reset()
        for arm in self._arms.values():
            arm.rest()

    @property
    def at_rest(self) -> bool:
        """Whether nothing moves or is about to."""
        return self._state is None or self._brakes.is_rest(self._state)

    def watch(self, obstacles: Sequence[Obstacle], held: Mapping[str, Sequence[Obstacle]] = _NOTHING) -> None:
        """Tell what is around and what is held now; cheap while only places change."""
        if not self._guard.watch(obstacles, held):
            self._guard = self._guard.rebuilt(obstacles, held)

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
        if base is not self._turned[0]:
            self._turned = base, rotation_matrix(base.orientation_xyzw)
        turn = self._turned[1]
        if self._state is None:
            self._state = self._brakes.first([*view.dq.tolist(), *self._rolling[: self._d - self._n]])
        stop, why = why_to_stop(command, self.robot)
        heard = command if stop is DriveReason.NONE else DriveCommand()
        self._guard.look(q, self._fingers.measured(view.openings), base)
        cramped = self._fingers.tell(heard, view.openings, self._guard)
        intents = self._intents(heard, q, turn, view, dt)
        notes = ServoNotes(intents)
        for name, each in intents.items():
            notes.note(name, each.reason, each.detail)
        for name, text in cramped.items():
            notes.note(name, DriveReason.COLLISION, text, always=True)
        wanted, base_asked = self._wanted(intents, command, stop)
        target = self._limiter.limited(wanted, intents, q, self._guard, notes) if wanted.any() else wanted
        velocity = self._advance(target, stop is DriveReason.NONE, q, base, dt, notes)
        for name, arm in self._arms.items():
            speeds = velocity[self._slices[name]]
            arm.proceed(speeds, dt)
            if stop is not DriveReason.NONE or name in notes.slid:
                arm.follow(intents[name].jacobian, speeds)
        return outcome(self.robot, (stop, why), base_asked, intents, velocity, turn, notes, dict(self._fingers.told))

    def _warm_up(self) -> None:
        """Take a step that nobody sees: what is compiled or made when it is first used would delay the first ones."""
        going = DriveCommand({name: ArmWish((0.01,) * 6) for name in self._arms})
        self.step(going, ServoView(self.robot.home, np.zeros(self._n)), 1e-3)
        self.reset()

    def _checked(self, view: ServoView, dt: float) -> FloatArray:
        if view.q.shape != (self._n,) or not ServoBrakes.finite(view.q.tolist()):
            raise ServoError(f"q must be {self._n} finite values for {self.robot.name}, got {view.q!r}")
        if self._state is None and (view.dq.shape != (self._n,) or not ServoBrakes.finite(view.dq.tolist())):
            raise ServoError(f"dq must be {self._n} finite values for {self.robot.name}, got {view.dq!r}")
        if not 0.0 < dt < 1.0:
            raise ServoError(f"dt is {dt}, allowed above 0 up to 1 s")
        return view.q

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
                axes = _SAME
            elif wish.frame == "camera":
                seen = view.camera_xyzw if command.camera_xyzw is None else np.array(command.camera_xyzw)
                axes = self._camera if seen is None else turn.T @ body_axes(seen)
            intents[name] = arm.intend(wish, command.speed_ratio, q[self._slices[name]], axes, dt)
        return intents

    def _wanted(
        self, intents: Mapping[str, ArmIntent], command: DriveCommand, stop: DriveReason
    ) -> tuple[FloatArray, FloatArray]:
        """Speeds that are wanted, (d,), and what was asked of the base, (2,)."""
        wanted, base = np.zeros(self._d), np.zeros(2)
        if stop is not DriveReason.NONE:
            return wanted, base
        for name, intent in intents.items():
            wanted[self._slices[name]] = intent.velocity
        base = command.speed_ratio * np.array(command.base)
        if self._d > self._n:
            wanted[self._n :] = base
        return wanted, base

    def _advance(
        self,
        target: FloatArray,
        together: bool,
        q: FloatArray,
        base: Pose,
        dt: float,
        notes: ServoNotes,
    ) -> FloatArray:
        """Take the step towards the target speeds from which braking is safe, or brake. Returns the speeds (d,)."""
        assert self._state is not None
        goal = target.tolist()
        state = self._within_positions(goal, together, q, dt, notes)
        bad = self._offending(state, q, base, dt)
        if len(bad):
            # Only what moves the pairs that came too near brakes; where that is not enough, everything does.
            moved = self._guard.moved_by(bad)
            for name, where in self._limiter.groups.items():
                if moved[where].any():
                    moved[where] = True
                    if any(goal[where]):
                        note_pair(notes, self._guard, name, int(bad[0]))
            brakes = self._brakes.after(self._state, [0.0] * self._d, dt)
            if moved.all():
                state = brakes
            else:
                state = _mixed(moved, brakes, state)
                # Of what brakes, and of what goes on, all is known: but not of the two together.
                if len(self._offending(state, q, base, dt, moved)):
                    state = brakes
        self._state = state
        return np.array(state[0])

    def _within_positions(
        self, goal: list[float], together: bool, q: FloatArray, dt: float, notes: ServoNotes
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
                notes.note(name, DriveReason.POSITION_LIMIT, self._brakes.names[i], slides=True)

    def _offending(
        self, state: State, q: FloatArray, base: Pose, dt: float, between: BoolArray | None = None
    ) -> IntArray:
        """Pairs that keep a state from being taken; only those between some speeds (d,) and the others if given."""
        way = self._brakes.way(state, dt)
        if way is None:
            return np.zeros(0, dtype=np.int64)
        bases = [base] * len(way)
        if self._d > self._n and way[:, self._n :].any():
            bases = rolled(base, way[:, self._n :])
        return self._guard.offending(way, bases, between)


def _mixed(which: BoolArray, one: State, other: State) -> State:
    """One state for some speeds (d,), and another for the rest."""
    some = which.tolist()
    speeds, rates = (
        tuple(a if first else b for first, a, b in zip(some, *both, strict=True))
        for both in zip(one, other, strict=True)
    )
    return speeds, rates
