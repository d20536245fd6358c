"""Random moves in physics: every limit is kept on the sampled output, and nothing is touched."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from executor.bench.pool import spread
from executor.bench.report import BenchReport
from executor.follow import base_pose, follow_base
from robots.collision import CollisionModel
from robots.pose import FloatArray, Pose
from robots.trajectories import BaseLimits, JointLimits, check_limits, drive_base, plan_motion
from twin import JointCommand, World

SCENES = {"three_dof": "board", "baxter": "tabletop", "mico_segway": "ordering"}
MARGIN = 0.01
"""Distance [m] that the planner keeps from everything,"""
LEAST = 0.004
"""and what is left of it [m] between the postures at which it looks."""
SAMPLE = World.DT
"""Period at which a trajectory is held against its limits [s]."""
ROUNDING = 1e-6
"""A ratio above 1 by no more than this is rounding."""
LOOK_EVERY = 4
"""Samples between two looks at the distance of the robot to itself: 60 a second."""
TRACKING = 2e-3
"""How far the joints of the twin may be from the trajectory [rad]."""
CHUNK = 25
"""Moves made one after the other in one world."""
BASE_MARGIN = 0.02
"""Distance [m] that the base keeps from everything."""
FLOOR_SPACE = (np.array([-2.0, -1.5, -np.pi]), np.array([-0.1, 1.5, np.pi]))
"""Least and greatest x, y [m] and yaw [rad] of the base's goals."""
TRIES = 40
"""Goals tried for one move: most random postures of two arms touch something."""


@dataclass(frozen=True, slots=True)
class Moves:
    """What some moves did.

    Attributes:
        made: How many there were.
        violations: Moves that left a limit.
        touches: Moves during which the robot touched anything.
        strays: Moves in which the twin's joints were not where the trajectory was.
        unplanned: Goals to which no way was found; another one was taken.
        worst: Largest part of any limit that was used.
        farthest: Largest distance of a joint from its trajectory [rad].
        base_off: How far the base ended from its goal [m], for each of its moves.
    """

    made: int
    violations: int
    touches: int
    strays: int
    unplanned: int
    worst: float
    farthest: float
    base_off: tuple[float, ...] = ()


def run(
    seed: int, count: int, robots: Sequence[str], jobs: int = 0, on_done: Callable[[], None] = lambda: None
) -> BenchReport:
    """Move every robot to random postures, in its scene, all arms at once.

    Args:
        seed: Decides scenes and goals.
        count: Moves a robot.
        robots: Their names.
        jobs: Processes; 0 takes one a core.
        on_done: Called once for each move.
    """
    figures: dict[str, float | None] = {}
    for robot in robots:
        chunks = [(robot, seed, start, min(CHUNK, count - start)) for start in range(0, count, CHUNK)]
        done = []
        for result in spread(_some_moves, chunks, jobs):
            done.append(result)
            for _ in range(result.made):
                on_done()
        figures |= {
            f"{robot}.moves": sum(each.made for each in done),
            f"{robot}.violations": sum(each.violations for each in done),
            f"{robot}.touches": sum(each.touches for each in done),
            f"{robot}.strays": sum(each.strays for each in done),
            f"{robot}.unplanned_goals": sum(each.unplanned for each in done),
            f"{robot}.largest_part_of_a_limit": max(each.worst for each in done),
            f"{robot}.farthest_from_trajectory_mrad": 1000 * max(each.farthest for each in done),
        }
        if off := [1000 * each for result in done for each in result.base_off]:
            figures |= {f"{robot}.base_moves": len(off), f"{robot}.base_worst_off_mm": max(off)}
    settings = {
        "showtell": f"random free postures of all joints, planned with {1000 * MARGIN:g} mm to everything, limits "
        f"checked at {1 / SAMPLE:.0f} Hz, contacts after every physics step, self-collision at "
        f"{1 / SAMPLE / LOOK_EVERY:.0f} Hz"
    }
    return BenchReport(figures, settings=settings)


