"""The kinematics benchmark asks everybody the same, judges strictly, and reports what it says it reports."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from executor.bench.ik_contenders import (
    PINK_CANDIDATES,
    PYBULLET_CANDIDATES,
    Contender,
    Ours,
    PinkIk,
    PyBulletIk,
    pink_is_there,
    pybullet_client,
)
from executor.bench.ik_questions import MAX_RESTARTS, ArmQuestion, arm_question
from executor.bench.kinematics import run
from robots import Pose, load_robot
from robots.kinematics import quaternion_xyzw


@pytest.fixture(scope="module")
def questions(tmp_path_factory: pytest.TempPathFactory) -> dict[str, ArmQuestion]:
    found = {}
    for name in ("three_dof", "baxter", "mico_segway"):
        robot = load_robot(name)
        found[name] = arm_question(robot, next(iter(robot.arms.values())), tmp_path_factory.mktemp(name))
    return found


@pytest.fixture(scope="module")
def client() -> Iterator[int]:
    with pybullet_client() as number:
        yield number


@pytest.mark.parametrize("name", ["three_dof", "baxter", "mico_segway"])
def test_the_chain_that_others_get_is_the_same_arm(questions: dict[str, ArmQuestion], name: str, client: int) -> None:
    question = questions[name]
    rng = np.random.default_rng(0)
    for contender in contenders(question, client):
        solved = 0
        for target in question.targets(rng, 25):
            q, restarts = contender.solve(target, question.postures(rng, MAX_RESTARTS + 1))
            assert 0 <= restarts <= MAX_RESTARTS
            # Whoever says that it is solved by its own chain is believed by the judge over the whole arm.
            assert (q is None) or question.solved(q, target), contender
            solved += q is not None
        assert solved >= 20, contender  # all of them solve more than 95% with restarts


def contenders(question: ArmQuestion, client: int) -> list[Contender]:
    strong = next(each for each in PYBULLET_CANDIDATES if each.damping == 1e-4 and each.iterations == 100)
    found: list[Contender] = [Ours(question), PyBulletIk(question, client, strong)]
    return found + ([PinkIk(question, PINK_CANDIDATES[0])] if pink_is_there() else [])


def test_the_judge_refuses_what_is_off_or_outside_the_limits(questions: dict[str, ArmQuestion]) -> None:
    question = questions["baxter"]
    (q,) = question.postures(np.random.default_rng(1), 1)
    (target,) = question.targets(np.random.default_rng(1), 1)
    assert question.solved(q, target)
    assert not question.solved(None, target)
    off = Pose(target.position + np.array([1.1e-4, 0.0, 0.0]), target.orientation_xyzw)
    assert not question.solved(q, off)
    half = 0.5 * 1.1e-3
    x, y, z, w = target.orientation_xyzw
    turned = np.array([x + half * w, y + half * z, z - half * y, w - half * x])
    assert not question.solved(q, Pose(target.position, turned / np.linalg.norm(turned)))
    outside = q.copy()
    outside[6] = question.upper[6] + 0.01
    rotation, position = question.kinematics.placement(outside)
    assert not question.solved(outside, Pose(position, quaternion_xyzw(rotation)))


def test_an_arm_with_few_joints_is_asked_for_its_position(questions: dict[str, ArmQuestion]) -> None:
    assert [each.whole_pose for each in questions.values()] == [False, True, True]
    # The rod hangs down from the wrist, upright however the arm stands.
    np.testing.assert_allclose(questions["three_dof"].offset_in_base[:2], 0.0, atol=1e-12)
    assert questions["three_dof"].offset_in_base[2] < -0.3


def test_a_small_run_reports_figures_baselines_and_settings() -> None:
    arms = []
    report = run(3, targets=12, robots=["three_dof"], progress=lambda: arms.append(1), baseline_targets=6)
    assert len(arms) == 1
    assert report.figures["three_dof.success"] == 1.0
    assert 0.0 < report.figures["three_dof.median_us"] <= report.figures["three_dof.p99_us"]
    assert report.figures["three_dof.ratio_vs_pybullet"] == pytest.approx(
        report.baselines["pybullet.three_dof.median_us"] / report.figures["three_dof.median_us"]
    )
    assert 0.0 <= report.baselines["pybullet.three_dof.success"] <= 1.0
    assert "jointDamping" in report.settings["pybullet.three_dof.arm"]
    assert (report.figures["three_dof.ratio_vs_pink"] is None) == (not pink_is_there())


def test_the_chains_lie_in_the_folder_that_was_given(tmp_path: Path) -> None:
    robot = load_robot("three_dof")
    question = arm_question(robot, robot.arms["arm"], tmp_path)
    assert question.chain_urdf.parent == tmp_path
    assert question.chain_urdf.read_text(encoding="utf-8").count("mesh") == 0
