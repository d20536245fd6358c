"""Visuals: every shape triangulated, coloured and placed as the URDF says."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import trimesh

from robots import Pose, RobotError, load_robot
from robots.kinematics import whole_model
from robots.meshes import resolve
from robots.visuals import RobotVisuals

HERE = Pose(np.zeros(3), np.array([0.0, 0.0, 0.0, 1.0]))

MACHINE = """<robot name="machine">
  <material name="paint"><color rgba="0.1 0.2 0.3 1"/></material>
  <link name="base">
    <visual><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><geometry><box size="1 2 3"/></geometry>
      <material name="paint"/></visual>
    <visual><geometry><sphere radius="0.5"/></geometry>
      <material name="own"><color rgba="0.9 0.8 0.7 1"/></material></visual>
    <visual><geometry><box size="1 1 1"/></geometry><material name="glass"><color rgba="1 1 1 0"/></material></visual>
  </link>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="disc"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/></joint>
  <link name="disc">
    <visual><geometry><cylinder radius="0.2" length="0.1"/></geometry></visual>
    <visual><geometry><capsule radius="0.1" length="0.4"/></geometry></visual>
  </link>
  <joint name="slide" type="prismatic"><parent link="disc"/><child link="tip"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="1" velocity="1" effort="1"/></joint>
  <link name="tip">
    <visual><geometry><mesh filename="cube.stl" scale="1 2 -3"/></geometry><material name="paint"/></visual>
  </link>
  <joint name="shadow" type="prismatic"><parent link="base"/><child link="twin"/><axis xyz="0 1 0"/>
    <limit lower="-5" upper="5" velocity="1" effort="1"/><mimic joint="slide" multiplier="-2" offset="0.1"/></joint>
  <link name="twin"><visual><geometry><sphere radius="0.001"/></geometry></visual></link>
