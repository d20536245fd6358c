"""Kinematics of the robots against PyBullet, finite differences and geometry."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import Pose, RobotError, RobotModel, list_robots, load_robot
from robots.kinematics import frame_pose, rotation_matrix

from .bullet_robot import BulletRobot

TURNED = Pose(np.array([0.3, -0.2, 0.1]), np.array([0.1, -0.2, 0.3, 0.9]) / np.linalg.norm([0.1, -0.2, 0.3, 0.9]))


@pytest.fixture(scope="module")
def turned(arm: RobotModel) -> RobotModel:
    return arm.placed_at(TURNED)


def random_postures(arm: RobotModel, count: int, seed: int = 0) -> np.ndarray:
    """Within the limits, and up to two turns either way where there are none."""
    lower, upper = (np.where(np.isinf(each), np.sign(each) * 4 * np.pi, each) for each in (arm.lower, arm.upper))
    return np.random.default_rng(seed).uniform(lower, upper, (count, arm.lower.size))


def assert_same(here: Pose, there: Pose) -> None:
    """PyBullet computes in double but reads the URDF's numbers with its own rounding, and turns in single precision."""
    np.testing.assert_allclose(here.position, there.position, atol=1e-6)
    turns = [rotation_matrix(pose.orientation_xyzw) for pose in (here, there)]
    np.testing.assert_allclose(turns[0], turns[1], atol=1e-6)


@pytest.mark.parametrize("turn", [False, True], ids=["in its place", "elsewhere"])
@pytest.mark.parametrize("name", list_robots())
def test_forward_kinematics_agrees_with_pybullet(name: str, turn: bool) -> None:
    robot = load_robot(name)
    if turn:
        robot = robot.placed_at(TURNED)
    with BulletRobot(robot) as bullet:
        for q in random_postures(robot, 200):
            bullet.place(robot.expand(q))
            for arm in robot.arms.values():
                pose, there = arm.forward_kinematics(q[robot.slice_of(arm.name)]), bullet.frame(arm.tool_frame)
                assert_same(pose, there)


@pytest.mark.parametrize("name", list_robots())
def test_every_link_is_where_pybullet_has_it_fingers_and_passive_joints_too(name: str) -> None:
    robot = load_robot(name)
    rng = np.random.default_rng(1)
    with BulletRobot(robot) as bullet:
        for q in random_postures(robot, 20):
            openings = {each.name: rng.uniform(0, each.gripper.max_opening) for each in robot.arms.values()}
            joints = robot.expand(q, openings)
            bullet.place(joints)
            for link in bullet.links:
                there, here = bullet.frame(link), frame_pose(robot.urdf_path, joints, link)
                # None of ours stands turned.
                assert_same(Pose(robot.pose_base_in_world.position + here.position, here.orientation_xyzw), there)


def test_fingers_mounted_wider_are_where_pybullet_has_them() -> None:
    robot = load_robot("baxter", finger_mounting=0.01)
    with BulletRobot(robot) as bullet:
        joints = robot.expand(robot.home, {"left": 0.05, "right": 0.04})
        bullet.place(joints)
        for arm, gap in (("l", 0.05), ("r", 0.04)):
            tips = [f"{arm}_gripper_{side}_finger_tip" for side in ("l", "r")]
            assert bullet.between(*tips) == pytest.approx(gap, abs=1e-5)
            for tip in tips:
                here = robot.pose_base_in_world.position + frame_pose(robot.urdf_path, joints, tip).position
                np.testing.assert_allclose(here, bullet.frame(tip).position, atol=1e-6)


@pytest.mark.parametrize("name", list_robots())
def test_jacobians_agree_with_finite_differences(name: str) -> None:
    robot, step = load_robot(name).placed_at(TURNED), 1e-6
    for whole in random_postures(robot, 20):
        for arm in robot.arms.values():
            q = whole[robot.slice_of(arm.name)]
            jacobian, count = arm.jacobian(q), len(arm.joint_names)
            assert jacobian.shape == (6, count)
            rotation = rotation_matrix(arm.forward_kinematics(q).orientation_xyzw)
            for joint, change in enumerate(np.eye(count) * step):
                later, earlier = arm.forward_kinematics(q + change), arm.forward_kinematics(q - change)
                linear = (later.position - earlier.position) / (2 * step)
                turns = rotation_matrix(later.orientation_xyzw) - rotation_matrix(earlier.orientation_xyzw)
                spin = turns @ rotation.T / (2 * step)
                angular = np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]]) / 2
                # Central differences: the error is of the order of step² + rounding / step = 1e-10.
                np.testing.assert_allclose(jacobian[:3, joint], linear, atol=1e-8)
                np.testing.assert_allclose(jacobian[3:, joint], angular, atol=1e-8)


