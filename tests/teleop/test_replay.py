from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from teleop import Demo, DemoError, IncompleteDemoWarning, check_replay, load_demo


def test_inputs_simulated_afresh_reach_the_recorded_states_exactly(small_demo: Demo) -> None:
    report = check_replay(small_demo.path)
    assert report.max_error == 0.0  # same machine, same libraries: bit for bit
    assert report.success
    assert report.states == len(small_demo.times)
    assert report.simulated == pytest.approx(small_demo.duration, abs=1e-9)
    assert report.real_time_factor > 0.0


def test_a_recovered_demo_replays_exactly_too(small_demo: Demo, demo_bytes: bytes, tmp_path: Path) -> None:
    path = tmp_path / "half.mcap"
    path.write_bytes(demo_bytes[: len(demo_bytes) // 2])
    with pytest.warns(IncompleteDemoWarning, match="ends early"):
        report = check_replay(path)
    assert (report.max_error, report.complete) == (0.0, False)
    assert 0 < report.states < len(small_demo.times)


def test_changed_inputs_do_not_pass(small_demo: Demo) -> None:
    axes = small_demo.inputs.axes.copy()
    axes[100:140] += 0.2
    changed = replace(small_demo, inputs=replace(small_demo.inputs, axes=np.clip(axes, -1, 1)))
    report = check_replay(changed)
    assert not report.success
    assert report.max_error > 1e-3


def test_changed_states_do_not_pass(small_demo: Demo) -> None:
    positions = small_demo.states.object_positions.copy()
    positions[-1, 1, 2] += 2e-6
    changed = replace(small_demo, states=replace(small_demo.states, object_positions=positions))
    report = check_replay(changed)
    assert not report.success
    assert (report.worst, report.worst_time) == ("object_positions", pytest.approx(small_demo.duration))


def test_a_missing_demo_is_named(tmp_path: Path) -> None:
    with pytest.raises(DemoError, match=r"x\.mcap: cannot be read"):
        check_replay(tmp_path / "x.mcap")


def test_every_step_of_a_demo_went_through_mapping_and_servo(small_demo: Demo) -> None:
    demo = load_demo(small_demo.path)
    asked = [demo.mapping.command(demo.inputs.gamepad(step)).twist for step in range(len(demo.inputs))]
    np.testing.assert_array_equal(demo.commands.asked, asked)
    assert demo.rate == 240
    assert np.diff(demo.times).max() <= 1 / 30 + 1e-12
    # Between two recorded states the joints turned by what was executed; the motors follow to well under a milliradian.
    for row in range(len(demo.times) - 1):
        steps = slice(demo.states.steps[row], demo.states.steps[row + 1])
        turned = demo.commands.joint_velocity[steps].sum(axis=0) / demo.rate
        np.testing.assert_allclose(demo.states.q[row + 1] - demo.states.q[row], turned, atol=2e-3)
