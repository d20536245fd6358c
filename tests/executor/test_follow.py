"""Trajectories on the twin: joints and base are where the trajectory is, and what was not meant to move does not."""

import math
from collections.abc import Iterator

import numpy as np
import pytest

from executor.follow import base_pose, follow, follow_base, wait
from robots.pose import FloatArray
from robots.trajectories import BaseLimits, JointLimits, drive_base, move_joints
from twin import JointCommand, SceneSpec, TwinError, World


def alone(robot: str) -> World:
    return World(SceneSpec.model_validate({"name": "alone", "kind": "table", "robot": robot}))


@pytest.fixture
def baxter() -> Iterator[World]:
    with alone("baxter") as world:
        yield world


@pytest.fixture(scope="module")
def mico() -> Iterator[World]:
    with alone("mico_segway") as world:
        yield world


def test_one_arm_follows_and_the_other_stays(baxter: World) -> None:
    arm, joints = baxter.robot.arms["right"], baxter.robot.slice_of("right")
    limits = JointLimits(arm.lower, arm.upper, arm.velocity, arm.acceleration, arm.jerk)
    goal = arm.home + [0.3, 0.2, -0.2, 0.3, 0.5, -0.4, 1.0]
    trajectory = move_joints(arm.home, goal, limits)
    commands: list[JointCommand] = []
    step, farthest = baxter.step, 0.0

    def keep(command: JointCommand) -> None:
        nonlocal farthest
        step(command)
        commands.append(command)
        wanted = trajectory.at(min(len(commands) * World.DT, trajectory.duration))[0]
        farthest = max(farthest, float(np.abs(baxter.joint_positions[joints] - wanted).max()))

    baxter.step = keep  # type: ignore[method-assign]
    openings = [0.02, 0.03]
    follow(baxter, trajectory, joints, openings)
    openings[0] = 0.0  # who kept the commands must not see this
    assert len(commands) == math.ceil(trajectory.duration / World.DT - 1e-9)
    np.testing.assert_allclose(baxter.commanded_positions[joints], goal, atol=1e-9)
    np.testing.assert_allclose(baxter.joint_positions[:7], baxter.robot.home[:7], atol=1e-4)
    assert farthest < 1e-3  # issue: 2 mrad; measured: 0.1
    assert {tuple(each.gripper_opening) for each in commands} == {(0.02, 0.03)}  # type: ignore[arg-type]
    assert all(not np.any(each.velocity[:7]) for each in commands)
    assert baxter.commanded_openings == (0.02, 0.03)


def test_waiting_moves_fingers_only(baxter: World) -> None:
    wait(baxter, 0.5, [0.01, 0.04])
    assert baxter.time == pytest.approx(0.5)
    np.testing.assert_allclose(baxter.joint_positions, baxter.robot.home, atol=1e-4)
    assert [round(arm.gripper_opening, 3) for arm in baxter.state().arms] == [0.01, 0.04]


@pytest.mark.parametrize("goal", [(-1.2, 0.5, 2.0), (-0.9, -0.6, -0.7), (-1.6, 0.0, 0.0)])
def test_the_base_comes_to_its_goal_also_with_the_arm_stretched_out(mico: World, goal: tuple[float, ...]) -> None:
    drive, arm = mico.robot.drive, mico.robot.arm
    assert drive is not None
    # Stretched to one side: what the wheels carry is uneven then.
    stretched: FloatArray = arm.home + [1.2, 0.3, 0.4, 0.0, 0.0, 0.0]
    limits = JointLimits(arm.lower, arm.upper, arm.velocity, arm.acceleration, arm.jerk)
    openings = [arm.gripper.max_opening]
    moved = drive_base(np.array(base_pose(mico)), np.array(goal), BaseLimits())
    assert moved.trajectory is not None
    whole = slice(0, 6)
    follow(mico, move_joints(mico.commanded_positions, stretched, limits), whole, openings)
    steps: list[FloatArray] = []
    follow_base(mico, moved.trajectory, openings, lambda: steps.append(np.array(base_pose(mico))))
    x, y, yaw = base_pose(mico)
    assert math.hypot(x - goal[0], y - goal[1]) < 0.005  # measured: 0.1 to 3 mm; with anchored wheels 47
    assert abs(np.remainder(yaw - goal[2] + np.pi, 2 * np.pi) - np.pi) < 0.01
    for number, pose in enumerate(steps[::24]):
        wanted = moved.trajectory.at((24 * number + 1) * World.DT)[0]
        assert np.linalg.norm(pose[:2] - wanted[:2]) < 0.02
        assert abs(np.remainder(pose[2] - wanted[2] + np.pi, 2 * np.pi) - np.pi) < 0.03
    np.testing.assert_allclose(mico.joint_positions, stretched, atol=2e-3)
    wait(mico, 1.0, openings)
    there = base_pose(mico)
    np.testing.assert_allclose(there, (x, y, yaw), atol=0.002)
    assert mico._robot.parked


def test_a_robot_without_wheels_is_not_driven(baxter: World) -> None:
    moved = drive_base(np.zeros(3), np.array([0.5, 0.0, 0.0]), BaseLimits())
    assert moved.trajectory is not None
    with pytest.raises(TwinError, match="baxter has no wheels"):
        follow_base(baxter, moved.trajectory, [0.04, 0.04])
