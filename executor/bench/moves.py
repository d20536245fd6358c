"""Random moves in physics: every limit is kept on the sampled output, and nothing is touched."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from executor.bench.pool import spread
from executor.bench.report import BenchReport
from robots.collision import CollisionModel
from robots.pose import FloatArray
from robots.trajectories import JointLimits, check_limits, plan_motion
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
TRACKING = 2e-3
"""How far the joints of the twin may be from the trajectory [rad]."""
CHUNK = 25
"""Moves made one after the other in one world."""
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
    """

    made: int
    violations: int
    touches: int
    strays: int
    unplanned: int
    worst: float
    farthest: float


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
    settings = {
        "showtell": f"random free postures of all joints, planned with {1000 * MARGIN:g} mm to everything, limits "
        f"checked at {1 / SAMPLE:.0f} Hz, contacts after every physics step"
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
            touched, off = _play(world, plan.trajectory.sample(SAMPLE).position, list(openings.values()))
            touches += touched
            strays += off > TRACKING
            farthest = max(farthest, off)
            made += 1
    return Moves(made, violations, touches, strays, unplanned, worst, farthest)


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
