"""Random, adversarial and human-like input to the servo of each robot in its scene: limits, distances, ways out."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from executor.bench.pool import spread
from executor.bench.report import BenchReport
from executor.bench.servo_input import InputMaker
from executor.bench.servo_lines import LONG, SPEEDS, STARTS, line_figures, straight_lines, tasks
from executor.bench.servo_way_out import WayOut, halted
from robots import CollisionModel, RobotModel
from robots.kinematics import whole_model
from robots.obstacle import Obstacle
from robots.pose import FloatArray, Pose
from teleop.base_servo import rolled
from teleop.robot_servo import RobotServo
from teleop.servo_result import RobotServoResult, ServoView
from twin import SceneSpec, World
from twin.ordering_scene import random_ordering
from twin.tabletop_scene import random_tabletop

DT = 1.0 / 240.0
CHUNK = 4800
"""Steps done by one task, in one scene."""
EPISODE = 1200
"""Steps from one start, which is random, of one kind of input."""
LEAST = 0.005
"""Nothing may be nearer outside allowed contact [m]."""
START = 0.008
"""Distance that starts keep [m]."""
LOOK_EVERY = 4
"""Steps between two independent looks at all distances."""
GRIP_SPEED = 0.05
"""How fast gaps of fingers follow what is wanted [m/s]."""
KINDS = ("random", "adversarial", "human")


@dataclass(frozen=True, slots=True)
class Chunk:
    """What one task found.

    Attributes:
        robot: The robot.
        steps: Steps done.
        violations: One line for each limit that was not kept.
        stuck: One line for each halted state that no input left.
        halted: Halted states that were looked at.
        seconds: Time of each step on its core [s]; what other processes take from it does not count.
        distance: Least distance outside allowed contact [m].
        overlap: Deepest allowed contact [m]; below 0 where things overlap.
    """

    robot: str
    steps: int
    violations: tuple[str, ...]
    stuck: tuple[str, ...]
    halted: int
    seconds: FloatArray
    distance: float
    overlap: float


def run(
    seed: int,
    steps: int = 1_000_000,
    robots: Sequence[str] = ("three_dof", "baxter", "mico_segway"),
    jobs: int = 0,
    on_done: Callable[[], None] = lambda: None,
) -> BenchReport:
    """Drive every robot.

    Args:
        seed: Decides scenes, starts and input.
        steps: Steps a robot; made up to whole tasks of `CHUNK`.
        robots: Their names.
        jobs: Processes; 0 takes one a core.
        on_done: Called after each task.
    """
    figures: dict[str, float | None] = {}
    notes: list[str] = []
    for robot in robots:
        done = []
        for each in spread(drive, [(robot, seed, number) for number in range(chunks(steps))], jobs):
            done.append(each)
            on_done()
        seconds = np.concatenate([each.seconds for each in done])
        figures[f"{robot}.steps"] = sum(each.steps for each in done)
        figures[f"{robot}.violations"] = sum(len(each.violations) for each in done)
        figures[f"{robot}.stuck"] = sum(len(each.stuck) for each in done)
        figures[f"{robot}.halted"] = sum(each.halted for each in done)
        figures[f"{robot}.median_ms"] = 1000 * float(np.median(seconds))
        figures[f"{robot}.p99_ms"] = 1000 * float(np.quantile(seconds, 0.99))
        figures[f"{robot}.min_distance_mm"] = 1000 * min(each.distance for each in done)
        figures[f"{robot}.deepest_contact_mm"] = 1000 * min(each.overlap for each in done)
        straight = [line for some in spread(straight_lines, tasks(robot, seed), jobs) for line in some]
        figures |= line_figures(robot, straight)
        for kind, lines in (("violation", "violations"), ("stuck", "stuck")):
            found = Counter(line for each in done for line in getattr(each, lines))
            notes += [f"{robot}: {kind}: {line} (x{count})" for line, count in found.most_common(5)]
    settings = {
        "showtell": f"kinematic, {1 / DT:.0f} Hz, one core a task; a third each of random, adversarial and human-like "
        f"input; times are those of the core; limits "
        f"looked at each step, all distances every {LOOK_EVERY} steps; at least {1000 * LEAST:g} mm to "
        "everything but what fingers touch",
        "lines": f"{STARTS} random starts and directions, each at {', '.join(map(str, SPEEDS))} m/s over {LONG} m with "
        "nothing around; all slow-downs count, up to where a joint's end or the robot itself turns the tool off",
    }
    return BenchReport(figures, settings=settings, notes=tuple(notes))


def chunks(steps: int) -> int:
    """Tasks that so many steps take."""
    return -(-steps // CHUNK)


def scene(robot: str, rng: np.random.Generator) -> SceneSpec | str:
    """A random scene of a robot's own kind."""
    if robot == "baxter":
        return random_tabletop(rng)
    if robot == "mico_segway":
        return random_ordering(rng)
    return "board"


