"""A wrong robot.toml or URDF is refused in one line that names file, key and what is allowed."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from robots import RobotError, load_robot

FORCE, LAST = "force = 12.0", "closing_speed = 0.12"
DRIVE = """[drive]
wheels = ["wheel_l", "wheel_r"]
wheel_radius = 0.1
track = 0.4
speed = 0.5
acceleration = 0.5
jerk = 5.0
yaw_rate = 1.0
yaw_acceleration = 1.5
yaw_jerk = 15.0"""
ROLLS = DRIVE.replace("wheel_l", "base_yaw").replace('wheel_r"', 'elbow"') + '\nrollers = ["caster"]'
WRONG = [
    ("jerk = [180.0, 180.0, 270.0]\n", "", "arms[0].jerk: missing"),
    ("max_opening = 0.048", "max_opening = -1", "arms[0].gripper.max_opening: Input should be greater than 0; got -1"),
    (
        "max_opening = 0.048",
        "max_opening = 0.2",
        "arms[0].gripper.max_opening: finger_left opens to 0.024 m, so at most 0.048",
    ),
    ("max_opening = 0.048", 'max_opening = "wide"', "arms[0].gripper.max_opening: Input should be a valid number"),
    (
        "[arms.gripper]",
        "[arms.gripper]\ncolour = 1",
        "arms[0].gripper.colour: unknown key; allowed keys here are joints,",
    ),
    ("[arms.gripper]", "[arms.griper]", "arms[0].gripper: missing"),
    (
        '"elbow"]',
        '"knee"]',
        "arms[0].joints: no movable joint 'knee' in three_dof.urdf; it has base_yaw, shoulder, elbow",
    ),
    ('"elbow"]', '"wrist_elbow"]', "arms[0].joints: 'wrist_elbow' mimics another joint and cannot be driven"),
    ('"elbow"]', '"shoulder"]', "arms[0]: joints must differ from each other, got base_yaw, shoulder, shoulder"),
    (
        "velocity = [2.5, 2.5, 3.5]",
        "velocity = [2.5, 2.5]",
        "arms[0]: velocity must hold one number per joint (3), got 2",
    ),
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
    (
        'tool_frame = "tool"',
        'tool_frame = "tool"\nmotor_force = [1.0]',
        "arms[0]: motor_force must hold one number per joint",
    ),
    ('"finger_right"]', '"thumb"]', "arms[0].joints: no movable joint 'thumb' in three_dof.urdf; it has base_yaw,"),
    ('"finger_right"]', '"elbow"]', "arms: joint 'elbow' is used more than once; every joint belongs to one arm"),
    (
        FORCE,
        f'pads = ["left_finger", "pad"]\n{FORCE}',
        "arms[0].gripper.pads: no link 'pad' in three_dof.urdf; it has base,",
    ),
    (FORCE, f'approach = "y"\n{FORCE}', "arms[0].gripper: approach and closing must be different axes, got y and y"),
    (FORCE, f'approach = "-y"\n{FORCE}', "arms[0].gripper: approach and closing must be different axes, got -y and y"),
    (
        FORCE,
        f'approach = "up"\n{FORCE}',
        "arms[0].gripper.approach: Input should be 'x', 'y', 'z', '-x', '-y' or '-z'; got",
    ),
    ("max_opening = 0.048\n", "", "arms[0].gripper: give max_opening [m], or the joints' open positions in open"),
    (LAST, f"{LAST}\n[locked]\nhip = 0.0", "locked: no movable joint 'hip' in three_dof.urdf; it has base_yaw,"),
    (LAST, f"{LAST}\n[locked]\nelbow = 0.5", "locked: 'elbow' is driven by an arm; leave it out"),
    (LAST, f"{LAST}\n[locked]\nwrist_yaw = 2.0", "locked: wrist_yaw must be in -1.6..1.6, got 2.0"),
    (
        LAST,
        f'{LAST}\n[collision]\nignore = [["base", "leg"]]',
        "collision.ignore: no link 'leg' in three_dof.urdf; it has",
    ),
    (LAST, f'{LAST}\n[collision]\nignore = [["base"]]', "collision.ignore[0]: Tuple should have at least 2 items"),
    (LAST, f'{LAST}\n[cameras.eye]\nlink = "head"', "cameras.eye.link: no link 'head' in three_dof.urdf; it has base,"),
    (
        LAST,
        f'{LAST}\n[cameras.eye]\nlink = "rod"\nsensor = "pinhole"',
        "cameras.eye.sensor: Input should be 'kinect2' or",
    ),
    (LAST, f"{LAST}\n{DRIVE}", "drive.wheels: no movable joint 'wheel_l' in three_dof.urdf; it has base_yaw,"),
    (LAST, f"{LAST}\n{ROLLS}", "drive.rollers: no link 'caster' in three_dof.urdf; it has base, turret"),
    (LAST, f"{LAST}\n{DRIVE.replace('0.1', '0')}", "drive.wheel_radius: Input should be greater than 0; got 0"),
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


def test_arms_of_one_name_are_refused(spoiled: Callable[..., Path]) -> None:
    folder = spoiled("[[arms]]", "[[arms]]")
    file = folder / "robot.toml"
    text = file.read_text(encoding="utf-8")
    second = text[text.index("[[arms]]") :]
    file.write_text(text + "\n" + second, encoding="utf-8")
    with pytest.raises(RobotError, match=r"robot.toml: arms: names must differ from each other, got arm, arm"):
        load_robot(folder)
    file.write_text(text + "\n" + second.replace("[[arms]]", '[[arms]]\nname = "other"'), encoding="utf-8")
    with pytest.raises(RobotError, match=r"robot.toml: arms: joint 'base_yaw' is used more than once"):
        load_robot(folder)
