"""The person who drives a hand over a table."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robots.kinematics import quaternion_xyzw, rotation_matrix
from robots.pose import Pose
from teleop.drive_command import DriveCommand
from teleop.drive_session import DriveSession
from teleop.strokes import Grip, Reach, Rest, Stroke
from teleop.table_operator import LOOK_EVERY, TableOperator, difference
from twin import World

_ANGLES = st.floats(-1.5, 1.5)


def _turn(roll: float, pitch: float, yaw: float) -> np.ndarray:
    cx, sx, cy, sy, cz, sz = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    about_x = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


@given(_ANGLES, _ANGLES, _ANGLES, _ANGLES)
def test_the_difference_of_two_poses_leads_from_one_to_the_other(a: float, b: float, c: float, d: float) -> None:
    start = Pose(np.zeros(3), quaternion_xyzw(_turn(a, b, c)))
    goal = Pose(np.ones(3), quaternion_xyzw(_turn(c, d, a)))
    shift, vector = difference(start, goal)
    angle = float(np.linalg.norm(vector))
    x, y, z = (vector / angle).tolist() if angle > 1e-9 else (1.0, 0.0, 0.0)
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    turned = np.eye(3) + np.sin(angle) * skew + (1 - np.cos(angle)) * (skew @ skew)
    assert shift.tolist() == [1.0, 1.0, 1.0]
    # Rounding of quaternions and of Rodrigues' formula: a few times 1e-16, more near half a turn.
    assert turned @ rotation_matrix(start.orientation_xyzw) == pytest.approx(
        rotation_matrix(goal.orientation_xyzw), abs=1e-7
    )


def _drive(world: World, strokes: list[Stroke]) -> TableOperator:
    operator = TableOperator(tuple(world.robot.arms), "arm", strokes, np.random.default_rng(0))
    session, command = DriveSession(world), DriveCommand()
    for step in range(4000):
        if step % LOOK_EVERY == 0:
            command = operator.act(world.state())
        if operator.done:
            break
        session.step(command)
    return operator


def test_the_hand_goes_straight_to_a_pose_and_closes() -> None:
    with World.from_scene("ordering", seed=3) as world:
        start = world.state().pose_tool_in_world
        goal = Pose(start.position + [0.04, 0.02, 0.03], start.orientation_xyzw)
        operator = _drive(world, [Reach(goal, 0.15), Grip("close"), Rest(0.1)])
        state = world.state()
        assert operator.done
        assert not operator.failed
        off, turn = difference(state.pose_tool_in_world, goal)
        assert np.linalg.norm(off) < 0.003 + 0.001  # `near`, and what it goes on while it brakes
        assert np.linalg.norm(turn) < 0.02 + 0.01
        assert state.gripper_closed


def test_a_pose_out_of_reach_is_given_up_with_a_reason() -> None:
    with World.from_scene("ordering", seed=3) as world:
        start = world.state().pose_tool_in_world
        far = Pose(start.position + [0.6, 0.0, 0.3], start.orientation_xyzw)
        operator = _drive(world, [Reach(far, 0.5, patience=0.2), Grip("close")])
        assert "before stroke 0's end" in operator.failed
        assert not world.state().gripper_closed
