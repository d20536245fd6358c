"""Gaps and finger positions: there and back, held to what the fingers can do, and true to the URDF."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import Gripper, RobotError, list_robots, load_robot
from robots.gripper import unit_axis

from .bullet_robot import BulletRobot

ROBOTS = [load_robot(name) for name in list_robots()]
GRIPPERS = [
    pytest.param(arm.gripper, id=f"{robot.name}-{name}") for robot in ROBOTS for name, arm in robot.arms.items()
]


@pytest.mark.parametrize("gripper", GRIPPERS)
@settings(max_examples=60, deadline=None)
@given(part=st.floats(0, 1))
def test_a_gap_gives_joints_that_give_the_gap(gripper: Gripper, part: float) -> None:
    lowest = float(gripper.gaps[0])  # revolute fingers touch within one sample of the way; see `_SAMPLES`
    gap = lowest + part * (gripper.max_opening - lowest)
    first, second = gripper.joints_at(gap)
    assert gripper.opening_at(first, second) == pytest.approx(gap, abs=1e-12)
    for value, closed, opened in zip((first, second), gripper.closed, gripper.open, strict=True):
        assert min(closed, opened) - 1e-12 <= value <= max(closed, opened) + 1e-12


@pytest.mark.parametrize("gripper", GRIPPERS)
def test_gaps_are_held_to_what_the_fingers_can_do(gripper: Gripper) -> None:
    np.testing.assert_allclose(gripper.joints_at(1.0), gripper.open, atol=1e-12)
    least = gripper.joints_at(float(gripper.gaps[0]))
    assert gripper.joints_at(-1.0) == gripper.joints_at(gripper.min_opening) == least
    assert gripper.opening_at(*gripper.open) == pytest.approx(gripper.max_opening, abs=1e-12)
    assert gripper.opening_at(*gripper.closed) == pytest.approx(gripper.min_opening, abs=0.001)


@pytest.mark.parametrize("gripper", GRIPPERS)
def test_wider_gaps_need_more_way(gripper: Gripper) -> None:
    ways = [
        abs(gripper.joints_at(gap)[0] - gripper.closed[0])
        for gap in np.linspace(gripper.gaps[0], gripper.max_opening, 50)
    ]
    assert np.all(np.diff(ways) > 0)


def test_each_finger_counts_for_half_of_the_gap() -> None:
    gripper = load_robot("three_dof").gripper
    assert gripper.opening_at(0.010, 0.020) == pytest.approx(0.030, abs=1e-12)
    # A finger that the solver pushed a little beyond its end is read as it is.
    assert gripper.opening_at(0.0245, 0.0245) == pytest.approx(0.049, abs=1e-12)


def test_the_gap_of_the_mico_is_the_distance_of_its_pads_in_pybullet() -> None:
    robot = load_robot("mico_segway")
    across = unit_axis("y")
    with BulletRobot(robot) as bullet:
        for gap in np.random.default_rng(0).uniform(0.001, robot.gripper.max_opening, 100):
            bullet.place(robot.expand(robot.home, {"arm": gap}))
            first, second = bullet.frame("pad_1"), bullet.frame("pad_2")
            distance = np.linalg.norm(second.position - first.position)
            # Between the 201 samples the gap is taken to be straight.
            assert distance == pytest.approx(gap, abs=2e-5)
    np.testing.assert_array_equal(robot.gripper.closing, across)


def test_pads_that_do_not_meet_leave_a_gap(spoiled: Callable[..., Path]) -> None:
    pads = 'closed = [0.002, 0.002]\nopen = [0.024, 0.024]\npads = ["left_finger", "right_finger"]'
    gripper = load_robot(spoiled("max_opening = 0.048", pads)).gripper
    # A finger's joint position is its face's distance from the axis.
    assert gripper.min_opening == pytest.approx(0.004, abs=1e-12)
    assert gripper.max_opening == pytest.approx(0.048, abs=1e-12)
    np.testing.assert_allclose(gripper.joints_at(0.0), [0.002, 0.002], atol=1e-12)


@pytest.mark.parametrize(
    ("new", "message"),
    [
        ("open = [0.024, 0.0]", "each finger must move, got (0.024, 0.0) from (0.0, 0.0)"),
        ("open = [0.024, 0.024]\nmax_opening = 0.05", "the fingers open to 0.048 m, so at most that, got 0.05"),
        ("closed = [0.01, 0.01]\nmax_opening = 0.048", "finger_left opens to 0.024 m, so at most 0.028, got 0.048"),
        ("closed_gap = 0.05\nmax_opening = 0.048", "must be above the gap of the closed fingers, 0.05 m, got 0.048"),
        ("closed = [0.03, 0.0]\nopen = [0.0, 0.024]", "closed: finger_left must be in 0.0..0.024, got 0.03"),
        ('open = [0.024, 0.024]\npads = ["rod", "tool"]', "the gap between the pads must grow from closed to open"),
        ('open = [0.024, 0.024]\npads = ["rod", "rod"]', "the gap between the pads must grow from closed to open"),
    ],
)
def test_grippers_that_cannot_be_are_refused(spoiled: Callable[..., Path], new: str, message: str) -> None:
    folder = spoiled("max_opening = 0.048", new)
    with pytest.raises(RobotError) as caught:
        load_robot(folder)
    assert message in str(caught.value)
    assert str(caught.value).startswith(f"{folder}/robot.toml: arms")
