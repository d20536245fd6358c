"""Picking, carrying and placing in physics: done by each robot, refused with a reason, and never beyond a limit."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pytest

from executor.handling import Handled, Handling
from robots import RobotError
from robots.pose import FloatArray
from twin import JointCommand, ObjectSpec, SceneSpec, TwinError, World
from twin.board import cell_centre
from twin.objects import object_model

THING = 3


def block(number: int, x: int, y: int, z: int = 0, beside: float = 0.0, shape: str = "cube") -> ObjectSpec:
    """A block on the board's cells, moved along y [m]."""
    position = cell_centre(x, y, z) + [0.0, beside, 0.0]
    return ObjectSpec.model_validate({"id": number, "shape": shape, "colour": "red", "position": tuple(position)})


def thing(number: int, name: str, x: float, y: float) -> ObjectSpec:
    return ObjectSpec.of_model(number, name, (x, y, float(object_model(name).half_extents[2])))


def scene(robot: str, *objects: ObjectSpec) -> SceneSpec:
    kind = "board" if robot == "three_dof" else "table"
    return SceneSpec.model_validate({"name": "handled", "kind": kind, "robot": robot, "objects": objects})


def hands(world: World, arm: str | None = None) -> Handling:
    return Handling(world, arm or next(iter(world.robot.arms)), np.random.default_rng(0))


@dataclass
class Log:
    """What was commanded at every step, and what was touched."""

    velocity: list[FloatArray]
    openings: list[tuple[float, ...]]
    targets: list[FloatArray]


def recorded(world: World) -> Log:
    """Keep all commands from now on."""
    log, step = Log([], [], []), world.step

    def keep(command: JointCommand) -> None:
        assert not isinstance(command.gripper_opening, float | int | list), "who keeps a command must not see it change"
        log.velocity.append(command.velocity.copy())
        log.openings.append(tuple(command.gripper_opening))
        step(command)
        log.targets.append(world.commanded_positions)

    world.step = keep  # type: ignore[method-assign]
    return log


CASES = {
    "three_dof": (scene("three_dof", block(THING, 3, 4), block(8, 4, 4, shape="prism")), (0.10, -0.10, 0.0)),
    "baxter": (scene("baxter", thing(THING, "red_apple", 0.65, 0.2), thing(8, "blue_mug", 0.6, -0.3)), (0, -0.15, 0)),
    "mico_segway": (scene("mico_segway", thing(THING, "small_red_can", 0.52, 0.0)), (0.0, -0.10, 0.0)),
}


@pytest.mark.parametrize("robot", list(CASES))
def test_an_object_is_picked_carried_and_placed_within_all_limits(robot: str) -> None:
    spec, way = CASES[robot]
    with World(spec) as world:
        log, handling = recorded(world), hands(world)
        before = positions(world)
        picked = handling.pick(THING, lift=0.08)
        assert picked.success and picked.slip is not None and not picked.slip.slipped
        assert world.state().arms[0].held == THING
        # Fingers centre it as they close.
        np.testing.assert_allclose(positions(world)[THING] - before[THING], [0.0, 0.0, 0.08], atol=0.004)
        plan = handling.plan_carry(np.array(way), drop=float(positions(world)[THING][2] - before[THING][2]))
        assert plan is not None
        carried = handling.carry(plan)
        assert carried.success and carried.slip is not None and carried.slip.distance < 0.002
        placed = handling.place(plan)
        assert placed.success and placed.slip is not None and not placed.slip.slipped
        handling.rest(0.3)
        after = positions(world)
        np.testing.assert_allclose(after[THING] - before[THING], way, atol=0.003)
        assert world.state().arms[0].held is None
        assert world.touches() == set()
        for number in before:
            if number != THING:
                np.testing.assert_allclose(after[number], before[number], atol=1e-3)
        assert handling.go_home().success
        np.testing.assert_allclose(world.joint_positions, world.robot.home, atol=1e-3)
        within_limits(world, log)
        # Only this arm moved, and the other one's fingers stayed open.
        others = np.ones(len(world.robot.joint_names), bool)
        others[world.robot.slice_of(handling.arm_name)] = False
        assert not np.any(np.array(log.velocity)[:, others])
        for number, arm in enumerate(list(world.robot.arms.values())[1:], 1):
            assert {each[number] for each in log.openings} == {arm.gripper.max_opening}


def positions(world: World) -> dict[int, FloatArray]:
    return {each.id: each.pose_object_in_world.position.copy() for each in world.state().objects}


def within_limits(world: World, log: Log) -> None:
    """Velocities as commanded, and their differences, stay inside the robot's limits."""
    robot, velocity = world.robot, np.array(log.velocity)
    assert np.all(np.abs(velocity) <= robot.velocity * (1 + 1e-6))
    acceleration = np.diff(velocity, axis=0) / World.DT
    # A command is the way to the next point over the step: the mean velocity. Its change over a step is a mean too.
    assert np.all(np.abs(acceleration) <= robot.acceleration * (1 + 1e-6))
    targets = np.array(log.targets)
    assert np.all(targets >= robot.lower - 1e-9) and np.all(targets <= robot.upper + 1e-9)
    assert np.abs(velocity).max() > 0.1


