"""The reference pose: held across the motion, never along it."""

import numpy as np

from teleop.arm_reference import GAIN, LEASH, ReferencePose

LEVEL = np.eye(3)
DT = 0.01


def test_what_lags_behind_along_the_motion_is_not_made_up_for() -> None:
    reference, twist = ReferencePose(), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(reference.correction(np.zeros(3), LEVEL, twist), np.zeros(6))
    reference.move_on(twist, DT)
    np.testing.assert_allclose(reference.correction(np.zeros(3), LEVEL, twist), np.zeros(6), atol=1e-15)


def test_what_is_off_across_the_motion_comes_back_and_the_line_stays_where_it_was() -> None:
    reference, twist = ReferencePose(), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
    reference.correction(np.zeros(3), LEVEL, twist)
    for step in range(1, 200):  # slowed to a tenth, and off by a millimetre all the time
        reference.move_on(twist, DT)
        position = np.array([0.1 * 0.1 * DT * step, 1e-3, 0.0])
        back = reference.correction(position, LEVEL, twist)
        np.testing.assert_allclose(back, [0.0, -GAIN * 1e-3, 0.0, 0.0, 0.0, 0.0], atol=1e-12)


def test_a_turn_that_was_not_commanded_is_turned_back() -> None:
    reference, twist = ReferencePose(), np.array([0.1, 0.0, 0.0, 0.0, 0.0, 0.0])
    reference.correction(np.zeros(3), LEVEL, twist)
    reference.move_on(twist, DT)
    angle = 0.01
    turned = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    back = reference.correction(np.zeros(3), turned, twist)
    np.testing.assert_allclose(back[3:], [0.0, 0.0, -GAIN * angle], atol=GAIN * angle**3)  # right to third order


def test_the_reference_is_on_a_leash() -> None:
    reference, still = ReferencePose(), np.zeros(6)
    reference.correction(np.zeros(3), LEVEL, still)
    reference.move_on(still, DT)
    back = reference.correction(np.array([0.0, 0.0, 0.1]), LEVEL, still)
    np.testing.assert_allclose(back, [0.0, 0.0, -GAIN * LEASH[0], 0.0, 0.0, 0.0], atol=1e-12)
    reference.forget()
    np.testing.assert_array_equal(reference.correction(np.ones(3), LEVEL, still), np.zeros(6))
