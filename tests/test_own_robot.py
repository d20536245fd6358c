"""The arm that docs/own-robot.md brings is no different from ours: kinematics, plans, physics, pictures, messages."""

import re
from pathlib import Path

import numpy as np
import pytest
from pydantic import BaseModel

from executor.cli import app
from robots import CollisionModel, Obstacle, Pose, RobotError, RobotModel, load_robot
from robots.kinematics import rotation_matrix
from robots.robot_file import (
    ArmSection,
    CameraSection,
    CollisionSection,
    DriveSection,
    GripperSection,
    PoseSection,
    RobotFile,
)
from robots.trajectories import JointLimits, check_limits, plan_motion
from twin import JointCommand, ObjectSpec, SceneSpec, World
from twin.board import cell_centre

from .robots.bullet_robot import BulletRobot

DOCS = Path(__file__).resolve().parent.parent / "docs"
PAGE = (DOCS / "own-robot.md").read_text(encoding="utf-8")
(FILE,) = re.findall(r"```toml\n(.*?)```", PAGE, flags=re.DOTALL)
SNIPPETS = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
DOWN = np.array([1.0, 0.0, 0.0, 0.0])


def write(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "robot.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write(tmp_path_factory.mktemp("own") / "panda", FILE)


@pytest.fixture(scope="module")
def panda(folder: Path) -> RobotModel:
    return load_robot(folder)


def limits(robot: RobotModel) -> JointLimits:
    return JointLimits(robot.lower, robot.upper, robot.velocity, robot.acceleration, robot.jerk)


def test_every_key_is_explained() -> None:
    rows = re.findall(r"^\| (`.+?`)(?: \*)? \|", PAGE, flags=re.MULTILINE)
    explained = {key for row in rows for key in re.findall(r"`([^`]+)`", row)}

    def keys(model: type[BaseModel], prefix: str = "") -> set[str]:
        return {prefix + name for name in model.model_fields}

    wanted = keys(RobotFile) - {"base", "arms", "drive", "collision", "cameras", "locked"}
    wanted |= keys(PoseSection, "base.") | keys(ArmSection) - {"gripper"} | keys(GripperSection) | {"locked.JOINT"}
    wanted |= keys(CollisionSection, "collision.") | keys(CameraSection, "cameras.NAME.") | keys(DriveSection, "drive.")
    assert {key for key in explained if "=" not in key} >= wanted
    assert "`[arms.gripper]`" in PAGE


def test_its_kinematics_are_pybullets(panda: RobotModel) -> None:
    rng = np.random.default_rng(0)
    with BulletRobot(panda) as bullet:
        for q in rng.uniform(panda.lower, panda.upper, (100, 7)):
            gap = rng.uniform(0, 0.08)
            bullet.place(panda.expand(q, {"arm": gap}))
            pose, there = panda.forward_kinematics(q), bullet.frame("panda_hand_tcp")
            # PyBullet reads the URDF's numbers with its own rounding.
            np.testing.assert_allclose(pose.position, there.position, atol=1e-6)
            turns = [rotation_matrix(each.orientation_xyzw) for each in (pose, there)]
            np.testing.assert_allclose(turns[0], turns[1], atol=1e-6)
            # The tips' faces are modelled 0.02 mm inside of the plane in which they meet; Bullet is as exact.
            assert bullet.between("panda_leftfinger", "panda_rightfinger") == pytest.approx(gap, abs=1e-4)


def test_it_reaches_what_it_can_reach(panda: RobotModel) -> None:
    rng, found = np.random.default_rng(1), 0
    for q in rng.uniform(panda.lower, panda.upper, (100, 7)):
        result = panda.inverse_kinematics(panda.forward_kinematics(q))
        found += result.success
        if result.success:
            assert np.all(panda.lower <= result.q) and np.all(result.q <= panda.upper)
            assert result.error < 1e-5 and result.orientation_error < 1e-4
    assert found >= 99
    too_far = panda.inverse_kinematics(np.array([2.0, 0.0, 0.5]))
    assert not too_far.success and too_far.reason


def test_it_plans_around_a_wall_within_its_limits(panda: RobotModel) -> None:
    table = Obstacle("table", "box", (1.2, 1.2, 0.1), Pose(np.array([0.2, 0.2, -0.05]), np.array([0, 0, 0, 1.0])))
    wall = Obstacle("wall", "box", (0.3, 0.02, 0.35), Pose(np.array([0.2, 0.2, 0.176]), np.array([0, 0, 0, 1.0])))
    model = CollisionModel(panda, [table, wall])
    start, goal = (
        panda.inverse_kinematics(Pose(np.array([0.2, y, 0.1]), DOWN), start=panda.home) for y in (-0.02, 0.42)
    )
    assert start.success and goal.success
    plan = plan_motion(start.q, goal.q, limits(panda), model.free, np.random.default_rng(0))
    assert plan.success, plan.reason
    assert plan.trajectory is not None and not plan.way.straight
    samples = plan.trajectory.sample(0.01)
    assert check_limits(plan.trajectory, limits(panda)).worst <= 1 + 1e-6
    assert all(model.free(q) for q in samples.position)
    np.testing.assert_allclose(samples.position[-1], goal.q, atol=1e-6)


def test_it_picks_a_cube_from_the_board(panda: RobotModel, folder: Path) -> None:
    cube = ObjectSpec(id=7, shape="cube", colour="red", position=tuple(cell_centre(5, 1, 0)))
    rng = np.random.default_rng(0)
    with World.from_scene(SceneSpec(objects=(cube,)), robot=folder) as world:
        np.testing.assert_allclose(world.state().q, panda.home, atol=1e-3)
        assert world.state().gripper_opening == pytest.approx(0.08, abs=1e-4)

        def go(height: float, opening: float) -> None:
            start = world.commanded_positions
            target = Pose(np.array(cube.position) + [0, 0, height], DOWN)
            found = panda.inverse_kinematics(target, start=start)
            assert found.success, found.reason
            near = CollisionModel(panda, world.obstacles(without=[7]))
            plan = plan_motion(start, found.q, limits(panda), near.free, rng)
            assert plan.success and plan.trajectory is not None, plan.reason
            positions = plan.trajectory.sample(World.DT).position
            for velocity in np.diff(positions, axis=0, append=positions[-1:]) / World.DT:
                world.step(JointCommand(velocity, opening))

        go(0.12, 0.08)
        go(0.0, 0.08)
        for _ in range(120):
            world.step(JointCommand(np.zeros(7), 0.0))
        go(0.20, 0.0)
        state = world.state()
        assert state.held == 7
        held = state.objects[0].pose_object_in_world.position
        # It is lifted as far as the tool; friction alone lets it slip by less than 2 mm.
        np.testing.assert_allclose(held, np.array(cube.position) + [0, 0, 0.20], atol=0.002)


@pytest.mark.parametrize("scene", ["board", "tabletop"])
def test_scenes_take_its_path(scene: str, folder: Path) -> None:
    with World.from_scene(scene, robot=folder, seed=3) as world:
        assert not world.touches()
        for _ in range(120):
            world.step(JointCommand(np.zeros(7), 0.0))
        state = world.state()
        assert state.gripper_closed and state.gripper_opening == pytest.approx(0.0, abs=1e-4)
        # The drives hold it: it does not sag.
        np.testing.assert_allclose(state.q, world.robot.home, atol=1e-3)


def test_snippets_run(folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(folder.parent)
    names: dict[str, object] = {}
    for snippet in SNIPPETS:
        exec(compile(snippet, "own-robot.md", "exec"), names)
    first, second = capsys.readouterr().out.splitlines()[-2:]
    assert first.startswith("True Nearest(distance=") and " True " in first
    assert float(second) == pytest.approx(0.0, abs=1e-4)


def test_pictures_of_the_page_are_there() -> None:
    for path in re.findall(r"!\[[^\]]*\]\(([^)]+)\)", PAGE):
        assert (DOCS / path).is_file()


def test_the_command_lists_and_draws_it(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "showtell robots panda --picture panda.png" in PAGE
    picture = tmp_path / "panda.png"
    app(["robots", str(folder), "--picture", str(picture)], standalone_mode=False)
    out = capsys.readouterr().out
    assert "gripper holds 0 to 80 mm" in out and "panda_joint7" in out
    from PIL import Image

    pixels = np.asarray(Image.open(picture)).astype(int)
    # The arm, white and black, stands out from the grey around it.
    assert (np.abs(pixels - pixels[0, 0]).max(axis=2) > 20).mean() > 0.05


PROMISED = re.findall(r"^\| (.+) \| `(.+)` \|$", PAGE.partition("## When something is wrong")[2], flags=re.MULTILINE)
MISTAKES = {
    "`jerk` left out": (re.search(r"jerk = .*\n", FILE).group(), ""),  # type: ignore[union-attr]
    '`colour = "white"` added at the top': ('name = "panda"', 'colour = "white"\nname = "panda"'),
    '`"panda_joint7"` written `"panda_joint8"`': ('"panda_joint7"', '"panda_joint8"'),
    "`home` starts with `3.0`": ("home = [0.0", "home = [3.0"),
    "`velocity` starts with `3.0`": ("velocity = [2.175", "velocity = [3.0"),
    "`max_opening = 0.1`": ("max_opening = 0.08", "max_opening = 0.1"),
    '`approach = "y"`': ('approach = "z"', 'approach = "y"'),
    '`urdf = "package://franka/panda.urdf"`': (
        re.search(r"urdf = .*", FILE).group(),  # type: ignore[union-attr]
        'urdf = "package://franka/panda.urdf"',
    ),
}


@pytest.mark.parametrize(("mistake", "message"), PROMISED)
def test_mistakes_get_the_messages_that_the_page_promises(mistake: str, message: str, tmp_path: Path) -> None:
    old, new = MISTAKES[mistake]
    assert FILE.count(old) == 1
    folder = write(tmp_path / "panda", FILE.replace(old, new))
    with pytest.raises(RobotError) as caught:
        load_robot(folder)
    assert str(caught.value).startswith(f"{folder}/robot.toml: {message.removesuffix('…')}")
    assert message.endswith("…") or str(caught.value) == f"{folder}/robot.toml: {message}"


def test_every_mistake_of_the_page_is_tried() -> None:
    assert {mistake for mistake, _ in PROMISED} == set(MISTAKES)