def test_either_arm_picks_what_is_on_its_side() -> None:
    spec = scene("baxter", thing(THING, "red_apple", 0.65, -0.2))
    with World(spec) as world:
        picked = hands(world, "right").pick(THING)
        assert picked.success
        assert [arm.held for arm in world.state().arms] == [None, THING]
    with World(spec) as world, pytest.raises(RobotError, match="baxter has no arm 'middle': use one of left, right"):
        hands(world, "middle")


def test_a_mug_in_the_hand_is_restored_exactly() -> None:
    """What is concave touches with several parts, of which Bullet restores one: the world sees to the others."""
    with World(scene("baxter", thing(THING, "green_mug", 0.65, 0.2))) as world:
        handling = hands(world)
        assert handling.pick(THING).success
        openings = (0.0, world.robot.arms["right"].gripper.max_opening)
        velocity = np.zeros(14)
        for moment in range(2):
            snapshot = world.snapshot()
            here = positions(world)[THING]
            futures = []
            for _ in range(2):
                for step in range(80):
                    velocity[:7] = min(1.0, step / 30) * np.array([0.3, 0.1, 0.0, 0.2, 0.0, 0.4, 0.8])
                    world.step(JointCommand(velocity, openings))
                futures.append(positions(world)[THING])
                for _ in range(60):
                    world.step(JointCommand(np.zeros(14), (0.04, 0.04)))
                world.restore(snapshot)
                np.testing.assert_array_equal(positions(world)[THING], here)
            np.testing.assert_array_equal(futures[0], futures[1])
            assert np.linalg.norm(futures[0] - here) > 0.02
            assert world.state().arms[0].held == THING, moment
            for _ in range(40):
                world.step(JointCommand(0.2 * velocity, openings))


@pytest.fixture(scope="module")
def crowded() -> Iterator[World]:
    """A cube between two walls that leave the fingers no room, another one far off, and a loose one."""
    walls = [block(10 * side + z, 3, 4, z, sign * 0.0385) for side, sign in ((1, -1), (2, 1)) for z in range(3)]
    with World(scene("three_dof", block(0, 3, 4), *walls, block(1, 6, 1))) as world:
        yield world


def test_what_cannot_be_gripped_is_refused_with_the_reason(crowded: World) -> None:
    before = crowded.commanded_positions
    handling = hands(crowded)
    blocked = handling.pick(0)
    assert not blocked.success
    assert blocked.reason == "no room: the hand would touch something before every grasp"
    np.testing.assert_array_equal(crowded.commanded_positions, before)
    assert crowded.time == 0.0
    with pytest.raises(TwinError, match="no object 99; the scene has 0, 10, 11, 12, 20, 21, 22, 1"):
        handling.pick(99)


def test_what_is_too_wide_and_what_is_out_of_reach_are_told_apart() -> None:
    far = thing(THING, "red_apple", 1.02, -0.55)
    with World(scene("baxter", thing(1, "small_red_cup", 0.65, 0.2), far)) as world:
        handling = hands(world, "left")
        assert min(each.width for each in object_model("small_red_cup").grasps) > handling.arm.gripper.max_opening
        wide, away = handling.pick(1), handling.pick(THING)
    assert not wide.success and wide.reason == "no grasp: no part of the object fits between the fingers"
    assert not away.success and away.reason.startswith("out of reach: no posture brings the hand to any grasp")


def test_nothing_is_carried_or_placed_by_an_empty_hand(crowded: World) -> None:
    handling = hands(crowded)
    plan = handling.plan_carry(np.array([0.05, 0.0, 0.0]), drop=0.02)
    assert plan is not None
    before = crowded.time
    for refused in (handling.carry(plan), handling.place(plan)):
        assert refused == Handled(False, "nothing held: pick an object first")
    assert crowded.time == before


def test_a_carry_out_of_reach_has_no_plan_and_what_is_taken_away_is_missed() -> None:
    with World(scene("three_dof", block(THING, 3, 4))) as world:
        handling = hands(world)
        assert handling.pick(THING).success
        assert handling.plan_carry(np.array([2.0, 0.0, 0.0])) is None
        plan = handling.plan_carry(np.array([0.1, 0.1, 0.0]))
        assert plan is not None
        # Someone knocks the block out of the hand.
        body = world._blocks[0].body
        world._physics._put(body, ((0.5, 0.5, 0.019), (0.0, 0.0, 0.0, 1.0)))
        carried = handling.carry(plan)
        assert not carried.success
        assert carried.reason == "dropped: the object left the hand while carrying"
        placed = handling.place(plan)
        assert not placed.success and "dropped" in placed.reason
        assert handling.place(plan).reason == "nothing held: pick an object first"


def test_the_way_to_a_goal_goes_around_what_is_between() -> None:
    """A tower stands between the cube and where it is carried: nothing is touched on the way."""
    tower = [block(10 + z, 3, 3, z) for z in range(5)]
    with World(scene("three_dof", block(THING, 3, 5), *tower)) as world:
        handling = hands(world)
        assert handling.pick(THING, lift=0.06).success
        before = positions(world)
        plan = handling.plan_carry(np.array([0.0, -0.2, 0.0]), drop=0.06)
        assert plan is not None
        assert handling.carry(plan).success and handling.place(plan).success
        after = positions(world)
        for number in range(10, 15):
            np.testing.assert_allclose(after[number], before[number], atol=1e-3)
        np.testing.assert_allclose(after[THING][:2], cell_centre(3, 1, 0)[:2], atol=0.003)
