import numpy as np
import pytest

from robots import load_robot
from teleop import Demo
from teleop.demo_stops import Stop, least_time_to_rest, stops_of


def test_the_least_time_is_that_of_acceleration_and_jerk() -> None:
    robot = load_robot("three_dof")
    speed, limit, jerk = 1.5, float(robot.acceleration[0]), float(robot.jerk[0])
    velocity = np.array([speed, 0.0, 0.0])
    # A trapezium of acceleration: v / a + a / j, where there is time to reach the limit (v >= a^2 / j).
    assert speed >= limit**2 / jerk
    assert least_time_to_rest(robot, velocity, np.zeros(3)) == pytest.approx(speed / limit + limit / jerk)
    # While it still gathers speed it takes longer, while it brakes already less.
    assert least_time_to_rest(robot, velocity, np.array([limit, 0.0, 0.0])) > speed / limit + limit / jerk
    assert least_time_to_rest(robot, velocity, np.array([-limit, 0.0, 0.0])) < speed / limit + limit / jerk
    assert least_time_to_rest(robot, np.zeros(3), np.zeros(3)) == 0.0


def test_a_base_on_wheels_counts_too() -> None:
    robot = load_robot("mico_segway")
    assert robot.drive is not None
    n = len(robot.joint_names)
    velocity = np.zeros(n + 2)
    velocity[n] = robot.drive.speed
    assert least_time_to_rest(robot, velocity, np.zeros(n + 2)) > 0.0
    assert least_time_to_rest(robot, velocity[:n], np.zeros(n)) == 0.0


def test_a_stop_says_how_long_each_part_took() -> None:
    stop = Stop("the page is silent", braking=1.5, last_input=1.4, rest=1.7, needed=0.19)
    assert (stop.delay, stop.taken) == (pytest.approx(0.1), pytest.approx(0.2))
    assert Stop("stop", 1.5, None, None, 0.1).delay is None
    assert Stop("stop", 1.5, None, None, 0.1).taken is None


def test_a_demo_of_the_board_arms_own_session_tells_of_none(small_demo: Demo) -> None:
    assert small_demo.drive is None
    assert stops_of(small_demo) == ()