def test_the_board_arms_gripper_never_turns(turned: RobotModel) -> None:
    for q in random_postures(turned, 20):
        np.testing.assert_allclose(turned.jacobian(q)[3:], 0.0, atol=1e-12)


def test_position_and_jacobian_are_those_of_the_single_calls(turned: RobotModel) -> None:
    for q in random_postures(turned, 20):
        position, jacobian = turned.position_and_jacobian(q)
        np.testing.assert_allclose(position, turned.forward_kinematics(q).position, atol=1e-14)
        np.testing.assert_array_equal(jacobian, turned.jacobian(q))


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(0, 1), min_size=3, max_size=3))
def test_the_gripper_always_points_down_and_keeps_its_heading(arm: RobotModel, part: list[float]) -> None:
    pose = arm.forward_kinematics(arm.lower + np.array(part) * (arm.upper - arm.lower))
    np.testing.assert_allclose(np.abs(pose.orientation_xyzw), [0, 0, 0, 1], atol=1e-12)


def test_passive_joints_undo_the_driven_ones(arm: RobotModel) -> None:
    q = np.array([0.3, -0.8, 1.7])
    assert arm.expand(q) == {
        "base_yaw": 0.3,
        "shoulder": -0.8,
        "elbow": 1.7,
        "wrist_elbow": -1.7,
        "wrist_shoulder": 0.8,
        "wrist_yaw": -0.3,
    }


def test_placing_moves_the_tool_with_the_base(arm: RobotModel) -> None:
    shift = np.array([0.5, 0.0, 0.2])
    moved = arm.placed_at(Pose(arm.pose_base_in_world.position + shift, arm.pose_base_in_world.orientation_xyzw))
    np.testing.assert_allclose(
        moved.forward_kinematics(arm.home).position, arm.forward_kinematics(arm.home).position + shift, atol=1e-12
    )


def test_limits_and_home_are_read_only_and_consistent(arm: RobotModel) -> None:
    for values in (arm.lower, arm.upper, arm.velocity, arm.acceleration, arm.jerk, arm.home):
        assert values.shape == (3,)
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 1.0
    assert np.all(arm.lower < arm.home) and np.all(arm.home < arm.upper)


def test_values_of_another_length_are_refused(arm: RobotModel) -> None:
    with pytest.raises(RobotError, match=r"three_dof has 3 driven joints, got values of shape \(2,\)"):
        arm.forward_kinematics(np.zeros(2))


def test_passive_finger_joints_follow_their_fingers_and_stop_at_their_limits() -> None:
    robot = load_robot("mico_segway")
    tips = {each.joint: each for each in robot.finger_mimic}
    assert set(tips) == {"finger_tip_1", "finger_tip_2"}
    for opening in np.linspace(0, robot.gripper.max_opening, 20):
        joints = robot.expand(robot.home, {"arm": opening})
        for name, each in tips.items():
            wanted = each.ratio * joints[each.source] + each.offset
            assert joints[name] == pytest.approx(min(max(wanted, each.lower), each.upper), abs=1e-12)
    assert robot.expand(robot.home, {"arm": 0.0})["finger_tip_1"] == tips["finger_tip_1"].lower


def test_locked_joints_and_what_mimics_them_hold_the_arm_where_they_are(
    arm: RobotModel, spoiled: Callable[..., Path]
) -> None:
    folder = spoiled('joints = ["base_yaw", "shoulder", "elbow"]', 'joints = ["shoulder", "elbow"]')
    text = (folder / "robot.toml").read_text(encoding="utf-8")
    for row in ("home = [0.0, ", "velocity = [2.5, ", "acceleration = [12.0, ", "jerk = [180.0, "):
        assert row in text
        text = text.replace(row, row.split("[")[0] + "[")
    (folder / "robot.toml").write_text(text + "\n[locked]\nbase_yaw = 0.4\n", encoding="utf-8")
    held = load_robot(folder)
    assert dict(held.locked) == {"base_yaw": 0.4, "wrist_yaw": -0.4}
    for q in random_postures(held, 10):
        pose, whole = held.forward_kinematics(q), arm.forward_kinematics(np.array([0.4, *q]))
        np.testing.assert_allclose(pose.position, whole.position, atol=1e-12)
        np.testing.assert_allclose(pose.orientation_xyzw, whole.orientation_xyzw, atol=1e-12)


def test_several_arms_must_be_named() -> None:
    robot = load_robot("baxter")
    with pytest.raises(RobotError, match=r"baxter has several arms: use arms\[\.\.\.\] with one of left, right"):
        robot.forward_kinematics(robot.home[:7])
    with pytest.raises(RobotError, match="baxter has no arm 'middle': use one of left, right"):
        robot.slice_of("middle")
    with pytest.raises(RobotError, match=r"baxter's arm left has 7 driven joints, got values of shape \(14,\)"):
        robot.arms["left"].forward_kinematics(robot.home)
