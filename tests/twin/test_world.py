"""Worlds: deterministic, apart from each other, exactly restorable, true to the commands."""

import gc

import numpy as np
import pytest

from robots import RobotError
from robots.pose import FloatArray
from twin import JointCommand, ObjectSpec, SceneError, SceneSpec, TwinError, World, WorldState
from twin.board import cell_centre

from .conftest import Hand

STILL = np.zeros(3)
OPEN = 0.048


def cube(number: int, x: int, y: int, z: int = 0) -> ObjectSpec:
    return ObjectSpec(id=number, shape="cube", colour="red", position=tuple(cell_centre(x, y, z)))


def numbers(state: WorldState) -> FloatArray:
    """Everything in a state, to compare bit for bit."""
    poses = [state.pose_tool_in_world, *(each.pose_object_in_world for each in state.objects)]
    flat = [part for pose in poses for part in (pose.position, pose.orientation_xyzw)]
    held = -1.0 if state.held is None else state.held
    rest = [state.time, state.gripper_opening, state.gripper_closed, held]
    return np.concatenate([state.q, state.dq, *flat, rest])


def wave(step: int) -> JointCommand:
    """A command that moves all joints and sweeps low enough to hit blocks."""
    phase = step / 240
    return JointCommand(
        np.array([0.8 * np.cos(2 * phase), 0.35, -0.1 * np.cos(3 * phase)]), OPEN if step < 300 else 0.0
    )


def test_equal_worlds_with_equal_commands_agree_bit_for_bit() -> None:
    with World.from_scene("board", seed=2) as one, World.from_scene("board", seed=2) as other:
        start = numbers(one.state())
        for step in range(480):
            one.step(wave(step))
            other.step(wave(step))
            if step % 7 == 0:  # asking must not change anything
                other.state()
        assert np.abs(numbers(one.state()) - start).max() > 0.1
        np.testing.assert_array_equal(numbers(one.state()), numbers(other.state()))


def test_two_worlds_do_not_meet() -> None:
    with World.from_scene("board", seed=1) as quiet:
        before = numbers(quiet.state())
        with World.from_scene("board", seed=2) as busy:
            for step in range(240):
                busy.step(wave(step))
            for _ in range(5):
                quiet.step(JointCommand(STILL, OPEN))
        quiet.step(JointCommand(STILL, OPEN))
        after = numbers(quiet.state())
    with World.from_scene("board", seed=1) as alone:
        np.testing.assert_array_equal(before, numbers(alone.state()))
        for _ in range(6):
            alone.step(JointCommand(STILL, OPEN))
        np.testing.assert_array_equal(after, numbers(alone.state()))


def test_restoring_is_exact_at_any_moment(hand: type[Hand]) -> None:
    """A block is taken, carried and dropped; snapshots along the way all lead to the same future."""
    scene = SceneSpec(objects=(cube(0, 2, 2), cube(1, 2, 2, 1), cube(2, 2, 2, 2), cube(3, 2, 3), cube(4, 5, 1)))
    commands: list[JointCommand] = []
    with World.from_scene(scene) as world:
        step = world.step

        def record(command: JointCommand) -> None:
            commands.append(command)
            step(command)

        world.step = record  # type: ignore[method-assign]
        driver = hand(world)
        top = cell_centre(2, 2, 2)
        driver.move(top + [0, 0, 0.05])
        driver.move(top)
        driver.grip(0.0)
        driver.move(cell_centre(5, 1, 4))
        driver.grip(OPEN)
        driver.wait(60)
    with World.from_scene(scene) as world:
        for number, command in enumerate(commands):
            if number % 250 == 100:
                snapshot = world.snapshot()
                here, future = numbers(world.state()), []
                for later in commands[number : number + 300]:
                    world.step(later)
                    future.append(numbers(world.state()))
                world.restore(snapshot)
                np.testing.assert_array_equal(numbers(world.state()), here)
                for later, known in zip(commands[number : number + 300], future, strict=True):
                    world.step(later)
                    np.testing.assert_array_equal(numbers(world.state()), known)
                world.restore(snapshot)
            world.step(command)


def test_a_snapshot_belongs_to_its_world() -> None:
    with World.from_scene(SceneSpec()) as one, World.from_scene(SceneSpec()) as other:
        snapshot = one.snapshot()
        with pytest.raises(TwinError, match="another world's"):
            other.restore(snapshot)


def test_joints_follow_velocities_without_sagging_or_drifting() -> None:
    with World.from_scene(SceneSpec()) as world:
        q = world.state().q.copy()
        for step in range(480):
            phase = step / 240
            velocity = np.array([0.8 * np.sin(3 * phase), 0.5 * np.cos(4 * phase), -0.7 * np.cos(4 * phase)])
            world.step(JointCommand(velocity, OPEN))
            q += velocity * World.DT
            state = world.state()
            # The motors' solver leaves a few millionths; without it gravity would show as milliradians.
            np.testing.assert_allclose(state.q, q, atol=1e-5)
            np.testing.assert_allclose(state.dq, velocity, atol=2e-3)
            # The passive joints keep the gripper upright and its heading.
            np.testing.assert_allclose(np.abs(state.pose_tool_in_world.orientation_xyzw), [0, 0, 0, 1], atol=2e-5)
            np.testing.assert_allclose(
                state.pose_tool_in_world.position, world.robot.forward_kinematics(state.q).position, atol=2e-5
            )