def _some_moves(task: tuple[str, int, int, int]) -> Moves:
    """Make some moves in one world."""
    robot, seed, start, count = task
    rng = np.random.default_rng([seed, start])
    made = violations = touches = strays = unplanned = 0
    worst = farthest = 0.0
    with World.from_scene(SCENES.get(robot, "board"), robot=robot, seed=int(rng.integers(2**31))) as world:
        model = world.robot
        limits = JointLimits(model.lower, model.upper, model.velocity, model.acceleration, model.jerk)
        around = CollisionModel(model, world.obstacles(detailed=()))
        openings = {name: arm.gripper.max_opening for name, arm in model.arms.items()}

        def free(q: FloatArray) -> bool:
            return around.free(q, openings, MARGIN)

        def clear(q: FloatArray) -> bool:
            return around.free(q, openings, LEAST)

        lower, upper = np.maximum(model.lower, -np.pi), np.minimum(model.upper, np.pi)
        for _ in range(count):
            for _ in range(TRIES):
                goal = _free_posture(rng, lower, upper, free)
                plan = plan_motion(world.commanded_positions, goal, limits, free, rng, is_clear=clear)
                if plan.trajectory is not None:
                    break
                unplanned += 1
            else:
                raise RuntimeError(f"{robot}: no way was found to {TRIES} goals from {world.commanded_positions}")
            report = check_limits(plan.trajectory, limits, SAMPLE)
            worst = max(worst, report.worst)
            violations += report.worst > 1 + ROUNDING
            positions = plan.trajectory.sample(SAMPLE).position
            touched, off = _play(world, positions, list(openings.values()))
            # PyBullet's robots pass through themselves; the geometry of the plan does not.
            crossed = not all(around.free(q, openings, 0.0) for q in positions[::LOOK_EVERY])
            touches += touched or crossed
            strays += off > TRACKING
            farthest = max(farthest, off)
            made += 1
        base_off: tuple[float, ...] = ()
        if model.drive is not None:
            # With the arm stretched out the base could hardly turn anywhere.
            home = plan_motion(world.commanded_positions, model.home, limits, free, rng, is_clear=clear)
            if home.trajectory is None:
                raise RuntimeError(f"{robot}: no way home from {world.commanded_positions}: {home.reason}")
            touches += _play(world, home.trajectory.sample(SAMPLE).position, list(openings.values()))[0]
            around.place_base(world.base_pose)
            part, touched, end = _move_base(world, around, rng)
            worst, base_off = max(worst, part), (end,)
            violations += part > 1 + ROUNDING
            touches += touched
    return Moves(made, violations, touches, strays, unplanned, worst, farthest, base_off)


def _move_base(world: World, around: CollisionModel, rng: np.random.Generator) -> tuple[float, bool, float]:
    """Drive the base to a random free pose.

    Returns the largest part of a limit, whether anything was touched, and how far from its goal it ended [m].
    """
    drive = world.robot.drive
    if drive is None:
        raise ValueError(f"{world.robot.name} has no wheels")
    limits = BaseLimits(
        drive.speed, drive.acceleration, drive.jerk, drive.yaw_rate, drive.yaw_acceleration, drive.yaw_jerk
    )
    height = float(world.base_pose.position[2])
    q, openings = world.commanded_positions, dict(zip(world.robot.arms, world.commanded_openings, strict=True))

    def free(pose: FloatArray, margin: float = BASE_MARGIN) -> bool:
        x, y, yaw = pose.tolist()
        turn = np.array([0.0, 0.0, np.sin(yaw / 2), np.cos(yaw / 2)])
        around.place_base(Pose(np.array([x, y, height]), turn))
        return around.free(q, openings, margin)

    start = np.array(base_pose(world))
    trajectory = None
    for _ in range(TRIES):
        goal = rng.uniform(*FLOOR_SPACE)
        trajectory = drive_base(start, goal, limits, free, rng).trajectory if free(goal) else None
        if trajectory is not None:
            break
    if trajectory is None:
        raise RuntimeError(f"no way was found for the base to {TRIES} goals from {start}")
    samples = trajectory.sample(SAMPLE)
    most = np.array([[drive.speed, drive.yaw_rate], [drive.acceleration, drive.yaw_acceleration]])
    part = max(
        float((np.abs(values) / bound).max())
        for values, bound in zip((samples.twist, samples.acceleration), most, strict=True)
    )
    touched: list[bool] = []
    follow_base(world, trajectory, world.commanded_openings, lambda: touched.append(bool(world.touches())))
    end = np.array(base_pose(world))
    return part, any(touched), float(np.linalg.norm(end[:2] - trajectory.goal[:2]))


def _free_posture(
    rng: np.random.Generator, lower: FloatArray, upper: FloatArray, free: Callable[[FloatArray], bool]
) -> FloatArray:
    while True:
        q = rng.uniform(lower, upper)
        if free(q):
            return q


def _play(world: World, positions: FloatArray, openings: list[float]) -> tuple[bool, float]:
    """Follow sampled positions (k, n); returns whether anything was touched, and the farthest joint [rad]."""
    touched, farthest = False, 0.0
    for wanted in positions[1:]:
        world.step(JointCommand((wanted - world.commanded_positions) / World.DT, openings))
        touched |= bool(world.touches())
        farthest = max(farthest, float(np.abs(world.joint_positions - wanted).max()))
    return touched, farthest
