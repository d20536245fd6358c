"""Kinematics of the board arm against PyBullet, finite differences and geometry."""

import numpy as np
import pybullet
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import Pose, RobotError, RobotModel

TURNED = Pose(np.array([0.3, -0.2, 0.1]), np.array([0.1, -0.2, 0.3, 0.9]) / np.linalg.norm([0.1, -0.2, 0.3, 0.9]))


@pytest.fixture(scope="module")
def turned(arm: RobotModel) -> RobotModel:
    return arm.placed_at(TURNED)


def random_postures(arm: RobotModel, count: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(arm.lower, arm.upper, (count, arm.lower.size))


def test_forward_kinematics_agrees_with_pybullet(arm: RobotModel, turned: RobotModel) -> None:
    for robot in (arm, turned):
        base = robot.pose_base_in_world
        client = pybullet.connect(pybullet.DIRECT)
        try:
            body = pybullet.loadURDF(
                str(robot.urdf_path), base.position, base.orientation_xyzw, useFixedBase=True, physicsClientId=client
            )
            infos = [
                pybullet.getJointInfo(body, joint, physicsClientId=client)
                for joint in range(pybullet.getNumJoints(body, physicsClientId=client))
            ]
            joints = {info[1].decode(): info[0] for info in infos}
            tool = next(info[0] for info in infos if info[12].decode() == robot.tool_frame)
            for q in random_postures(robot, 100):
                for name, value in robot.expand(q).items():
                    pybullet.resetJointState(body, joints[name], value, physicsClientId=client)
                state = pybullet.getLinkState(body, tool, computeForwardKinematics=True, physicsClientId=client)
                pose = robot.forward_kinematics(q)
                # PyBullet computes in double but reads the URDF's numbers with its own rounding.
                np.testing.assert_allclose(pose.position, state[4], atol=1e-6)
                assert abs(np.dot(pose.orientation_xyzw, state[5])) == pytest.approx(1.0, abs=1e-6)
        finally:
            pybullet.disconnect(client)


def test_jacobian_agrees_with_finite_differences(turned: RobotModel) -> None:
    step = 1e-6
    for q in random_postures(turned, 50):
        jacobian = turned.jacobian(q)
        assert jacobian.shape == (6, 3)
        for joint in range(3):
            change = np.eye(3)[joint] * step
            later, earlier = turned.forward_kinematics(q + change), turned.forward_kinematics(q - change)
            # Central differences: the error is of the order of step² + rounding / step = 1e-10.
            np.testing.assert_allclose(jacobian[:3, joint], (later.position - earlier.position) / (2 * step), atol=1e-8)
            # The gripper never turns.
            np.testing.assert_allclose(jacobian[3:, joint], 0.0, atol=1e-12)


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
