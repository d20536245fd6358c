"""The URDF as it is used: made once, kept in the cache, with meshes that both libraries find."""

import shutil
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from robots import RobotError, RobotModel, load_robot
from robots.prepared_urdf import prepare_urdf
from robots.robot_file import RobotFile, read_robot_file

from .bullet_robot import BulletRobot

BOX = '<collision><origin xyz="0 0 0.05"/><geometry><box size="0.08 0.08 0.10"/></geometry></collision>'
MESHED = (
    '<collision><origin xyz="0 0 0.05"/><geometry><mesh filename="{}" scale="0.08 0.08 0.1"/></geometry></collision>'
)
TOOL = (
    '<inertial><mass value="0.001"/>'
    '<inertia ixx="0.000001" iyy="0.000001" izz="0.000001" ixy="0" ixz="0" iyz="0"/></inertial>'
)


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "cache" / "showtell" / "robots"


@pytest.fixture
def meshed(spoiled: Callable[..., Path]) -> Callable[[str], Path]:
    """The board arm with its turret as a mesh: a box of 1 m, scaled."""

    def make(filename: str = "turret.stl") -> Path:
        folder = spoiled(BOX, MESHED.format(filename), "three_dof.urdf")
        trimesh.creation.box((1, 1, 1)).export(folder / "turret.stl")
        return folder

    return make


def prepared(folder: Path) -> Path:
    return prepare_urdf(folder, read_robot_file(folder / "robot.toml"))


def meshes(urdf: Path) -> list[Path]:
    return [Path(mesh.get("filename", "")) for mesh in ElementTree.parse(urdf).getroot().iter("mesh")]


def test_a_urdf_that_needs_nothing_is_used_where_it_is(arm: RobotModel, cache: Path) -> None:
    assert prepared(arm.folder) == arm.folder / "three_dof.urdf"
    assert not cache.exists()


def test_packages_are_found_and_meshes_thinned(cache: Path) -> None:
    folder = load_robot("baxter").folder
    urdf = prepared(folder)
    assert urdf.parent == cache and urdf.name.startswith("baxter-")
    assert "package://" not in urdf.read_text(encoding="utf-8")
    files = meshes(urdf)
    assert len(files) > 40
    assert all(file.is_absolute() and file.is_file() for file in files)


def test_it_is_made_once(meshed: Callable[..., Path], cache: Path) -> None:
    folder = meshed()
    urdf = prepared(folder)
    made = urdf.stat().st_mtime_ns
    assert prepared(folder) == urdf
    assert urdf.stat().st_mtime_ns == made
    assert list(cache.iterdir()) == [urdf]


def test_it_changes_with_the_mounting_and_with_the_urdf(meshed: Callable[..., Path], cache: Path) -> None:
    folder = meshed()
    spec = read_robot_file(folder / "robot.toml")

    def mounted(mounting: float) -> RobotFile:
        gripper = spec.arms[0].gripper.model_copy(update={"mounting": mounting})
        return spec.model_copy(update={"arms": (spec.arms[0].model_copy(update={"gripper": gripper}),)})

    paths = [prepare_urdf(folder, mounted(value)) for value in (0.0, 0.002, 0.004)]
    assert len(set(paths)) == 3
    joint = ElementTree.parse(paths[1]).getroot().find("joint[@name='finger_right']/origin")
    assert joint is not None
    # The right finger slides along -y.
    np.testing.assert_allclose([float(part) for part in joint.get("xyz", "").split()], [0, -0.002, -0.34], atol=1e-9)
    text = (folder / "three_dof.urdf").read_text(encoding="utf-8")
    (folder / "three_dof.urdf").write_text(text.replace('lower="0.2" upper="2.9"', 'lower="0.3" upper="2.9"'))
    assert prepared(folder) not in paths


