"""What hands pull at their wrists: weight, inertia, loads and contacts, about the right joint."""

import numpy as np
import pytest

from robots import Pose, RobotModel, load_robot
from robots.hand_dynamics import HandDynamics, Load
from robots.kinematics import whole_model
from robots.pose import FloatArray

GRAVITY = 9.81
ROBOTS = ("three_dof", "baxter", "mico_segway")


def wrench_at(
    robot: RobotModel,
    arm: str,
    dq: FloatArray | None = None,
    base: Pose | None = None,
    twist: FloatArray | None = None,
    acceleration: FloatArray | None = None,
    loads: tuple[Load, ...] = (),
    contacts: tuple[tuple[FloatArray, FloatArray], ...] = (),
) -> FloatArray:
    """The wrench at home, with joint velocities (n,) and no joint accelerations."""
    dynamics = HandDynamics(robot)
    speeds = np.zeros(len(robot.joint_names)) if dq is None else dq
    joints = {
        name: (q, speed, 0.0) for name, q, speed in zip(robot.joint_names, robot.home.tolist(), speeds, strict=True)
    }
    for each in robot.arms.values():
        joints |= {name: (q, 0.0, 0.0) for name, q in zip(each.gripper.joints, each.gripper.open.tolist(), strict=True)}
    still = np.zeros(6)
    dynamics.move(
        joints,
        robot.pose_base_in_world if base is None else base,
        still if twist is None else twist,
        still if acceleration is None else acceleration,
    )
    return dynamics.wrench(arm, loads, contacts)


def hand_mass(robot: RobotModel, arm: str) -> float:
    """Of everything behind the last movable joint before the tool [kg]."""
    model = whole_model(robot.urdf_path)
    wrist = model.frames[model.getFrameId(robot.arms[arm].tool_frame)].parentJoint
    return float(sum(model.inertias[j].mass for j in range(1, model.njoints) if wrist in list(model.supports[j])))


@pytest.mark.parametrize("name", ROBOTS)
def test_a_hand_at_rest_pulls_its_weight_downwards(name: str) -> None:
    robot = load_robot(name)
    for arm in robot.arms:
        force = wrench_at(robot, arm)[:3]
        np.testing.assert_allclose(force, [0.0, 0.0, -GRAVITY * hand_mass(robot, arm)], atol=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_turned_base_turns_torques_but_not_the_weight(name: str) -> None:
    robot = load_robot(name)
    arm = next(iter(robot.arms))
    straight = wrench_at(robot, arm)
    half = np.pi / 4
    turned = wrench_at(robot, arm, base=Pose(np.array([3.0, -2.0, 1.0]), np.array([0, 0, np.sin(half), np.cos(half)])))
    np.testing.assert_allclose(turned[:3], straight[:3], atol=1e-9)
    np.testing.assert_allclose(turned[3:], [-straight[4], straight[3], straight[5]], atol=1e-9)


def test_an_accelerated_base_pulls_the_hand_along() -> None:
    robot = load_robot("mico_segway")
    arm = next(iter(robot.arms))
    mass = hand_mass(robot, arm)
    pulled = wrench_at(robot, arm, acceleration=np.array([0.5, -0.2, 0.0, 0, 0, 0]))
    np.testing.assert_allclose(pulled[:3], mass * np.array([-0.5, 0.2, -GRAVITY]), atol=1e-9)


def test_a_base_that_turns_steadily_throws_the_hand_outwards() -> None:
    """The base turns about itself without an acceleration of its frame; so does one that also rolls along a circle."""
    robot = load_robot("mico_segway")
    arm = next(iter(robot.arms))
    rate = 0.8
    load = Load(2.0, np.array([0.9, 0.3, 0.4]), np.zeros((3, 3)))
    out = load.centre - robot.pose_base_in_world.position
    spin = np.array([0, 0, 0, 0, 0, rate])
    with_load = wrench_at(robot, arm, twist=spin, loads=(load,))
    without = wrench_at(robot, arm, twist=spin)
    expected = load.mass * np.array([rate**2 * out[0], rate**2 * out[1], -GRAVITY])
    np.testing.assert_allclose((with_load - without)[:3], expected, atol=1e-9)
    # Rolling: the frame's own acceleration is rate x velocity, and comes on top.
    velocity = np.array([0.3, 0.0, 0.0])
    rolling = np.concatenate((velocity, spin[3:]))
    inwards = np.concatenate((np.cross(spin[3:], velocity), np.zeros(3)))
    rolled = wrench_at(robot, arm, twist=rolling, acceleration=inwards, loads=(load,))
    bare = wrench_at(robot, arm, twist=rolling, acceleration=inwards)
    np.testing.assert_allclose((rolled - bare)[:3], expected - load.mass * inwards[:3], atol=1e-9)


@pytest.mark.parametrize("name", ROBOTS)
def test_a_load_adds_its_weight_where_it_is(name: str) -> None:
    robot = load_robot(name)
    arm = next(iter(robot.arms))
    centre = robot.arms[arm].forward_kinematics(robot.home[robot.slice_of(arm)]).position
    one = wrench_at(robot, arm, loads=(Load(0.4, centre, 1e-4 * np.eye(3)),))
    other = wrench_at(robot, arm, loads=(Load(0.4, centre + [0.1, 0.0, 0.0], 1e-4 * np.eye(3)),))
    np.testing.assert_allclose((one - wrench_at(robot, arm))[:3], [0, 0, -0.4 * GRAVITY], atol=1e-9)
    np.testing.assert_allclose((other - one)[3:], np.cross([0.1, 0, 0], [0, 0, -0.4 * GRAVITY]), atol=1e-9)


def test_a_contact_acts_like_a_weight_at_its_point() -> None:
    robot = load_robot("baxter")
    point, weight = np.array([0.7, 0.2, 0.1]), np.array([0.0, 0.0, -0.3 * GRAVITY])
    hanging = wrench_at(robot, "left", loads=(Load(0.3, point, np.zeros((3, 3))),))
    pushed = wrench_at(robot, "left", contacts=((point, weight),))
    np.testing.assert_allclose(pushed, hanging, atol=1e-9)
    np.testing.assert_array_equal(wrench_at(robot, "right", contacts=()), wrench_at(robot, "right"))


def test_a_turning_wrist_throws_an_uneven_load_outwards() -> None:
    """Turned about a vertical last joint, a point mass beside the axis pulls with m w^2 r."""
    robot = load_robot("three_dof")  # its base yaw turns all of the arm about the world's vertical
    arm = next(iter(robot.arms))
    rate = 1.3
    centre = np.array([0.25, 0.30, 0.2])
    load = Load(0.5, centre, np.zeros((3, 3)))
    dq = np.array([rate, 0.0, 0.0])
    # The wrist turns back as the base turns, so that the hand only translates, on the circle of its joint.
    axis = robot.pose_base_in_world.position
    tool = robot.forward_kinematics(robot.home).position - axis
    pulled = wrench_at(robot, arm, dq=dq, loads=(load,)) - wrench_at(robot, arm, dq=dq)
    expected = 0.5 * np.array([rate**2 * tool[0], rate**2 * tool[1], -GRAVITY])
    np.testing.assert_allclose(pulled[:3], expected, atol=1e-9)
