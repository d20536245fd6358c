"""Inverse kinematics reaches the whole board, stays inside the limits and says when it cannot."""

import sysconfig
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from robots import Pose, RobotError, RobotModel
from robots import __file__ as robots_init
from robots.ik_kernel import poses
from robots.ik_problem import IkProblem
from robots.inverse_kinematics import IkSolver, TaskMask
from robots.kinematics import Kinematics, quaternion_xyzw, rotation_matrix
from robots.urdf import read_urdf

# From a block on the board to one carried over towers of eight, and then some.
HEIGHTS = np.linspace(0.019, 0.42, 12)


def board(height: float) -> list[np.ndarray]:
    return [np.array([(x + 0.5) * 0.05, (y + 0.5) * 0.05, height]) for x in range(8) for y in range(8)]


def test_every_cell_is_reached_at_every_height(arm: RobotModel) -> None:
    for height in HEIGHTS:
        for position in board(height):
            result = arm.inverse_kinematics(position)
            assert result.success, position
            assert result.error <= 1e-5
            assert np.all(result.q >= arm.lower) and np.all(result.q <= arm.upper)
            np.testing.assert_allclose(arm.forward_kinematics(result.q).position, position, atol=1e-5)


def test_the_wrist_is_above_a_tower_of_eight_wherever_the_tool_is() -> None:
    rod, tower, forearm_half = 0.34, 8 * 0.038, 0.022
    assert 0.019 + rod - forearm_half > tower


def test_the_tool_can_move_at_0_4_metres_per_second_in_any_direction(arm: RobotModel) -> None:
    slowest = np.inf
    for height in HEIGHTS:
        for position in board(height):
            inverse = np.linalg.inv(arm.jacobian(arm.inverse_kinematics(position).q)[:3])
            # The fastest speed that every direction allows: no row of J^-1 may ask more than its joint gives.
            slowest = min(slowest, float(np.min(arm.velocity / np.linalg.norm(inverse, axis=1))))
    assert slowest >= 0.4


def test_a_near_start_keeps_the_solution_near(arm: RobotModel) -> None:
    start = arm.inverse_kinematics(np.array([0.2, 0.1, 0.2])).q
    result = arm.inverse_kinematics(np.array([0.205, 0.1, 0.2]), start=start)
    assert result.success
    assert result.iterations <= 4
    assert np.abs(result.q - start).max() < 0.05


def test_equal_questions_get_equal_answers(arm: RobotModel) -> None:
    position = np.array([0.31, 0.07, 0.22])
    first, second = arm.inverse_kinematics(position), arm.placed_at(arm.pose_base_in_world).inverse_kinematics(position)
    np.testing.assert_array_equal(first.q, second.q)


@pytest.mark.parametrize("position", [(2.0, 0.0, 0.0), (-0.15, 0.2, 0.2), (0.2, 0.2, 1.5)])
def test_what_is_out_of_reach_fails_inside_the_limits(arm: RobotModel, position: tuple[float, float, float]) -> None:
    for start in (None, arm.home):
        result = arm.inverse_kinematics(np.array(position), start=start)
        assert not result.success
        assert result.error == pytest.approx(
            np.linalg.norm(arm.forward_kinematics(result.q).position - position), abs=1e-9
        )
        assert np.all(result.q >= arm.lower) and np.all(result.q <= arm.upper)


def test_the_answer_to_a_question_just_out_of_reach_is_the_nearest_posture(arm: RobotModel) -> None:
    # Straight ahead at shoulder height the arm is longest where its elbow is bent least.
    reach = np.sqrt(0.4**2 + 0.3**2 + 2 * 0.4 * 0.3 * np.cos(float(arm.lower[2])))
    result = arm.inverse_kinematics(np.array([-0.15 + reach + 0.02, 0.2, 0.21]))
    assert not result.success
    assert result.error == pytest.approx(0.02, abs=2e-4)  # it stops where steps along the limit become small


def test_nonsense_positions_are_refused(arm: RobotModel) -> None:
    with pytest.raises(RobotError, match="three finite numbers"):
        arm.inverse_kinematics(np.array([0.1, np.nan, 0.1]))
    with pytest.raises(RobotError, match="three finite numbers"):
        arm.inverse_kinematics(np.array([0.1, 0.2]))