def test_position_limits_hold_whatever_is_commanded() -> None:
    with World.from_scene(SceneSpec()) as world:
        robot = world.robot
        for sign in (1.0, -1.0):
            for _ in range(720):
                world.step(JointCommand(sign * np.array([50.0, 50.0, 50.0]), OPEN))
                q = world.state().q
                # Stopping dead from full speed overshoots by half a milliradian.
                assert np.all(q <= robot.upper + 1e-3) and np.all(q >= robot.lower - 1e-3)
            np.testing.assert_allclose(q, robot.upper if sign > 0 else robot.lower, atol=1e-4)


def test_velocity_limits_hold_whatever_is_commanded() -> None:
    with World.from_scene(SceneSpec()) as world:
        start = world.state().q
        for step in range(1, 61):
            world.step(JointCommand(np.array([50.0, -50.0, -50.0]), OPEN))
            # From the start on, since a joint that fell behind in the first jerk catches up.
            gone = np.abs(world.state().q - start)
            assert np.all(gone <= world.robot.velocity * World.DT * step + 1e-5)
        assert gone[0] == pytest.approx(world.robot.velocity[0] * World.DT * 60, abs=1e-5)


def test_the_gripper_opens_and_closes_centred_at_its_speed() -> None:
    with World.from_scene(SceneSpec()) as world:
        gripper = world.robot.gripper
        assert world.state().gripper_opening == pytest.approx(OPEN, abs=1e-5)
        world.step(JointCommand(STILL, 0.0))
        assert world.state().gripper_closed
        for _ in range(23):
            world.step(JointCommand(STILL, 0.0))
        gone = 24 * World.DT * 2 * gripper.closing_speed
        assert world.state().gripper_opening == pytest.approx(OPEN - gone, abs=1e-3)
        for _ in range(72):
            world.step(JointCommand(STILL, 0.0))
        assert world.state().gripper_opening == pytest.approx(0.0, abs=1e-4)
        assert world.state().held is None
        for _ in range(96):
            world.step(JointCommand(STILL, 0.03))
        assert world.state().gripper_opening == pytest.approx(0.03, abs=1e-4)
        assert not world.state().gripper_closed


def test_time_counts_steps() -> None:
    with World.from_scene(SceneSpec()) as world:
        assert world.time == 0.0
        for _ in range(240):
            world.step(JointCommand(STILL, OPEN))
        assert world.time == world.state().time == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize(
    ("velocity", "opening", "message"),
    [
        (np.zeros(2), OPEN, r"3 finite joint velocities \[rad/s\], got \[0.0, 0.0\]"),
        (np.array([0.0, np.nan, 0.0]), OPEN, "3 finite joint velocities"),
        (STILL, 0.2, "gripper_opening must be in 0..0.048 m, got 0.2"),
        (STILL, float("nan"), "gripper_opening must be in"),
    ],
)
def test_impossible_commands_are_refused(velocity: FloatArray, opening: float, message: str) -> None:
    with World.from_scene(SceneSpec()) as world, pytest.raises(TwinError, match=message):
        world.step(JointCommand(velocity, opening))


def test_a_closed_world_says_so() -> None:
    world = World.from_scene(SceneSpec())
    world.close()
    world.close()
    for use in (lambda: world.step(JointCommand(STILL, OPEN)), world.state, world.snapshot):
        with pytest.raises(TwinError, match="this world is closed"):
            use()


def test_forgotten_worlds_are_closed() -> None:
    # PyBullet has about a thousand clients: a leak would end this early.
    for _ in range(3):
        world = World.from_scene(SceneSpec())
        closer = world._physics._closer
        del world
        gc.collect()
        assert not closer.alive


def test_the_gripper_starts_where_the_scene_says() -> None:
    with World.from_scene(SceneSpec(gripper_position=(0.3, 0.1, 0.25))) as world:
        np.testing.assert_allclose(world.state().pose_tool_in_world.position, (0.3, 0.1, 0.25), atol=2e-5)


def test_an_unreachable_start_and_an_unknown_robot_are_refused() -> None:
    with pytest.raises(SceneError, match=r"gripper_position \(2.0, 0.0, 0.3\) is out of three_dof's reach by \d+"):
        World.from_scene(SceneSpec(gripper_position=(2.0, 0.0, 0.3)))
    with pytest.raises(RobotError, match="'r2d2' is unknown: use one of .*three_dof"):
        World.from_scene("board", robot="r2d2")


def test_a_picture_shows_the_blocks() -> None:
    empty, red = SceneSpec(), SceneSpec(objects=(cube(0, 4, 1),))
    with World.from_scene(empty) as one, World.from_scene(red) as other:
        before, after = one.render(160, 120), other.render(160, 120)
        assert after.shape == (120, 160, 3) and after.dtype == np.uint8
        changed = after[np.any(before != after, axis=2)].astype(int)
        reddish = (changed[:, 0] > 2 * changed[:, 1]) & (changed[:, 0] > 80)
        assert reddish.sum() > 10
        with pytest.raises(TwinError, match="1..4096 pixels, got 0 x 120"):
            one.render(0, 120)
