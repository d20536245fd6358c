import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from teleop import GamepadMapping, GamepadState, Recorder, check_replay, load_demo
from teleop.drive_command import ArmWish, DriveCommand
from teleop.drive_session import DriveSession
from teleop.trim import trim_demo
from twin import World

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def wheels_demo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Mico drives a little, moves its arm and closes its hand."""
    path = tmp_path_factory.mktemp("drive") / "wheels.mcap"
    wishes = [ArmWish((0.0, 0.1, 0.05, 0.0, 0.0, 0.2)), ArmWish(gripper="close"), ArmWish(jog=(1, 0.2))]
    with World.from_scene("ordering", seed=3) as world:
        session = DriveSession(world)
        with Recorder(path, world.spec, GamepadMapping(), 240, robot=world.robot) as recorder:
            for step in range(240):
                if step % 8 == 0:
                    recorder.state(step, world.state())
                command = DriveCommand({"arm": wishes[step // 80]}, (0.2 if step < 120 else 0.0, 0.3))
                recorder.drive(step, GamepadState(), command, session.step(command))
    return path


def test_a_robot_on_wheels_is_replayed_exactly(wheels_demo: Path) -> None:
    demo = load_demo(wheels_demo)
    assert demo.base is not None and demo.arm_commands is not None
    assert np.linalg.norm(demo.base[-1, :3] - demo.base[0, :3]) > 0.03
    assert demo.arm_commands.base_executed[60, 0] > 0.1
    report = check_replay(demo)
    assert (report.max_error, report.states) == (0.0, 30)
    assert report.warnings == ()


def test_a_piece_of_it_too(wheels_demo: Path, tmp_path: Path) -> None:
    piece = trim_demo(wheels_demo, 0.3, 0.8, tmp_path / "piece.mcap")
    assert piece.drive is not None and piece.base is not None
    assert check_replay(piece).max_error < 1e-12  # times lose their last bit


def test_what_a_process_did_before_does_not_matter(wheels_demo: Path) -> None:
    """Distances to boxes depended on the first question of a process: see `robots.settled_coal`."""
    code = (
        "import sys, teleop.drive_session\n"
        "from robots import CollisionModel, load_robot\n"
        "from teleop import check_replay\n"
        "r = load_robot('baxter'); CollisionModel(r).nearest(r.home)\n"
        "print(check_replay(sys.argv[1]).max_error)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(wheels_demo)],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[-1] == "0.0"


def test_a_demo_of_other_code_is_warned_about(wheels_demo: Path, tmp_path: Path) -> None:
    from teleop.demo_file import read_records, write_records

    found = read_records(wheels_demo)
    metadata = dict(found.metadata or {})
    metadata["code"] = "0123456789abcdef"
    metadata["versions"] = metadata["versions"].replace('"ruckig": "', '"ruckig": "0.')
    path = tmp_path / "other.mcap"
    write_records(path, metadata, found.records)
    warnings = check_replay(path).warnings
    assert len(warnings) == 2
    assert warnings[0].startswith("recorded with ruckig 0.")
    assert warnings[1].startswith("recorded with code 0123456789abcdef, here is ")