@dataclass(frozen=True)
class Chain:
    """A chain with its solver, for drawing postures and measuring poses."""

    kinematics: Kinematics
    lower: np.ndarray
    upper: np.ndarray
    home: np.ndarray
    solver: IkSolver

    @classmethod
    def read(cls, urdf: Path, joints: list[str], frame: str) -> "Chain":
        parsed = read_urdf(urdf)
        mimic = [each.mimic for each in parsed.joints.values() if each.mimic and each.mimic.source in joints]
        kinematics = Kinematics(urdf, joints, mimic, frame)
        lower = np.array([parsed.joints[name].lower for name in joints])
        upper = np.array([parsed.joints[name].upper for name in joints])
        middle = 0.5 * (np.maximum(lower, -np.pi) + np.minimum(upper, np.pi))
        return cls(kinematics, lower, upper, middle, IkSolver(kinematics, lower, upper, middle))

    def postures(self, rng: np.random.Generator, count: int) -> np.ndarray:
        lower, upper = (
            np.where(np.isfinite(self.lower), self.lower, -3.0),
            np.where(np.isfinite(self.upper), self.upper, 3.0),
        )
        return lower + rng.random((count, lower.size)) * (upper - lower)

    def pose(self, q: np.ndarray) -> Pose:
        rotation, position = self.kinematics.placement(q)
        return Pose(position.copy(), quaternion_xyzw(rotation.copy()))

    def inside(self, q: np.ndarray) -> bool:
        return bool(np.all(q >= self.lower) and np.all(q <= self.upper))


@pytest.fixture(scope="module")
def seven() -> Chain:
    """Baxter's left arm, from the installed package."""
    (urdf,) = {path.resolve() for path in Path(sysconfig.get_paths()["purelib"]).rglob("baxter.urdf")}
    return Chain.read(urdf, [f"left_{name}" for name in ("s0", "s1", "e0", "e1", "w0", "w1", "w2")], "left_gripper")


@pytest.fixture(scope="module")
def six() -> Chain:
    """The Mico on its base: an offset wrist, and four joints that turn for ever."""
    urdf = Path(robots_init).parent / "mico_segway" / "mico_segway.urdf"
    return Chain.read(urdf, [f"joint_{index}" for index in range(1, 7)], "end_effector")


@pytest.fixture(params=["seven", "six"])
def chain(request: pytest.FixtureRequest) -> Chain:
    found: Chain = request.getfixturevalue(request.param)
    return found


def angle_between(first: Pose, second: Pose) -> float:
    return 2.0 * float(np.arccos(min(1.0, abs(first.orientation_xyzw @ second.orientation_xyzw))))


def test_reachable_poses_are_reached_within_the_limits(chain: Chain) -> None:
    results = []
    for q in chain.postures(np.random.default_rng(3), 500):
        target = chain.pose(q)
        result = chain.solver.solve(target, position_tolerance=1e-4, orientation_tolerance=1e-3)
        assert chain.inside(result.q)
        assert result.restarts <= 20
        reached = chain.pose(result.q)
        # The errors that are reported are those of the posture: arccos of a number near 1 is good to 1e-7.
        assert result.position_error == pytest.approx(np.linalg.norm(reached.position - target.position), abs=1e-12)
        assert result.orientation_error == pytest.approx(angle_between(reached, target), abs=1e-6)
        assert result.success == (result.position_error <= 1e-4 and result.orientation_error <= 1e-3)
        assert bool(result.reason) != result.success
        results.append(result.success)
    assert np.mean(results) >= 0.998  # measured: 9998 of 10000


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), away=st.floats(0.0, 0.1))
def test_a_near_start_leads_to_a_near_solution(seven: Chain, seed: int, away: float) -> None:
    rng = np.random.default_rng(seed)
    (q,) = seven.postures(rng, 1)
    start = np.clip(q + rng.uniform(-away, away, q.size), seven.lower, seven.upper)
    result = seven.solver.solve(seven.pose(q), start=start)
    # Least squares steps are the shortest ones. Beside a limit or a singularity the way can be longer, not arbitrarily.
    if result.success and result.restarts == 0:
        assert np.linalg.norm(result.q - start) <= 4.0 * np.linalg.norm(q - start) + 0.3


def test_joints_that_turn_for_ever_end_within_half_a_turn_of_the_start(six: Chain) -> None:
    for q in six.postures(np.random.default_rng(4), 20):
        start = q + 2.0 * np.pi * np.array([3.0, 0.0, 0.0, -2.0, 5.0, -1.0])
        result = six.solver.solve(six.pose(q), start=start)
        assert result.success
        endless = ~np.isfinite(six.lower)
        assert np.abs(result.q - start)[endless].max() <= np.pi + 1e-9