</robot>
"""


@pytest.fixture
def machine(tmp_path: Path) -> Callable[..., Path]:
    """The machine as a file, with a piece of text replaced."""

    def write(old: str = "", new: str = "") -> Path:
        assert old in MACHINE
        trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "cube.stl")
        path = tmp_path / "machine.urdf"
        path.write_text(MACHINE.replace(old, new) if old else MACHINE, encoding="utf-8")
        return path

    return write


def test_primitives_have_their_size_place_and_colour(machine: Callable[..., Path]) -> None:
    visuals = RobotVisuals(machine()).visuals
    assert [visual.link for visual in visuals] == ["base", "base", "disc", "disc", "tip", "twin"]
    box, ball, cylinder, capsule, cube, _ = (visual.mesh for visual in visuals)
    # A quarter turn about z swaps x and y; 1 m up.
    np.testing.assert_allclose(box.vertices.min(axis=0), [-1, -0.5, -0.5], atol=1e-12)
    np.testing.assert_allclose(box.vertices.max(axis=0), [1, 0.5, 2.5], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices, axis=1), 0.5, atol=1e-12)
    np.testing.assert_allclose(cylinder.vertices.max(axis=0), [0.2, 0.2, 0.05], atol=1e-12)
    np.testing.assert_allclose(capsule.vertices.max(axis=0), [0.1, 0.1, 0.3], atol=1e-3)  # 32 faces around
    np.testing.assert_allclose(capsule.vertices.min(axis=0), [-0.1, -0.1, -0.3], atol=1e-3)
    np.testing.assert_allclose(cube.vertices.max(axis=0), [0.05, 0.1, 0.15], atol=1e-9)  # STL is in single precision
    colours = [visual.mesh.colours for visual in visuals]
    np.testing.assert_allclose(colours[0][0], [0.1, 0.2, 0.3])  # type: ignore[index]
    np.testing.assert_allclose(colours[1][0], [0.9, 0.8, 0.7])  # type: ignore[index]
    np.testing.assert_allclose(colours[2][0], [0.8, 0.8, 0.8])  # type: ignore[index]
    np.testing.assert_allclose(colours[4][0], [0.1, 0.2, 0.3])  # type: ignore[index]


def test_links_move_with_their_joints(machine: Callable[..., Path]) -> None:
    visuals = RobotVisuals(machine())
    base = Pose(np.array([0.0, 0.0, 5.0]), np.array([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]))  # a quarter turn about z
    placed = visuals.placements({"wheel": np.pi / 2, "slide": 0.25}, base)
    assert placed.shape == (6, 4, 4)
    np.testing.assert_allclose(placed[0][:3, 3], [0, 0, 5], atol=1e-12)
    # In the base the disc is at (1, 0) and turned by a quarter: the tip is at (1, 0.25); then the base's turn.
    np.testing.assert_allclose(placed[2][:3, 3], [0, 1, 5], atol=1e-12)
    np.testing.assert_allclose(placed[4][:3, 3], [-0.25, 1, 5], atol=1e-12)
    np.testing.assert_allclose(placed[4][:3, :3], [[-1, 0, 0], [0, -1, 0], [0, 0, 1]], atol=1e-12)
    # The mimicking joint follows: -2 * 0.25 + 0.1 along y of the base.
    np.testing.assert_allclose(placed[5][:3, 3], [0.4, 0, 5], atol=1e-12)
    still = visuals.placements({}, HERE)
    np.testing.assert_allclose(still[4], [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]], atol=1e-12)


def test_positions_must_be_known_and_finite(machine: Callable[..., Path]) -> None:
    visuals = RobotVisuals(machine())
    with pytest.raises(RobotError, match="no movable joint 'elbow'; it has wheel, slide, shadow"):
        visuals.placements({"elbow": 1.0}, HERE)
    with pytest.raises(RobotError, match="joint slide: position must be a finite number, got nan"):
        visuals.placements({"slide": float("nan")}, HERE)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("cube.stl", "gone.stl", r"machine\.urdf: link 'tip': mesh gone\.stl is missing"),
        ('size="1 2 3"', 'size="1 2"', r"link 'base': visual: <box> size must be 3 finite number\(s\), got '1 2'"),
        ('size="1 2 3"', 'size="1 2 inf"', "must be 3 finite"),
        ('<cylinder radius="0.2"', "<cylinder", r"<cylinder> radius must be 1 finite number\(s\), got None"),
        ('<sphere radius="0.5"/>', "<cone/>", "one of box, capsule, cylinder, mesh, sphere; got cone"),
        ('<sphere radius="0.5"/>', "", "got nothing"),
        ('rgba="0.9 0.8 0.7 1"', 'rgba="red"', "<color> rgba must be 4 finite"),
    ],
)
def test_wrong_visuals_are_refused(machine: Callable[..., Path], old: str, new: str, message: str) -> None:
    with pytest.raises(RobotError, match=message):
        RobotVisuals(machine(old, new))


def test_baxter_is_light_and_where_pinocchio_puts_it() -> None:
    robot = load_robot("baxter")
    visuals = RobotVisuals(robot.urdf_path)
    assert sum(len(visual.mesh.faces) for visual in visuals.visuals) < 25_000
    source = resolve("package://example-robot-data/robots/baxter_description/urdf/baxter.urdf", robot.urdf_path, "urdf")
    model = whole_model(source)
    data = model.createData()
    q = pin.neutral(model)
    q[model.joints[model.getJointId("left_e1")].idx_q] = 0.75
    pin.framesForwardKinematics(model, data, q)
    placed = visuals.placements({"left_e1": 0.75}, HERE)
    for visual, pose in zip(visuals.visuals, placed, strict=True):
        if "gripper" not in visual.link:  # our fingers are mounted elsewhere
            expected = data.oMf[model.getFrameId(visual.link, pin.FrameType.BODY)].homogeneous
            np.testing.assert_allclose(pose, expected, atol=1e-12)
