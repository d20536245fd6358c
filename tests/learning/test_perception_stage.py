import dataclasses
from pathlib import Path

import numpy as np
import pytest

from learning.errors import PerceptionError
from learning.perception.camera_observation import Perceived
from learning.perception.observation import Observation
from learning.perception.observation_file import load_observation, save_observation
from learning.perception.stage import PerceivedDemo, observation_path, perceive_demos
from teleop import GamepadMapping, Recorder
from tests.learning.camera_demos import table
from twin import JointCommand, World

OBSERVATION = Observation(
    times=np.arange(2.0), gripper_location=np.zeros((2, 3)), gripper_closed=np.array([False, True]),
    object_ids=np.arange(1), location=np.ones((2, 1, 3)), colour=np.zeros((2, 1, 3)), shape=np.zeros((2, 1, 33)),
    extent=np.ones((2, 1, 3)), features={"weight": np.full((2, 1, 1), np.nan)},
)  # fmt: skip


@pytest.fixture(scope="module")
def demos(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two short demos of standing still, one of them of a robot without a camera, and a file that is none."""
    folder = tmp_path_factory.mktemp("demos")
    for name, robot in (("a", "mico_segway"), ("b", "three_dof")):
        things = (("small_red_can", 0.5, 0.0),) if robot == "mico_segway" else ()
        spec, path = table(*things, robot_name=robot), folder / f"{name}.mcap"
        with (
            World.from_scene(spec) as world,
            Recorder(path, spec, GamepadMapping(), 240, robot=world.robot) as recorder,
        ):
            for step in range(73):
                if step % 8 == 0:
                    recorder.state(step, world.state())
                world.step(JointCommand(np.zeros(len(world.robot.joint_names)), world.commanded_openings))
    (folder / "c.mcap").write_bytes(b"no demo")
    return folder


def test_an_observation_comes_back_from_its_file(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "x.npz"
    save_observation(path, Perceived(OBSERVATION, ("it left the table",)))
    back = load_observation(path)
    assert back.notes == ("it left the table",)
    for field in dataclasses.fields(Observation):
        if field.name not in ("features", "visible", "gripper_opening", "wrist_force"):
            assert np.array_equal(getattr(back.observation, field.name), getattr(OBSERVATION, field.name))
    assert back.observation.visible is None
    assert np.isnan(back.observation.features["weight"]).all()
    assert list(tmp_path.rglob("*.partial")) == []


def test_damaged_and_foreign_files_are_named(tmp_path: Path) -> None:
    path = tmp_path / "x.npz"
    with pytest.raises(PerceptionError, match="x.npz: cannot be read"):
        load_observation(path)
    save_observation(path, Perceived(OBSERVATION))
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(PerceptionError, match="x.npz: damaged"):
        load_observation(path)
    np.savez(path, times=np.zeros(3))
    with pytest.raises(PerceptionError, match="not an observation of this version"):
        load_observation(path)


def test_a_pass_perceives_what_it_can_tells_the_rest_and_finds_it_again(demos: Path, tmp_path: Path) -> None:
    paths = sorted(demos.glob("*.mcap"))
    told: list[PerceivedDemo] = []
    first = perceive_demos(paths, tmp_path, jobs=1, on_done=told.append)
    assert [bool(each.error) for each in first] == [False, True, True]
    assert "three_dof has no camera" in first[1].error
    assert "c.mcap" in first[2].error
    assert len(told) == 3
    assert first[0].frames == len(first[0].observation().observation.times)
    with pytest.raises(PerceptionError, match="three_dof has no camera"):
        first[1].observation()
    again = perceive_demos(paths[:1], tmp_path, jobs=1)
    assert again[0].cached and again[0].file == first[0].file
    assert first[0].file is not None
    first[0].file.write_bytes(b"cut short")
    assert perceive_demos(paths[:1], tmp_path, jobs=1)[0].frames > 0  # made anew


def test_seed_settings_and_content_decide_which_observation_it_is(demos: Path, tmp_path: Path) -> None:
    from learning.perception.observe_camera import Eyesight

    demo = demos / "a.mcap"
    usual = observation_path(demo, tmp_path, 0)
    assert usual == observation_path(demo, tmp_path, 0)
    copy = tmp_path / "a.mcap"
    copy.write_bytes(demo.read_bytes() + b" ")
    others = {observation_path(demo, tmp_path, 1), observation_path(demo, tmp_path, 0, Eyesight(width=640))}
    others.add(observation_path(copy, tmp_path, 0))
    assert len(others) == 3 and usual not in others


def test_dask_gives_the_same_observations_as_one_process(demos: Path, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    here = perceive_demos([demos / "a.mcap"], tmp_path / "here", jobs=1)[0].observation().observation
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        paths = [demos / "a.mcap", demos / "c.mcap"]
        there = perceive_demos(paths, tmp_path / "there", cluster=cluster.scheduler_address)
    assert np.array_equal(there[0].observation().observation.location, here.location)
    assert "c.mcap" in there[1].error


def test_a_missing_cluster_is_told(demos: Path, tmp_path: Path) -> None:
    with pytest.raises(PerceptionError, match="no Dask scheduler answers at 'nonsense://x'"):
        perceive_demos([demos / "a.mcap"], tmp_path, cluster="nonsense://x")