def test_the_freedom_of_a_redundant_arm_goes_to_the_posture(seven: Chain) -> None:
    nearer = []
    for q in seven.postures(np.random.default_rng(5), 40):
        target = seven.pose(q)
        plain = seven.solver.solve(target, start=q)
        assert plain.success and np.array_equal(plain.q, q)  # it is there already
        drawn = seven.solver.solve(target, start=q, posture=seven.home)
        assert drawn.success and seven.inside(drawn.q)
        before, after = np.linalg.norm(q - seven.home), np.linalg.norm(drawn.q - seven.home)
        assert after <= before
        # Nothing is left to gain: along the null space the way to the posture is across, or a limit is in the way.
        if np.all((drawn.q > seven.lower + 1e-9) & (drawn.q < seven.upper - 1e-9)):
            _, _, jacobian = seven.kinematics.placement_and_jacobian(drawn.q)
            free = np.linalg.svd(jacobian)[2][-1]
            nearer.append(abs(free @ (seven.home - drawn.q)))
    assert len(nearer) >= 10
    assert np.median(nearer) < 2e-3  # it settles at 1 mrad


def test_an_arm_without_freedom_keeps_its_solution_when_given_a_posture(six: Chain) -> None:
    (q,) = six.postures(np.random.default_rng(6), 1)
    result = six.solver.solve(six.pose(q), start=q, posture=six.home)
    np.testing.assert_allclose(result.q, q, atol=1e-3)  # the tolerance of the task, over the smallest singular value


MASKS = [
    TaskMask.POSITION,
    TaskMask.pointing("z"),
    TaskMask.pointing("x"),
    TaskMask.pointing("z", "base"),
    TaskMask(("x", "y", "z", "rz")),
    TaskMask(("x", "y", "z", "ry"), "base"),
    TaskMask(("x", "z", "rx", "ry", "rz"), "base"),
    TaskMask(("x", "y")),
    TaskMask(("rx", "ry", "rz")),
    TaskMask(("z",), "base"),
]


@pytest.mark.parametrize("mask", MASKS, ids=str)
def test_a_mask_frees_the_other_axes_and_holds_its_own(chain: Chain, mask: TaskMask) -> None:
    for q in chain.postures(np.random.default_rng(7), 15):
        target = chain.pose(q)
        result = chain.solver.solve(target, mask=mask)
        assert result.success and chain.inside(result.q)
        rotation, position = (each.copy() for each in chain.kinematics.placement(result.q))
        wanted = rotation_matrix(target.orientation_xyzw)
        frame = wanted.T if mask.frame == "tool" else np.eye(3)
        off = (frame @ (target.position - position))[list(mask.linear)]
        assert np.linalg.norm(off) <= 1e-5 * (1 + 1e-6)
        if len(mask.angular) == 3:
            np.testing.assert_allclose(rotation, wanted, atol=1.1e-4)
        elif len(mask.angular) == 2:
            axis = 3 - sum(mask.angular)
            ours, theirs = (rotation.T, wanted.T) if mask.frame == "tool" else (rotation, wanted)
            np.testing.assert_allclose(ours[axis], theirs[axis], atol=1.1e-4)  # the axis as the other frame sees it
        elif len(mask.angular) == 1:
            between = wanted @ rotation.T if mask.frame == "base" else rotation.T @ wanted
            assert abs(Rotation.from_matrix(between).as_rotvec()[mask.angular[0]]) <= 1.1e-4


@pytest.mark.parametrize("mask", [TaskMask.FULL, *MASKS], ids=str)
def test_the_jacobian_of_a_task_is_the_derivative_of_its_residual(chain: Chain, mask: TaskMask) -> None:
    q, goal = chain.postures(np.random.default_rng(8), 2)
    exact = len(mask.angular) < 2  # anywhere; with two or three rotations J leaves out terms of the residual's size
    pose = chain.pose(goal if exact else q + 1e-4 * (goal - q))
    target = np.concatenate((rotation_matrix(pose.orientation_xyzw).ravel(), pose.position))
    bounds, tolerances = np.array([chain.lower, chain.upper]), np.array([1e-5, 1e-4, 0.1])
    problem = IkProblem(chain.kinematics.chain(), mask, target, bounds, tolerances)
    residual, jacobian = problem.linearize(q)
    for joint in range(q.size):
        step = 1e-6 * np.eye(q.size)[joint]
        difference = (problem.linearize(q + step)[0] - problem.linearize(q - step)[0]) / 2e-6
        # Central differences with steps of 1e-6 are good to about 1e-9.
        allowed = 1e-8 if exact else 1e-8 + 2.0 * np.abs(residual).max()
        np.testing.assert_allclose(difference, -jacobian[:, joint], atol=allowed)


def test_the_compiled_chain_agrees_with_pinocchio(chain: Chain, arm: RobotModel) -> None:
    passive = Chain.read(arm.urdf_path, list(arm.joint_names), arm.tool_frame)
    for each in (chain, passive):
        geometry = each.kinematics.chain()
        postures = each.postures(np.random.default_rng(11), 50)
        for q, pose in zip(postures, poses(geometry.joints, geometry.tool, postures), strict=True):
            rotation, position = each.kinematics.placement(q)
            # Two ways to multiply the same ten matrices.
            np.testing.assert_allclose(pose, np.concatenate((rotation.ravel(), position)), atol=1e-13)


