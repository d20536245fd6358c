"""What a guard says depends on where things are, and on nothing that it was asked before."""

import numpy as np
import pytest

from robots import Obstacle, Pose, load_robot
from robots.model import RobotModel
from robots.pose import FloatArray
from teleop.base_servo import rolled
from teleop.servo_guard import LEAST, ServoGuard

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
PARTS = np.linspace(0.125, 1.0, 8)[:, None]


def things(robot: RobotModel) -> list[Obstacle]:
    """A table with things on it, and a ball that the first arm's tool hangs over."""
    arm = next(iter(robot.arms.values()))
    tool = arm.forward_kinematics(robot.home[robot.slice_of(arm.name)]).position
    return [
        Obstacle("hung", "sphere", (0.05,), Pose(tool - [0.0, 0.0, 0.2], LEVEL)),
        Obstacle("table", "box", (0.8, 1.2, 0.04), Pose(np.array([0.7, 0.0, -0.02]), LEVEL)),
        Obstacle("ball", "sphere", (0.04,), Pose(np.array([0.5, 0.2, 0.04]), LEVEL)),
        Obstacle("can", "cylinder", (0.03, 0.1), Pose(np.array([0.6, -0.1, 0.05]), LEVEL)),
    ]


def somewhere(robot: RobotModel, rng: np.random.Generator) -> FloatArray:
    lower, upper = np.maximum(robot.lower, -np.pi), np.minimum(robot.upper, np.pi)
    return np.asarray(np.clip(robot.home + rng.normal(0.0, 0.6, len(robot.home)), lower, upper))


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_what_was_asked_before_does_not_matter(name: str) -> None:
    """To the last bit: a piece of a demo is simulated afresh without what came before."""
    robot, rng = load_robot(name), np.random.default_rng(5)
    old, base = ServoGuard(robot, things(robot)), robot.pose_base_in_world
    dofs = len(robot.home) + (2 if robot.drive is not None else 0)
    offended = damped = 0
    for _ in range(30):
        start, speeds = somewhere(robot, rng), rng.normal(0.0, 1.0, dofs)
        for step in range(3):
            q, openings = start + speeds[: len(start)] * step / 240.0, {arm: 0.03 for arm in robot.arms}
            new = ServoGuard(robot, things(robot), own=old.own)
            way = PARTS * speeds * 0.4
            bases = rolled(base, way[:, len(start) :]) if robot.drive is not None else [base] * len(way)
            answers = []
            for guard in (old, new):
                guard.look(q, openings, base)
                answers.append((guard.dampers(speeds, np.full(dofs, 0.2)), guard.offending(way, bases)))
            (dampers, offending), (dampers_of_new, offending_of_new) = answers
            np.testing.assert_array_equal(dampers.pairs, dampers_of_new.pairs)
            np.testing.assert_array_equal(dampers.rows, dampers_of_new.rows)
            np.testing.assert_array_equal(dampers.least, dampers_of_new.least)
            assert set(offending) == set(offending_of_new)
            offended += len(offending)
            damped += len(dampers.pairs)
    assert offended and damped


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_ways_that_do_not_offend_keep_their_distance(name: str) -> None:
    """Looked at far more closely than the guard itself looks."""
    robot, rng = load_robot(name), np.random.default_rng(8)
    guard, base = ServoGuard(robot, things(robot)), robot.pose_base_in_world
    pairs, n = guard._pairs, len(robot.home)
    judge, everything = pairs.track(), np.arange(len(pairs.names))
    apart = ~guard.contacts
    gone = refused = 0
    for _ in range(60):
        q, dofs = somewhere(robot, rng), guard._dofs
        judge.jump(pairs.positions(q, {}), base)
        if judge.refine(everything)[apart].min() < LEAST:
            continue
        way = PARTS * rng.normal(0.0, 0.25, dofs)
        bases = rolled(base, way[:, n:]) if robot.drive is not None else [base] * len(way)
        guard.look(q, {}, base)
        if len(guard.offending(way, bases)):
            refused += 1
            continue
        gone += 1
        for part in np.linspace(0.0, 1.0, 25):
            turned = way[-1] * part
            at = rolled(base, turned[None, n:])[0] if robot.drive is not None else base
            judge.jump(pairs.positions(q + turned[:n], {}), at)
            # A straight way of the base between two looks is a little shorter than the arc; 2 um are the solver's.
            assert judge.refine(everything)[apart].min() > LEAST - (1e-4 if robot.drive is not None else 2e-6)
    assert gone and refused


def test_a_guard_rebuilt_for_what_is_held_is_like_a_new_one() -> None:
    robot = load_robot("baxter")
    guard = ServoGuard(robot, things(robot))
    hung, table, ball, can = things(robot)
    held = {"left": [Obstacle("can", "cylinder", (0.03, 0.1), Pose(np.array([0.0, 0.0, 0.03]), LEVEL))]}
    assert not guard.watch([hung, table, ball], held)
    rebuilt, new = guard.rebuilt([hung, table, ball], held), ServoGuard(robot, [hung, table, ball], held)
    assert list(rebuilt.names) == list(new.names)
    speeds = np.full(len(robot.home), 0.5)
    answers = []
    for each in (rebuilt, new):
        each.look(robot.home, {}, robot.pose_base_in_world)
        answers.append(
            (
                each.dampers(speeds, np.full(len(speeds), 0.1)),
                each.offending(PARTS * speeds, [robot.pose_base_in_world] * 8),
            )
        )
    (dampers, offending), (dampers_of_new, offending_of_new) = answers
    np.testing.assert_array_equal(dampers.rows, dampers_of_new.rows)
    np.testing.assert_array_equal(offending, offending_of_new)
    assert rebuilt.watch([hung, table, ball], held)
    assert not rebuilt.watch([hung, table, ball, can], {})
