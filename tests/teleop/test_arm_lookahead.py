"""What lies ahead of a straight motion: velocity and position limits, singular postures, and the way through them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import RobotModel, load_robot
from robots.kinematics import Kinematics
from robots.manipulability import condition_number
from teleop.arm_lookahead import (
    FASTEST,
    FREE,
    POSITION,
    ROOM,
    SINGULARITY,
    STOP_AT,
    VELOCITY,
    joint_velocities,
    look_ahead,
)

LENGTH = 0.3
ROBOTS = {name: load_robot(name) for name in ("three_dof", "baxter", "mico_segway")}


class Arm:
    """A robot's first arm, and what the compiled functions take of it."""

    def __init__(self, robot: RobotModel) -> None:
        self.arm = arm = next(iter(robot.arms.values()))
        self.n = len(arm.joint_names)
        self.m = 3 if self.n < 6 else 6
        self.kinematics = Kinematics(robot.urdf_path, arm.joint_names, arm.mimic, arm.tool_frame, robot.locked)
        chain = self.kinematics.chain()
        self.weights = np.array([1.0, 1.0, 1.0, LENGTH, LENGTH, LENGTH])[: self.m]
        limits = np.array([arm.velocity, arm.acceleration, arm.jerk, arm.lower, arm.upper])
        mask = np.array([1] * self.m + [0] * (7 - self.m))
        self.model = chain.joints, chain.tool, mask, self.weights, limits

    def rows(self, q: np.ndarray) -> np.ndarray:
        return np.array(self.kinematics.placement_and_jacobian(q)[2])[: self.m]

    def look(self, q: np.ndarray, twist: np.ndarray, now: float = 0.0) -> tuple[float, int, int, float]:
        vectors, inverse = np.eye(self.m)[[0, -1]], np.zeros((self.n, self.m))
        for _ in range(20):  # as control steps do, so that the estimate of the condition number has settled
            found = look_ahead(*self.model, q, twist[: self.m], now, 0.0, 1e3, 1e4, vectors, inverse)
        np.testing.assert_allclose(
            (self.weights[:, None] * self.rows(q)) @ inverse, np.eye(self.m), atol=1e-4
        )  # kept from being singular by a ten millionth
        return found


ARMS = {name: Arm(robot) for name, robot in ROBOTS.items()}
# Damping keeps the inverse from being singular; at the condition numbers here it takes less than a thousandth.
EXACT = 1e-3


@pytest.mark.parametrize("name", list(ROBOTS))
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=25, deadline=None)
def test_joint_velocities_give_the_twist(name: str, seed: int) -> None:
    each, rng = ARMS[name], np.random.default_rng(seed)
    lower, upper = np.maximum(each.arm.lower, -3.0), np.minimum(each.arm.upper, 3.0)
    q, twist = rng.uniform(lower, upper), rng.normal(size=each.m) * 0.1
    if condition_number(each.rows(q), LENGTH) > STOP_AT:
        return
    found = joint_velocities(*each.model, q, twist)
    np.testing.assert_allclose(each.rows(q) @ found, twist, atol=EXACT * np.linalg.norm(twist))


def test_a_spare_joint_lets_another_stay_off_its_end() -> None:
    each = ARMS["baxter"]
    q, twist = each.arm.home.copy(), np.array([0.1, 0.0, 0.1, 0.0, 0.0, 0.0])
    far = joint_velocities(*each.model, q, twist)
    limits = each.model[4].copy()
    spare = np.linalg.svd(each.rows(q))[2][-1]  # how the joints move when the tool does not
    joint = int(np.argmax(np.abs(far * spare)))
    limits[4 if far[joint] > 0.0 else 3, joint] = q[joint] + np.sign(far[joint]) * 1e-3
    near = joint_velocities(*each.model[:4], limits, q, twist)
    np.testing.assert_allclose(each.rows(q) @ near, twist, atol=1e-5)
    gain = 0.4 * each.arm.jerk[joint] / each.arm.acceleration[joint]
    assert abs(near[joint]) <= ROOM * gain * 1e-3 + 1e-9 < abs(far[joint])


@pytest.mark.parametrize("name", list(ROBOTS))
def test_slow_motion_from_home_is_free(name: str) -> None:
    each = ARMS[name]
    part, why, _, condition = each.look(each.arm.home, np.array([0.0, 0.02, 0.0, 0.0, 0.0, 0.0]))
    assert (part, why) == (1.0, FREE)
    # By iteration; what is left of the error is squared in the value.
    assert condition == pytest.approx(condition_number(each.rows(each.arm.home), LENGTH), rel=1e-3)


def test_a_fast_motion_is_held_to_the_fastest_joint() -> None:
    each = ARMS["mico_segway"]
    part, why, joint, _ = each.look(each.arm.home, np.array([0.0, 1.5, 0.0, 0.0, 0.0, 0.0]))
    assert why == VELOCITY
    speeds = joint_velocities(*each.model, each.arm.home, part * np.array([0.0, 1.5, 0.0, 0.0, 0.0, 0.0]))
    # The limit may lie ahead; here, it is not passed.
    assert abs(speeds[joint]) <= FASTEST * each.arm.velocity[joint] * (1.0 + 1e-9)


def test_a_position_limit_ahead_slows_early_and_is_left_freely() -> None:
    each = ARMS["three_dof"]
    q = each.arm.home.copy()
    toward = each.rows(q)[:, 2] * 1.0  # the twist that the last joint gives at 1 rad/s
    twist = np.append(toward, np.zeros(3))
    limits = each.model[4].copy()
    parts = []
    for distance in (0.6, 0.2, 0.05, 0.01, 0.0):
        limits[4, 2] = q[2] + distance
        model = (*each.model[:4], limits)
        vectors, inverse = np.eye(3)[[0, -1]], np.zeros((3, 3))
        part, why, joint, _ = look_ahead(*model, q, twist[:3], 1.0, 0.0, 1e3, 1e4, vectors, inverse)
        parts.append(part)
        assert (why, joint) == (POSITION, 2) if part < 1.0 else why == FREE
        back = look_ahead(*model, q, -twist[:3], 0.0, 0.0, 1e3, 1e4, vectors, inverse)
        assert back[0] == 1.0
    assert parts[0] == 1.0 and parts[-1] == 0.0
    assert all(before > after for before, after in zip(parts[1:], parts[2:], strict=False))


def test_a_singular_posture_stops_what_leads_in_and_nothing_that_leads_out() -> None:
    each = ARMS["baxter"]
    straight = np.array([0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0])  # nearly stretched
    axis = np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]) * 0.05
    ways = {}
    for sign in (1.0, -1.0):
        part, why, _, condition = each.look(straight, sign * axis)
        ways[part < 1.0] = why
        assert condition > 15.0
    assert ways == {True: SINGULARITY, False: FREE}