def test_an_arm_with_fewer_joints_meets_what_it_can(arm: RobotModel) -> None:
    names = list(arm.joint_names)
    three = Chain.read(arm.urdf_path, names, arm.tool_frame)
    for q in three.postures(np.random.default_rng(9), 30):
        target = three.pose(q)
        assert three.solver.solve(target.position).success
        assert three.solver.solve(target).success  # it can be there only as it is: all six axes at once
        upside_down = three.solver.solve(Pose(target.position, np.array([0.6, 0.8, 0.0, 0.0])))
        assert not upside_down.success
        assert "no posture has this orientation at this position" in upside_down.reason


def test_the_reason_says_what_is_out_of_reach(seven: Chain, six: Chain) -> None:
    upright = np.array([0.0, 0.0, 0.0, 1.0])
    far = seven.solver.solve(np.array([3.0, 0.0, 0.0]))
    assert far.reason.startswith("position out of reach by 17") and far.restarts == 20
    pose = seven.solver.solve(Pose(np.array([3.0, 0.0, 0.0]), upright))
    assert pose.reason.startswith("position out of reach by 17") and "whatever the orientation" in pose.reason
    # Both arms come to these places, but not with the tool turned back towards the arm.
    place = np.array([0.127, 0.0, 0.839]) + np.array([0.6, 0.0, 0.3])
    turned = six.solver.solve(Pose(place, np.array([0.0, -np.sqrt(0.5), 0.0, np.sqrt(0.5)])))
    assert six.solver.solve(place).success
    assert not turned.success
    assert "no posture has this orientation at this position" in turned.reason


def test_equal_poses_get_equal_answers_whatever_was_asked_before(seven: Chain) -> None:
    first, second = seven.postures(np.random.default_rng(10), 2)
    fresh = IkSolver(seven.kinematics, seven.lower, seven.upper, seven.home)
    fresh.solve(seven.pose(second), mask=TaskMask.pointing())
    np.testing.assert_array_equal(fresh.solve(seven.pose(first)).q, seven.solver.solve(seven.pose(first)).q)
    copied = fresh.with_kinematics(seven.kinematics.copy())
    np.testing.assert_array_equal(copied.solve(seven.pose(first)).q, seven.solver.solve(seven.pose(first)).q)


def test_restarts_are_limited(seven: Chain) -> None:
    pose = Pose(np.array([3.0, 0.0, 0.0]), np.array([0.0, 0.0, 0.0, 1.0]))
    for count in (0, 3):
        assert seven.solver.solve(pose, max_restarts=count).restarts == count


def test_nonsense_questions_are_refused(seven: Chain) -> None:
    pose = seven.pose(seven.home)
    lost = Pose(np.array([0.0, np.inf, 0.0]), pose.orientation_xyzw)
    twisted = Pose(pose.position, np.array([0.0, 0.0, 0.0, np.nan]))
    for target, message in ((lost, "three finite numbers"), (twisted, "unit quaternion")):
        with pytest.raises(RobotError, match=message):
            seven.solver.solve(target)
    for wrong in (np.zeros(6), np.full(7, np.nan)):
        with pytest.raises(RobotError, match="start must be 7 finite joint positions"):
            seven.solver.solve(pose, start=wrong)
        with pytest.raises(RobotError, match="posture must be 7 finite joint positions"):
            seven.solver.solve(pose, posture=wrong)
    with pytest.raises(RobotError, match="position_tolerance must be positive \\[m\\], got nan"):
        seven.solver.solve(pose, position_tolerance=float("nan"))
    with pytest.raises(RobotError, match="orientation_tolerance must be positive \\[rad\\], got 0"):
        seven.solver.solve(pose, orientation_tolerance=0.0)
    with pytest.raises(RobotError, match="max_restarts must be at least 0, got -1"):
        seven.solver.solve(pose, max_restarts=-1)
    with pytest.raises(RobotError, match="a position alone says nothing about .* of the tool: give a Pose"):
        seven.solver.solve(pose.position, mask=TaskMask.pointing("y"))
    with pytest.raises(RobotError, match="axes must be one or more different ones of x, y, z, rx, ry, rz"):
        TaskMask(("x", "w"))
    with pytest.raises(RobotError, match="frame must be 'tool' or 'base', got 'world'"):
        TaskMask(("x",), "world")
    with pytest.raises(RobotError, match="axis must be x, y or z, got 'w'"):
        TaskMask.pointing("w")


def test_axes_are_brought_into_order() -> None:
    assert TaskMask(("rz", "x")) == TaskMask(("x", "rz"))
    assert TaskMask.pointing("z").axes == ("x", "y", "z", "rx", "ry")
