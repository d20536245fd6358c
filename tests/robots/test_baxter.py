"""Baxter: published limits, grippers that close and open as far as the real ones, a home that touches nothing."""

import numpy as np
import pytest

from robots import CollisionModel, RobotError, RobotModel, load_robot
from robots.manipulability import condition_number

from .bullet_robot import BulletRobot

PUBLISHED = {
    "s0": (-1.7017, 1.7017, 1.5),
    "s1": (-2.147, 1.047, 1.5),
    "e0": (-3.0542, 3.0542, 1.5),
    "e1": (-0.05, 2.618, 1.5),
    "w0": (-3.059, 3.059, 4.0),
    "w1": (-1.5708, 2.094, 4.0),
    "w2": (-3.059, 3.059, 4.0),
}
"""Lowest and highest position [rad] and greatest speed [rad/s] of each joint of an arm."""
TRAVEL = 2 * 0.020833
"""How far the two fingers of a gripper move together [m]."""


@pytest.fixture(scope="module")
def baxter() -> RobotModel:
    return load_robot("baxter")


def measured(robot: RobotModel, side: str, opening: float) -> float:
    """Distance of an arm's finger tips in PyBullet [m] for a commanded gap."""
    with BulletRobot(robot) as bullet:
        bullet.place(robot.expand(robot.home, {side: opening}))
        return bullet.between(*(f"{side[0]}_gripper_{finger}_finger_tip" for finger in ("l", "r")))


def test_limits_are_the_published_ones(baxter: RobotModel) -> None:
    for side, arm in baxter.arms.items():
        assert arm.joint_names == tuple(f"{side}_{joint}" for joint in PUBLISHED)
        wanted = np.array(list(PUBLISHED.values())).T
        for have, published in zip((arm.lower, arm.upper, arm.velocity), wanted, strict=True):
            # The table is rounded to four digits.
            np.testing.assert_allclose(have, published, atol=1e-4)


def test_home_is_far_from_singular_postures_and_mirrored(baxter: RobotModel) -> None:
    left, right = (baxter.arms[side].home for side in ("left", "right"))
    np.testing.assert_array_equal(left * [-1, 1, -1, 1, -1, 1, -1], right)
    for arm in baxter.arms.values():
        # MoveIt Servo slows down from 17; 0.3 m of movement weigh as much as a radian.
        assert condition_number(arm.jacobian(arm.home), 0.3) < 8


@pytest.mark.parametrize("posture", ["home", "neutral"])
def test_home_and_the_makers_neutral_posture_touch_nothing(baxter: RobotModel, posture: str) -> None:
    model = CollisionModel(baxter)
    q = baxter.home if posture == "home" else np.tile([0, -0.55, 0, 0.75, 0, 1.26, 0], 2)
    for opening in (0.0, 0.04):
        openings = {"left": opening, "right": opening}
        assert model.free(q, openings)
        assert model.nearest(baxter.home, openings).distance > 0.05


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("part", [0.0, 0.3, 1.0])
def test_gaps_are_those_of_the_finger_tips_in_pybullet(baxter: RobotModel, side: str, part: float) -> None:
    gripper = baxter.arms[side].gripper
    assert gripper.min_opening == pytest.approx(0.0, abs=1e-9)
    assert gripper.max_opening == pytest.approx(TRAVEL, abs=1e-9)
    # The right tips are half-round, their radius is rounded.
    assert measured(baxter, side, part * TRAVEL) == pytest.approx(part * TRAVEL, abs=3e-5)


@pytest.mark.parametrize(("mounting", "left", "right"), [(0.0, 0.016, 0.0065), (0.01, 0.036, 0.0265)])
def test_fingers_can_be_mounted_wider(baxter: RobotModel, mounting: float, left: float, right: float) -> None:
    wide = load_robot("baxter", finger_mounting=mounting)
    assert wide.urdf_path != baxter.urdf_path
    for side, closed in (("left", left), ("right", right)):
        gripper = wide.arms[side].gripper
        for gap, wanted in ((gripper.min_opening, closed), (gripper.max_opening, closed + TRAVEL)):
            assert gap == pytest.approx(wanted, abs=1e-9)
            assert measured(wide, side, gap) == pytest.approx(wanted, abs=3e-5)
    again = RobotModel(baxter.folder, finger_mounting=mounting)
    assert again.urdf_path == wide.urdf_path
    assert again.arms["left"].gripper.max_opening == wide.arms["left"].gripper.max_opening


def test_fingers_that_would_overlap_or_are_not_a_number_are_refused() -> None:
    with pytest.raises(RobotError, match=r"fingers would overlap by 4.0 mm .* at least -0.008 m .* got -0.01"):
        load_robot("baxter", finger_mounting=-0.01)
    with pytest.raises(RobotError, match="finger_mounting must be a finite number .*, got nan"):
        load_robot("baxter", finger_mounting=float("nan"))


def test_only_fingers_that_slide_can_be_mounted_elsewhere() -> None:
    with pytest.raises(RobotError, match=r"mico_segway.urdf: joint finger_1: only fingers that slide"):
        load_robot("mico_segway", finger_mounting=0.01)
    # The board arm's file says how far its gripper opens: fingers mounted wider have less of a way to go.
    wide = load_robot("three_dof", finger_mounting=0.004)
    assert (wide.gripper.min_opening, wide.gripper.max_opening) == pytest.approx((0.008, 0.048))
    with BulletRobot(wide) as bullet:
        for gap in (0.008, 0.03, 0.048):
            bullet.place(wide.expand(wide.home, {"arm": gap}))
            assert bullet.between("left_finger", "right_finger") == pytest.approx(gap, abs=1e-6)
    with pytest.raises(RobotError, match=r"must be above the gap of the closed fingers, 0.06 m, got 0.048"):
        load_robot("three_dof", finger_mounting=0.03)
