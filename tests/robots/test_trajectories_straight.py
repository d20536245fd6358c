"""The tool stays on its line, the joints within their limits; where that cannot be, the reason is given."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from robots import Pose
from robots.trajectories import JointLimits, MotionError, ToolLimits, check_limits, move_straight

LINKS = np.array([0.4, 0.3, 0.2])
LIMITS = JointLimits(np.full(3, -2.8), np.full(3, 2.8), np.full(3, 2.0), np.full(3, 8.0), np.full(3, 120.0))
GENTLE = ToolLimits(velocity=0.1, acceleration=0.4, jerk=4.0)
RUSHED = ToolLimits(5.0, 50.0, 1000.0, 20.0, 200.0, 4000.0)
START = np.array([0.1, 1.8, -0.9])


def forward(q: np.ndarray) -> Pose:
    """A planar arm of three joints: position in x, y, orientation about z."""
    angles = np.cumsum(q)
    position = np.array([LINKS @ np.cos(angles), LINKS @ np.sin(angles), 0.0])
    return Pose(position, Rotation.from_euler("z", angles[-1]).as_quat())


def inverse(pose: Pose, near: np.ndarray) -> np.ndarray | None:
    """In closed form, with the elbow on the side where it is."""
    yaw = float(Rotation.from_quat(pose.orientation_xyzw).as_rotvec()[2])
    x, y = pose.position[:2] - LINKS[2] * np.array([np.cos(yaw), np.sin(yaw)])
    cosine = (x**2 + y**2 - LINKS[0] ** 2 - LINKS[1] ** 2) / (2 * LINKS[0] * LINKS[1])
    if abs(cosine) > 1:
        return None
    elbow = np.copysign(np.arccos(cosine), near[1])
    shoulder = np.arctan2(y, x) - np.arctan2(LINKS[1] * np.sin(elbow), LINKS[0] + LINKS[1] * np.cos(elbow))
    q = np.array([shoulder, elbow, yaw - shoulder - elbow])
    return near + (q - near + np.pi) % (2 * np.pi) - np.pi


def jacobian(q: np.ndarray) -> np.ndarray:
    angles = np.cumsum(q)
    rows = np.zeros((6, 3))
    for joint in range(3):
        rows[0, joint] = -LINKS[joint:] @ np.sin(angles[joint:])
        rows[1, joint] = LINKS[joint:] @ np.cos(angles[joint:])
    rows[5] = 1.0
    return rows


def shifted(dx: float, dy: float, turn: float) -> Pose:
    pose = forward(START)
    return Pose(
        pose.position + [dx, dy, 0.0],
        (Rotation.from_rotvec([0, 0, turn]) * Rotation.from_quat(pose.orientation_xyzw)).as_quat(),
    )


def distance_from_line(position: np.ndarray, begin: np.ndarray, end: np.ndarray) -> float:
    step = (end - begin) / np.linalg.norm(end - begin)
    return float(np.linalg.norm(position - begin - ((position - begin) @ step) * step))


@pytest.mark.parametrize("tool", [GENTLE, RUSHED])
@pytest.mark.parametrize("goal", [shifted(0.15, -0.1, 0.0), shifted(-0.1, 0.2, 0.7), shifted(0.0, 0.0, -1.0)])
@pytest.mark.parametrize("given", [None, jacobian])
def test_the_tool_stays_on_the_line_and_the_joints_within_their_limits(tool: ToolLimits, goal: Pose, given) -> None:
    motion = move_straight(START, goal, forward, inverse, LIMITS, tool, jacobian=given)
    assert motion.success, motion.reason
    assert motion.trajectory is not None
    assert check_limits(motion.trajectory, LIMITS).worst <= 1 + 1e-9
    begin = forward(START)
    samples = motion.trajectory.sample(0.005)
    for q in samples.position:
        if np.any(goal.position != begin.position):
            assert distance_from_line(forward(q).position, begin.position, goal.position) <= 5e-4
        else:
            np.testing.assert_allclose(forward(q).position, begin.position, atol=5e-4)
    last = forward(samples.position[-1])
    # Newton's residual of 1e-7.
    np.testing.assert_allclose(last.position, goal.position, atol=2e-7)
    turned = Rotation.from_quat(last.orientation_xyzw) * Rotation.from_quat(goal.orientation_xyzw).inv()
    assert turned.magnitude() <= 2e-7
    assert motion.deviation <= 5e-4
    assert motion.retimed == (tool is RUSHED)


def test_the_tools_own_limits_are_kept_when_the_joints_allow_them() -> None:
    goal = shifted(0.2, 0.0, 0.0)
    motion = move_straight(START, goal, forward, inverse, LIMITS, GENTLE)
    assert motion.trajectory is not None
    # d / v + v / a + a / j along the line
    assert motion.trajectory.duration == pytest.approx(0.2 / 0.1 + 0.1 / 0.4 + 0.4 / 4.0)
    tips = np.array([forward(q).position for q in motion.trajectory.sample(0.01).position])
    speed = np.linalg.norm(np.diff(tips, axis=0), axis=1) / 0.01
    assert speed[:-1].max() <= 0.1 * 1.002  # the deviation from the line of 0.05 mm changes the speed a little


def test_the_tools_own_limits_are_kept_when_the_joints_slow_it_down() -> None:
    tool = ToolLimits(0.6, 50.0, 1000.0, 20.0, 200.0, 4000.0)
    motion = move_straight(START, shifted(-0.15, 0.15, 0.0), forward, inverse, LIMITS, tool)
    assert motion.trajectory is not None
    assert motion.retimed
    tips = np.array([forward(q).position for q in motion.trajectory.sample(0.005).position])
    assert np.max(np.linalg.norm(np.diff(tips, axis=0), axis=1)[:-1]) / 0.005 <= 0.6 * 1.002


def test_only_the_position_is_followed_where_orientation_is_not_asked_for() -> None:
    goal = Pose(forward(START).position + [0.1, 0.05, 0.0], np.array([1.0, 0, 0, 0]))
    motion = move_straight(START, goal, forward, inverse, LIMITS, GENTLE, turn_tolerance=None)
    assert motion.success
    assert motion.trajectory is not None
    np.testing.assert_allclose(forward(motion.trajectory.at(99.0)[0]).position, goal.position, atol=2e-7)


def test_no_way_is_no_motion() -> None:
    motion = move_straight(START, forward(START), forward, inverse, LIMITS, GENTLE)
    assert motion.success
    assert motion.trajectory is not None
    assert motion.trajectory.duration == 0.0


def test_out_of_reach_has_a_reason() -> None:
    motion = move_straight(START, shifted(1.0, 0.0, 0.0), forward, inverse, LIMITS, GENTLE)
    assert not motion.success
    assert motion.trajectory is None
    assert "no posture reaches the tool's pose at" in motion.reason


def test_a_line_over_a_joint_limit_has_a_reason() -> None:
    tight = JointLimits(START - 0.2, START + 0.2, LIMITS.velocity, LIMITS.acceleration, LIMITS.jerk)
    motion = move_straight(START, shifted(-0.1, 0.2, 0.7), forward, inverse, tight, GENTLE)
    assert not motion.success
    assert "of the line" in motion.reason


def test_nonsense_is_refused() -> None:
    with pytest.raises(MotionError, match="goal pose must be .* got .nan"):
        move_straight(START, Pose([np.nan, 0, 0], [0, 0, 0, 1]), forward, inverse, LIMITS, GENTLE)
    with pytest.raises(MotionError, match="start .*nan.* is not finite"):
        move_straight(START * np.nan, forward(START), forward, inverse, LIMITS, GENTLE)
    with pytest.raises(MotionError, match="tool limit jerk must be positive and finite; got -1"):
        ToolLimits(0.1, 1.0, -1.0)
