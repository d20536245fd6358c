import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots import RobotModel, load_robot
from teleop import GamepadMapping, GamepadState, Servo, ServoError, ServoReason, ServoState, TwistCommand

DT = 1 / 240
ROBOT: RobotModel = load_robot("three_dof")
N = len(ROBOT.joint_names)
ROUNDING = 1e-6
"""Relative; Ruckig accepts profiles within about 1e-8, and differences divide by dt twice."""


def run(servo: Servo, commands: list[TwistCommand], q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Positions (K + 1, n) and velocities (K + 1, n) of an arm that does what it is told, from rest."""
    positions, velocities = [q], [np.zeros(N)]
    for command in commands:
        result = servo.step(command, positions[-1], velocities[-1], DT)
        velocities.append(result.joint_velocity)
        positions.append(positions[-1] + result.joint_velocity * DT)
    return np.array(positions), np.array(velocities)


def assert_within_limits(positions: np.ndarray, velocities: np.ndarray) -> None:
    assert (positions >= ROBOT.lower).all()
    assert (positions <= ROBOT.upper).all()
    assert (np.abs(velocities) <= ROBOT.velocity * (1 + ROUNDING)).all()
    acceleration = np.diff(velocities, axis=0) / DT
    assert (np.abs(acceleration) <= ROBOT.acceleration * (1 + ROUNDING)).all()
    jerk = np.diff(np.vstack((np.zeros(N), acceleration)), axis=0) / DT
    assert (np.abs(jerk) <= ROBOT.jerk * (1 + ROUNDING)).all()


DEFLECTION = st.one_of(st.sampled_from([-1.0, 0.0, 1.0]), st.floats(-1.0, 1.0))
BROKEN = st.sampled_from([math.nan, math.inf, 7.0])
PIECE = st.tuples(st.one_of(DEFLECTION, DEFLECTION, DEFLECTION, BROKEN), DEFLECTION, DEFLECTION, st.integers(1, 150))


@settings(deadline=None, max_examples=60)
@given(
    st.lists(st.floats(0.0, 1.0), min_size=N, max_size=N),
    st.lists(PIECE, min_size=1, max_size=6),
    st.floats(0.05, 1.9),
)
def test_no_stick_input_ever_violates_a_limit(
    where: list[float], pieces: list[tuple[float, float, float, int]], top_speed: float
) -> None:
    margin = 3e-3  # inside the servo's own margin, where a real arm rests
    start = ROBOT.lower + margin + np.array(where) * (ROBOT.upper - ROBOT.lower - 2 * margin)
    mapping = GamepadMapping(top_speed=top_speed)
    commands = []
    for x, y, z, steps in pieces:
        trigger = "right_trigger" if z > 0 else "left_trigger"
        pad = GamepadState.from_controls(left_x=x, left_y=y, **{trigger: abs(z)})
        commands += [mapping.command(pad)] * steps
    assert_within_limits(*run(Servo(ROBOT), commands, start))


def test_steady_motion_executes_exactly_what_was_asked() -> None:
    servo, q = Servo(ROBOT), ROBOT.home
    command = TwistCommand((0.05, 0.02, -0.03, 0.0, 0.0, 0.0))
    reasons = []
    for _ in range(120):
        result = servo.step(command, q, np.zeros(N), DT)
        q = q + result.joint_velocity * DT
        reasons.append(result.reason)
    assert reasons[0] is ServoReason.ACCELERATION_LIMIT
    # Joint rates change along a straight line, a step's worth at a time; that is far below a hundredth of the speed.
    np.testing.assert_allclose(result.executed[:3], command.twist[:3], atol=5e-4)
    np.testing.assert_array_equal(result.asked, command.twist)


def test_at_rest_nothing_differs() -> None:
    result = Servo(ROBOT).step(TwistCommand(), ROBOT.home, np.zeros(N), DT)
    assert result.reason is ServoReason.NONE
    np.testing.assert_array_equal(result.joint_velocity, np.zeros(N))


@pytest.mark.parametrize(
    ("command", "detail"),
    [
        (TwistCommand((math.nan, 0, 0, 0, 0, 0)), "x speed is nan"),
        (TwistCommand((0, 0, 99.0, 0, 0, 0)), "z speed is 99.0, allowed -2.0..2.0"),
        (TwistCommand((0.1, 0, 0, 0, 0, 0), fault="gamepad axis left_x is nan"), "gamepad axis left_x is nan"),
    ],
)
def test_bad_input_stops_smoothly_with_its_reason(command: TwistCommand, detail: str) -> None:
    servo = Servo(ROBOT)
    moving = [TwistCommand((0.2, 0.0, 0.0, 0, 0, 0))] * 60
    positions, velocities = run(servo, moving, ROBOT.home)
    stop_positions, stop_velocities = positions, velocities
    for _ in range(80):
        result = servo.step(command, stop_positions[-1], stop_velocities[-1], DT)
        assert result.reason is ServoReason.BAD_INPUT
        assert detail in result.detail
        np.testing.assert_array_equal(result.asked, np.zeros(6))
        stop_velocities = np.vstack((stop_velocities, result.joint_velocity))
        stop_positions = np.vstack((stop_positions, stop_positions[-1] + result.joint_velocity * DT))
    assert np.abs(velocities[-1]).max() > 0.1
    np.testing.assert_allclose(stop_velocities[-1], 0.0, atol=1e-12)
    assert_within_limits(stop_positions, stop_velocities)


@pytest.mark.parametrize("joint", range(N))
@pytest.mark.parametrize("side", [-1, 1])
def test_brakes_for_a_position_limit_and_leaves_it_freely(joint: int, side: int) -> None:
    servo = Servo(ROBOT)
    q = (ROBOT.lower + ROBOT.upper) / 2
    q[2] = 1.5
    velocity, reasons = np.zeros(N), set()
    wish = np.zeros(N)
    wish[joint] = 0.8 * side
    track = [q]
    for _ in range(240 * 4):
        twist = ROBOT.jacobian(track[-1]) @ wish
        result = servo.step(TwistCommand(tuple(twist)), track[-1], velocity, DT)
        velocity = result.joint_velocity
        reasons.add((result.reason, result.detail))
        track.append(track[-1] + velocity * DT)
    limit = ROBOT.upper[joint] if side > 0 else ROBOT.lower[joint]
    assert (ServoReason.POSITION_LIMIT, ROBOT.joint_names[joint]) in reasons
    assert abs(track[-1][joint] - limit) < 0.01  # within a margin of 2 mrad and the slow end of the approach
    assert_within_limits(np.array(track), np.zeros((1, N)))
    for _ in range(60):
        twist = ROBOT.jacobian(track[-1]) @ -wish
        result = servo.step(TwistCommand(tuple(twist)), track[-1], velocity, DT)
        velocity = result.joint_velocity
        track.append(track[-1] + velocity * DT)
    assert velocity[joint] == pytest.approx(-0.8 * side, abs=0.01)
    assert result.reason in (ServoReason.NONE, ServoReason.ACCELERATION_LIMIT)


def test_outside_a_limit_only_the_way_back_is_open() -> None:
    q = ROBOT.home.copy()
    q[1] = ROBOT.upper[1] + 0.05
    q[2] = 1.5
    inward = ROBOT.jacobian(q) @ np.array([0.0, -0.5, 0.0])
    for sign, expected in ((1.0, -0.5), (-1.0, 0.0)):
        servo, velocity = Servo(ROBOT), np.zeros(N)
        for _ in range(60):
            velocity = servo.step(TwistCommand(tuple(sign * inward)), q, velocity, DT).joint_velocity
        assert velocity[1] == pytest.approx(expected, abs=1e-6)


def test_too_fast_a_wish_keeps_its_direction() -> None:
    servo, q, velocity = Servo(ROBOT), ROBOT.home, np.zeros(N)
    command = TwistCommand((0.0, 1.9, 0.0, 0, 0, 0))
    for _ in range(120):
        result = servo.step(command, q, velocity, DT)
        velocity = result.joint_velocity  # the posture stands still, so that the direction can settle
    assert result.reason is ServoReason.VELOCITY_LIMIT
    assert np.abs(result.executed[[0, 2]]).max() < 1e-9
    assert np.abs(result.joint_velocity / ROBOT.velocity).max() == pytest.approx(1.0)


def test_tool_frame_is_turned_into_the_world() -> None:
    world, tool = (
        Servo(ROBOT).step(TwistCommand((0.1, 0.05, 0.0, 0, 0, 0), frame=frame), ROBOT.home, np.zeros(N), DT)
        for frame in ("world", "tool")
    )
    # This arm's gripper does not turn: its tool frame stays parallel to the world's axes.
    np.testing.assert_allclose(tool.asked, world.asked, atol=1e-9)


def test_depends_on_its_arguments_and_state_alone() -> None:
    state = ServoState((0.1, -0.2, 0.3), (1.0, 0.0, -2.0))
    command = TwistCommand((0.1, 0.0, 0.1, 0, 0, 0))
    used = Servo(ROBOT)
    run(used, [command] * 50, ROBOT.home)
    used.reset(state)
    fresh = Servo(ROBOT, state)
    for _ in range(5):
        a, b = (servo.step(command, ROBOT.home, np.zeros(N), DT) for servo in (used, fresh))
        np.testing.assert_array_equal(a.joint_velocity, b.joint_velocity)
    assert used.state == fresh.state


@pytest.mark.parametrize(
    ("q", "dt", "message"),
    [
        (np.zeros(2), DT, "q must be 3 finite values for three_dof"),
        (np.array([0.0, np.nan, 1.0]), DT, "q must be 3 finite values"),
        (np.array([0.0, 0.0, 1.0]), 0.0, "dt is 0.0, allowed above 0"),
    ],
)
def test_wrong_measurements_are_refused(q: np.ndarray, dt: float, message: str) -> None:
    with pytest.raises(ServoError, match=message):
        Servo(ROBOT).step(TwistCommand(), q, np.zeros(N), dt)
