"""A wrong robot.toml or URDF is refused in one line that names file, key and what is allowed."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from robots import RobotError, load_robot

WRONG = [
    ("jerk = [180.0, 180.0, 270.0]\n", "", "arms[0].jerk: missing"),
    ("max_opening = 0.048", "max_opening = -1", "arms[0].gripper.max_opening: Input should be greater than 0; got -1"),
    ("max_opening = 0.048", "max_opening = 0.2", "arms[0].gripper.max_opening: finger_left opens to 0.024 m, so at most 0.048"),
    ("max_opening = 0.048", 'max_opening = "wide"', "arms[0].gripper.max_opening: Input should be a valid number"),
    ("[arms.gripper]", "[arms.gripper]\ncolour = 1", "arms[0].gripper.colour: unknown key; allowed keys here are joints,"),
    ("[arms.gripper]", "[arms.griper]", "arms[0].gripper: missing"),
    ('"elbow"]', '"knee"]', "arms[0].joints: no movable joint 'knee' in three_dof.urdf; it has base_yaw, shoulder, elbow"),
    ('"elbow"]', '"wrist_elbow"]', "arms[0].joints: 'wrist_elbow' mimics another joint and cannot be driven"),
    ('"elbow"]', '"shoulder"]', "arms[0]: joints must differ from each other, got base_yaw, shoulder, shoulder"),
    ("velocity = [2.5, 2.5, 3.5]", "velocity = [2.5, 2.5]", "arms[0]: velocity must hold one number per joint (3), got 2"),
    ("velocity = [2.5, 2.5, 3.5]", "velocity = [9.5, 2.5, 3.5]", "arms[0].velocity: base_yaw may be at most 2.5 rad/s"),
    ("home = [0.0,", "home = [7.0,", "arms[0].home: base_yaw must be in -1.6..1.6 rad, got 7.0"),
    ("home = [0.0,", "home = [nan,", "arms[0].home[0]: Input should be a finite number; got nan"),
    (
        'tool_frame = "tool"',
        'tool_frame = "tip"',
        "arms[0].tool_frame: no link 'tip' in three_dof.urdf; it has base, turret",
    ),
    ("[0.0, 0.0, 0.0, 1.0]", "[0.0, 0.0, 0.0, 2.0]", "base: orientation_xyzw must be a unit quaternion"),
    ('urdf = "three_dof.urdf"', 'urdf = "none.urdf"', "none.urdf: cannot be read: No such file"),
    ("[[arms]]", "[[arms", "not valid TOML"),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_wrong_robot_files_are_named(spoiled: Callable[..., Path], old: str, new: str, message: str) -> None:
    folder = spoiled(old, new)
    file = re.escape(str(folder))
    with pytest.raises(RobotError, match=rf"^{file}\S+: .*{re.escape(message)}|^{file}/{re.escape(message)}") as caught:
        load_robot(folder)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("</robot>", "", "not valid XML"),
        ('lower="0.2"', 'lower="low"', "joint elbow: lower must be a number, got 'low'"),
        ('<robot name="three_dof">', '<robots name="x"><robot name="three_dof">', "not valid XML"),
    ],
)
def test_wrong_urdfs_are_named(spoiled: Callable[..., Path], old: str, new: str, message: str) -> None:
    folder = spoiled(old, new, "three_dof.urdf")
    with pytest.raises(RobotError, match=f"three_dof.urdf: .*{re.escape(message)}"):
        load_robot(folder)
