"""What physics cannot work with is refused before it gets there, by file, link or joint, and value."""

import math
from collections.abc import Callable
from pathlib import Path

import pytest

from robots import RobotError, list_robots, load_robot
from robots.urdf import Mimic, read_urdf

ROD = '<mass value="0.35"/><inertia ixx="0.0027"'
YAW = '<origin xyz="0 0 0.49"/><axis xyz="0 0 1"/>'
ARM = '<geometry><box size="0.44 0.05 0.05"/></geometry>'
FOLLOWS = '<mimic joint="elbow" multiplier="-1"'
WRONG = [
    (ROD, ROD.replace("0.35", "-0.35"), "link rod: mass must be positive, got -0.35 kg"),
    (ROD, ROD.replace("0.35", "0"), "link rod: mass must be positive, got 0 kg"),
    (ROD, ROD.replace("0.35", "heavy"), "link rod: mass value must be a number, got 'heavy'"),
    (ROD, ROD.replace("0.35", "nan"), "link rod: mass value must be finite, got 'nan'"),
    (ROD, ROD.replace("0.0027", "inf"), "link rod: inertia ixx must be finite, got 'inf'"),
    (ROD, ROD.replace("0.0027", "-0.0027"), "link rod: the inertia's principal moments must be positive, got -0.0027,"),
    (ROD, ROD.replace("0.0027", "0"), "link rod: the inertia's principal moments must be positive, got 0, 0.0001,"),
    ('izz="0.0001" ixy="0"', 'izz="0.0001" ixy="0.1"', "link rod: the inertia's principal moments must be positive"),
    ('lower="0.2" upper="2.9"', 'lower="3.2" upper="2.9"', "joint elbow: lower limit 3.2 is above the upper one 2.9"),
    ('lower="0.2" upper="2.9"', 'lower="nan" upper="2.9"', "joint elbow: lower must be a number, got 'nan'"),
    ('upper="2.9" velocity="3.5"', 'upper="2.9" velocity="x"', "joint elbow: velocity must be a number, got 'x'"),
    ('<parent link="upper_arm"/>', '<parent link="arm"/>', "joint elbow: parent link 'arm' is not in the file; it has"),
    ('<child link="forearm"/>', "", "joint elbow: child link '' is not in the file; it has base, turret, upper_arm"),
    ('<mimic joint="elbow"', '<mimic joint="knee"', "joint wrist_elbow: mimics 'knee', which is no movable joint"),
    (
        'name="elbow" type="revolute"',
        'name="elbow" type="hinge"',
        "joint elbow: type must be one of revolute, prismatic,",
    ),
    ('name="elbow" type="revolute"', 'name="shoulder" type="revolute"', "joint shoulder: there are 2 of this name"),
    ('<link name="wrist_a">', '<link name="forearm">', "link forearm: there are 2 of this name"),
    ('<link name="wrist_a">', "<link>", "a link has no name"),
    ('<child link="forearm"/>', '<child link="base"/>', "link base: carries itself, through base, turret, upper_arm"),
    ('<child link="forearm"/>', '<child link="turret"/>', "link turret: both base_yaw and elbow carry it"),
    ('<link name="forearm">', '<link name="table"/><link name="forearm">', "nothing carries base, table"),
    (YAW, YAW.replace("0 0 1", "0 0 0"), "joint base_yaw: axis must have a direction, got '0 0 0'"),
    (YAW, YAW.replace("0 0 1", "0 1"), "joint base_yaw: xyz must be 3 finite numbers, got '0 1'"),
    (YAW, YAW.replace("0.49", "nan"), "joint base_yaw: xyz must be 3 finite numbers, got '0 0 nan'"),
    (ARM, ARM.replace("0.44 0.05 0.05", "0.44 0.05"), "link upper_arm: collision: box: size must be 3 finite numbers"),
    (
        ARM,
        ARM.replace("0.44", "-0.44"),
        "link upper_arm: collision: box: size must be positive [m], got '-0.44 0.05 0.05'",
    ),
    (
        ARM,
        "<geometry/>",
        "link upper_arm: collision: geometry must be one of box, cylinder, sphere, mesh, got 0",
    ),
    (
        ARM,
        '<geometry><sphere radius="x"/></geometry>',
        "link upper_arm: collision: sphere: radius must be a finite number",
    ),
    (ARM, ARM.replace("box", "cone"), "link upper_arm: collision: geometry must be one of box, cylinder, sphere, mesh"),
    (FOLLOWS, FOLLOWS.replace('"-1"', '"nan"'), "joint wrist_elbow: multiplier must be a number, got 'nan'"),
]


@pytest.mark.parametrize(("old", "new", "message"), WRONG)
def test_wrong_urdfs_are_named(spoiled: Callable[..., Path], old: str, new: str, message: str) -> None:
    folder = spoiled(old, new, "three_dof.urdf")
    with pytest.raises(RobotError) as caught:
        load_robot(folder)
    assert str(caught.value).startswith(f"{folder}/three_dof.urdf: ") and message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_another_file_is_no_urdf(tmp_path: Path) -> None:
    (tmp_path / "world.urdf").write_text("<sdf/>", encoding="utf-8")
    with pytest.raises(RobotError, match=r"world.urdf: the outermost element must be <robot>, got <sdf>"):
        read_urdf(tmp_path / "world.urdf")
    with pytest.raises(RobotError, match=r"none.urdf: cannot be read: No such file"):
        read_urdf(tmp_path / "none.urdf")


def test_frames_that_are_fixed_may_weigh_nothing(spoiled: Callable[..., Path]) -> None:
    tool = '<inertial><mass value="0.001"/><inertia ixx="0.000001" iyy="0.000001" izz="0.000001"'
    nothing = '<inertial><mass value="0"/><inertia ixx="0" iyy="0" izz="0"'
    assert load_robot(spoiled(tool, nothing, "three_dof.urdf")).name == "three_dof"


def test_continuous_joints_have_no_limits_whatever_the_file_says(spoiled: Callable[..., Path]) -> None:
    yaw = 'name="base_yaw" type="revolute"'
    robot = load_robot(spoiled(yaw, yaw.replace("revolute", "continuous"), "three_dof.urdf"))
    assert (robot.lower[0], robot.upper[0]) == (-math.inf, math.inf)


def test_a_mimicking_joint_stops_at_its_own_limits() -> None:
    mimic = Mimic("tip", "finger", -1.0, 0.5, 0.0, 2.0)
    assert [mimic.follow(value) for value in (0.2, 0.7, -3.0)] == [pytest.approx(0.3), 0.0, 2.0]


@pytest.mark.parametrize("name", list_robots())
def test_our_own_urdfs_pass(name: str) -> None:
    robot = load_robot(name)
    urdf = read_urdf(robot.urdf_path)
    assert set(robot.joint_names) <= set(urdf.joints)
    assert all(joint.child in urdf.links for joint in urdf.joints.values())