def drive(task: tuple[str, int, int]) -> Chunk:
    """Drive a robot in a scene of its own: robot, seed and number of the task."""
    name, seed, number = task
    rng = np.random.default_rng([seed, number, *name.encode()])
    with World.from_scene(scene(name, rng), robot=name, seed=int(rng.integers(1 << 30))) as world:
        robot, obstacles = world.placed_robot, world.obstacles()
        start = world.joint_positions
    return _Driver(robot, obstacles, start, rng).drive(number)


class _Driver:
    """One robot in one scene, moved by what the servo says and by nothing else."""

    def __init__(
        self, robot: RobotModel, obstacles: Sequence[Obstacle], start: FloatArray, rng: np.random.Generator
    ) -> None:
        self._robot, self._rng, self._start = robot, rng, start
        self._servo = RobotServo(robot, obstacles)
        self._way_out = WayOut(robot, RobotServo(robot, obstacles))
        self._judge = CollisionModel(robot, obstacles, may_touch=_touching(robot, obstacles))
        self._all = CollisionModel(robot, obstacles)
        self._input = InputMaker(robot, obstacles, rng)
        drive = robot.drive
        extra = [] if drive is None else [(drive.speed, drive.yaw_rate), (drive.acceleration, drive.yaw_acceleration)]
        extra += [] if drive is None else [(drive.jerk, drive.yaw_jerk)]
        joints = (robot.velocity, robot.acceleration, robot.jerk)
        self._limits = [np.append(each, extra[i] if extra else ()) for i, each in enumerate(joints)]
        self._violations: list[str] = []
        self._stuck: list[str] = []
        self._halted = 0
        self._seconds: list[float] = []
        self._distance = self._overlap = float("inf")

    def drive(self, number: int) -> Chunk:
        for episode in range(CHUNK // EPISODE):
            self._episode(KINDS[(number * (CHUNK // EPISODE) + episode) % len(KINDS)])
        return Chunk(
            self._robot.name,
            len(self._seconds),
            tuple(self._violations),
            tuple(self._stuck),
            self._halted,
            np.array(self._seconds),
            self._distance,
            self._overlap,
        )

    def _episode(self, kind: str) -> None:
        robot, servo = self._robot, self._servo
        servo.reset()
        base = robot.pose_base_in_world
        openings = {name: arm.gripper.max_opening for name, arm in robot.arms.items()}
        q = self._free_start(openings, kind)
        self._input.begin(kind)
        speeds, track, wait = [], [q], 0
        for step in range(EPISODE):
            command = self._input.command(q, base, step)
            view = ServoView(q, np.zeros(len(q)), openings, base)
            began = time.thread_time()
            result = servo.step(command, view, DT)
            self._seconds.append(time.thread_time() - began)
            speeds.append(np.append(result.joint_velocity, result.base_twist if robot.drive else ()))
            q = q + result.joint_velocity * DT
            track.append(q)
            if robot.drive is not None and result.base_twist.any():
                base = rolled(base, result.base_twist[None] * DT)[0]
            for name, wanted in result.openings.items():
                change = np.clip(wanted - openings[name], -GRIP_SPEED * DT, GRIP_SPEED * DT)
                openings[name] = max(openings[name] + float(change), robot.arms[name].gripper.min_opening)
            if step % LOOK_EVERY == 0:
                self._look(q, openings, base, kind)
            wait = wait + 1 if halted(result) else 0
            if wait % 120 == 5:
                self._find_way_out(result, q, openings, base, kind)
        self._check(np.array(speeds), np.array(track), kind)

    def _free_start(self, openings: dict[str, float], kind: str) -> FloatArray:
        """A random posture that is free; now and then the scene's own."""
        robot, rng = self._robot, self._rng
        for model in (self._judge, self._all):
            model.place_base(robot.pose_base_in_world)
        lower = np.where(np.isinf(robot.lower), -np.pi, robot.lower) + 0.005
        upper = np.where(np.isinf(robot.upper), np.pi, robot.upper) - 0.005
        if rng.uniform() < 0.7:
            for _ in range(200):
                q = rng.uniform(lower, upper)
                if kind == "adversarial":  # some joints near an end or straight
                    chosen = rng.uniform(size=len(q))
                    q = np.where(chosen < 0.15, lower, np.where(chosen > 0.85, upper, q))
                    q = np.where((chosen > 0.4) & (chosen < 0.55), np.clip(0.0, lower, upper), q)
                # Now and then a finger touches something already.
                touching = rng.uniform() < 0.2
                if self._judge.nearest(q, openings).distance > START and (
                    self._all.nearest(q, openings).distance > (-0.002 if touching else START)
                ):
                    return np.asarray(q)
        return np.clip(self._start, lower, upper)

    def _look(self, q: FloatArray, openings: dict[str, float], base: Pose, kind: str) -> None:
        if self._robot.drive is not None:
            self._judge.place_base(base)
        nearest = self._judge.nearest(q, openings)
        self._distance = min(self._distance, nearest.distance)
        if nearest.distance < LEAST:
            self._violations.append(f"{kind}: {nearest.first} nearer than 5 mm to {nearest.second}")
        if len(self._seconds) % (10 * LOOK_EVERY) == 1:
            if self._robot.drive is not None:
                self._all.place_base(base)
            self._overlap = min(self._overlap, self._all.nearest(q, openings).distance)

    def _check(self, speeds: FloatArray, track: FloatArray, kind: str) -> None:
        """Look at all limits of an episode that began at rest; rates are differences of what was executed."""
        padded = np.vstack((np.zeros((2, speeds.shape[1])), speeds))
        rates = np.diff(padded, axis=0) / DT
        jerks = np.diff(rates, axis=0) / DT
        for what, values, limits, slack in (
            ("velocity", speeds, self._limits[0], 1e-9),
            ("acceleration", rates, self._limits[1], 1e-6),
            ("jerk", jerks, self._limits[2], 1e-3),  # rounding of the last digits, divided by the period twice
        ):
            if not np.isfinite(values).all():
                self._violations.append(f"{kind}: {what} is not finite")
            over = np.abs(values).max(axis=0) > limits + slack
            self._violations += [f"{kind}: {what} of speed {i}" for i in np.flatnonzero(over).tolist()]
        beyond = (track < self._robot.lower).any(axis=0) | (track > self._robot.upper).any(axis=0)
        self._violations += [f"{kind}: position of {self._robot.joint_names[i]}" for i in np.flatnonzero(beyond)]

    def _find_way_out(
        self, result: RobotServoResult, q: FloatArray, openings: dict[str, float], base: Pose, kind: str
    ) -> None:
        """For each arm that was asked to move and does not, look for an input that moves it; so for the base."""
        for name, stuck in self._way_out.stuck(result, q, openings, base).items():
            self._halted += 1
            if stuck and name == "base":
                self._stuck.append(f"{kind}: base: {result.base_reason} {result.base_detail}")
            elif stuck:
                self._stuck.append(f"{kind}: arm {name}: {result.arms[name].reason} {result.arms[name].detail}")


def _touching(robot: RobotModel, obstacles: Sequence[Obstacle]) -> list[tuple[str, str]]:
    """Pairs whose contact is allowed: links that fingers carry, and things."""
    model = whole_model(robot.urdf_path)
    fingers = [joint for arm in robot.arms.values() for joint in arm.gripper.joints]
    carried = {int(each) for joint in fingers for each in model.subtrees[model.getJointId(joint)]}
    links = [str(frame.name) for frame in model.frames if int(frame.parentJoint) in carried]
    return [(link, thing.name) for link in links for thing in obstacles]