def test_a_scaled_mesh_is_felt_as_large_as_the_box_it_stands_for(
    arm: RobotModel, meshed: Callable[..., Path], cache: Path
) -> None:
    robot = load_robot(meshed())
    for one in (arm, robot):
        with BulletRobot(one) as bullet:
            bullet.place(one.expand(one.home))
            box = bullet.add_box(np.array([0.1, 0.1, 0.1]), one.pose_base_in_world.position + [0.0, 0.2, 0.60])
            # Bullet puts a margin of up to 1 mm round a hull.
            assert bullet.distances(box)["turret"] == pytest.approx(0.11, abs=0.0015)


def test_a_cache_that_cannot_be_written_falls_back_to_a_folder_of_this_process(
    meshed: Callable[..., Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    robot = load_robot(meshed())
    assert "showtell-robots-" in str(robot.urdf_path.parent)
    assert robot.urdf_path.is_file()


@pytest.mark.parametrize(
    ("filename", "message"),
    [
        ("none.stl", "three_dof.urdf: link 'turret': mesh none.stl is missing: put the file there or correct the name"),
        (
            "package://no_such/turret.stl",
            "link 'turret': mesh package://no_such/turret.stl is missing: install the package",
        ),
        ("package://bot/none.stl", "three_dof.urdf: link 'turret': mesh package://bot/none.stl is missing"),
    ],
)
def test_a_missing_mesh_is_named(meshed: Callable[..., Path], cache: Path, filename: str, message: str) -> None:
    folder = meshed(filename)
    with pytest.raises(RobotError) as caught:
        load_robot(folder)
    assert message in str(caught.value) and str(caught.value).startswith(str(folder / "three_dof.urdf"))
    assert "\n" not in str(caught.value)


def test_a_package_beside_the_urdf_is_found(meshed: Callable[..., Path], cache: Path) -> None:
    robot = load_robot(meshed("package://bot/turret.stl"))  # the folder is called so
    assert all(file.is_file() for file in meshes(robot.urdf_path))


def test_a_missing_urdf_of_a_package_is_named(spoiled: Callable[..., Path]) -> None:
    folder = spoiled('urdf = "three_dof.urdf"', 'urdf = "package://no_such/arm.urdf"')
    with pytest.raises(
        RobotError, match=r"robot.toml: urdf: package://no_such/arm.urdf is missing: install the package"
    ):
        load_robot(folder)


def test_what_is_wrong_is_told_of_the_users_file(meshed: Callable[..., Path], cache: Path) -> None:
    folder = meshed()
    urdf = folder / "three_dof.urdf"
    urdf.write_text(
        urdf.read_text(encoding="utf-8").replace('<mass value="0.35"/>', '<mass value="-1"/>'), encoding="utf-8"
    )
    with pytest.raises(RobotError, match=r"bot/three_dof.urdf: link rod: mass must be positive, got -1 kg"):
        load_robot(folder)
    assert not cache.exists()


def test_a_link_without_mass_gets_hardly_any_in_our_copy_only(meshed: Callable[..., Path], cache: Path) -> None:
    folder = meshed()
    urdf = folder / "three_dof.urdf"
    text = urdf.read_text(encoding="utf-8")
    assert TOOL in text
    urdf.write_text(text.replace(TOOL, ""), encoding="utf-8")
    before = urdf.read_text(encoding="utf-8")
    robot = load_robot(folder)
    with BulletRobot(robot) as bullet:
        assert bullet.mass("tool") == pytest.approx(1e-6)  # PyBullet would give it 1 kg
        assert bullet.mass("rod") == pytest.approx(0.35)
    assert urdf.read_text(encoding="utf-8") == before


def test_a_copied_robot_folder_still_works(cache: Path, tmp_path: Path) -> None:
    mico = load_robot("mico_segway")
    copied = Path(shutil.copytree(mico.folder, tmp_path / "elsewhere"))
    robot = load_robot(copied)
    assert str(robot.urdf_path).startswith(str(cache))
    np.testing.assert_array_equal(
        robot.forward_kinematics(robot.home).position, mico.forward_kinematics(mico.home).position
    )
    assert sys.prefix not in (copied / "mico_segway.urdf").read_text(encoding="utf-8")
