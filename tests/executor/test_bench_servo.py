"""A small sample of the servo's benchmark, with all of its judges."""

import numpy as np
import pytest

from executor.bench import servo, servo_lines
from teleop.servo_brakes import ServoBrakes


@pytest.fixture(autouse=True)
def short(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(servo, "CHUNK", 360)
    monkeypatch.setattr(servo, "EPISODE", 120)
    monkeypatch.setattr(servo_lines, "STARTS", 1)
    monkeypatch.setattr(servo_lines, "SPEEDS", (0.3,))


@pytest.mark.parametrize("robot", ["three_dof", "baxter", "mico_segway"])
def test_no_limit_is_broken_and_nothing_is_stuck(robot: str) -> None:
    report = servo.run(3, 360, [robot], jobs=1)
    figures = report.figures
    assert figures[f"{robot}.steps"] == 360
    assert (figures[f"{robot}.violations"], figures[f"{robot}.stuck"], report.notes) == (0, 0, ())
    distance = figures[f"{robot}.min_distance_mm"]
    assert distance is not None and distance > 5.0
    drift, turned = figures[f"{robot}.drift_mm"], figures[f"{robot}.drift_deg"]
    assert drift is not None and turned is not None and drift < 1.0 and turned < 0.2  # what the project promises


def test_a_servo_that_changes_speeds_at_once_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def at_once(self: ServoBrakes, state: object, target: list[float], dt: float) -> object:
        return tuple(target), (0.0,) * len(target)

    monkeypatch.setattr(ServoBrakes, "together", at_once)
    monkeypatch.setattr(ServoBrakes, "after", at_once)
    report = servo.run(3, 360, ["three_dof"], jobs=1)
    violations = report.figures["three_dof.violations"]
    assert violations is not None and violations > 0
    assert any("jerk" in note for note in report.notes)


def test_tasks_cover_the_steps_that_were_asked_for() -> None:
    assert [servo.chunks(steps) for steps in (1, 360, 361)] == [1, 1, 2]
    assert np.isclose(servo.DT * 240, 1.0)
