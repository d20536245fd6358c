"""Benchmarks on small samples: figures that mean what they say, and one JSON object with everything beside them."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from executor.bench import grasp, moves
from executor.bench.physics import primitives_scene
from executor.bench.pool import spread
from executor.bench.report import BenchReport
from executor.cli import app
from twin import World
from twin.objects import CATALOGUES

ROBOTS = ("three_dof", "baxter", "mico_segway")


def bench(*words: str) -> dict[str, dict[str, float | None]]:
    """Run a benchmark's command and check the frame of what it says."""
    result: Result = CliRunner().invoke(app, ["bench", *words, "--json"])
    assert result.exit_code == 0, result.output
    assert len(result.stdout.strip().splitlines()) == 1
    said = json.loads(result.stdout)
    assert set(said) == {"figures", "baselines", "settings", "notes", "machine", "seed"}
    assert said["machine"]["cores"] >= 1 and said["machine"]["python"]
    return dict(said)


@pytest.mark.parametrize("robot", ROBOTS)
def test_random_moves_stay_inside_every_limit_and_touch_nothing(robot: str) -> None:
    """The sample of tests/slow, which makes a thousand moves a robot."""
    said = bench("moves", "--robot", robot, "--count", "6", "--jobs", "1", "--seed", "7")
    figures = said["figures"]
    assert said["seed"] == 7
    assert figures[f"{robot}.moves"] == 6
    for name in ("violations", "touches", "strays"):
        assert figures[f"{robot}.{name}"] == 0
    part, off = figures[f"{robot}.largest_part_of_a_limit"], figures[f"{robot}.farthest_from_trajectory_mrad"]
    assert part is not None and 0.5 < part <= 1 + 1e-6
    assert off is not None and 0.0 < off < 2.0
    if robot == "mico_segway":
        base = figures[f"{robot}.base_worst_off_mm"]
        assert figures[f"{robot}.base_moves"] == 1 and base is not None and base < 10


@pytest.mark.parametrize("robot", ROBOTS)
def test_objects_are_picked_carried_and_placed_by_friction(robot: str) -> None:
    figures = bench("grasp", "--robot", robot, "--picks", "3", "--jobs", "1", "--seed", "2")["figures"]
    assert figures[f"{robot}.picks"] == figures[f"{robot}.objects"] == 3
    assert figures[f"{robot}.success"] == 1.0
    off, slip = figures[f"{robot}.median_off_mm"], figures[f"{robot}.worst_slip_mm"]
    assert off is not None and off < 1000 * grasp.NEAR
    assert slip is not None and slip < 15  # what is round settles between the fingers


def test_every_object_of_a_robot_has_its_turn() -> None:
    assert grasp.objects_of("baxter") == CATALOGUES["tabletop"] and len(grasp.objects_of("baxter")) == 51
    assert grasp.objects_of("mico_segway") == CATALOGUES["ordering"] and len(grasp.objects_of("mico_segway")) == 32
    assert len(set(grasp.objects_of("three_dof"))) == 36  # four shapes in nine colours


def test_equal_trials_give_equal_picks_and_a_failure_has_a_reason() -> None:
    one = grasp.try_pick(("three_dof", "red cube", 5, 1))
    assert one == grasp.try_pick(("three_dof", "red cube", 5, 1))
    assert one.reason == "" and one.off < grasp.NEAR
    assert grasp.try_pick(("three_dof", "red cube", 5, 2)) != one


def test_physics_is_faster_than_real_time(tmp_path: Path) -> None:
    log = tmp_path / "deep" / "robosuite.log"
    said = bench("physics", "--seconds", "2", "--no-robosuite", "--log", str(log))
    assert not log.parent.exists(), "without robosuite nothing is installed or written"
    for scene in ("three_dof", "baxter", "baxter_tabletop", "mico_segway"):
        factor, slowest = (said["figures"][f"{scene}.real_time_factor{part}"] for part in ("", "_slowest"))
        assert factor is not None and slowest is not None
        # The issue asks for 15 and 10; a busy machine that runs other tests may be several times slower.
        assert factor > 1 and 0 < slowest <= factor
        assert said["figures"][f"{scene}.steps_per_second"] == pytest.approx(factor / World.DT)
    assert said["baselines"] == {}


def test_the_primitives_stand_on_the_table() -> None:
    with World(primitives_scene()) as world:
        assert world.robot.name == "baxter" and len(world.spec.objects) == 8
        assert world.touches() == set()


def test_a_move_that_leaves_a_limit_or_touches_fails_the_command(monkeypatch: pytest.MonkeyPatch) -> None:
    figures = {"three_dof.violations": 0, "three_dof.touches": 1, "three_dof.strays": 0}
    monkeypatch.setattr(moves, "run", lambda *_: BenchReport(dict(figures)))
    result = CliRunner().invoke(app, ["bench", "moves", "--robot", "three_dof", "--count", "1"])
    assert result.exit_code == 1
    figures["three_dof.touches"] = 0
    assert CliRunner().invoke(app, ["bench", "moves", "--robot", "three_dof", "--count", "1"]).exit_code == 0


def test_an_unknown_robot_and_no_trials_are_refused() -> None:
    for part, count in (("grasp", "--picks"), ("moves", "--count")):
        result = CliRunner().invoke(app, ["bench", part, "--robot", "r2d2", count, "1", "--jobs", "1"])
        assert result.exit_code == 2
        assert "'r2d2' is unknown: use one of baxter, mico_segway, three_dof" in result.stderr
        assert CliRunner().invoke(app, ["bench", part, count, "0"]).exit_code == 2


def double(number: int) -> int:
    return 2 * number


def test_tasks_are_spread_over_processes_and_given_back_as_they_are_done() -> None:
    assert list(spread(double, [1, 2, 3], jobs=1)) == [2, 4, 6]
    assert sorted(spread(double, [1, 2, 3], jobs=2)) == [2, 4, 6]
    assert list(spread(double, [], jobs=2)) == []
