import json
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from robots.pose import Pose
from teleop import Demo, DemoError, GamepadMapping, GamepadState, IncompleteDemoWarning, Recorder, load_demo
from teleop.demo_format import SCHEMAS
from teleop.servo import ServoReason, ServoResult
from twin import ObjectState, SceneSpec, WorldState

RATE = 240
AWKWARD = np.array([0.1, 1 / 3, -(2.0**-1074), 1e308, np.nextafter(1.0, 2.0), -0.0, 5e-324])
"""Floats that a careless decimal notation would not bring back."""


def result_of(rng: np.random.Generator) -> ServoResult:
    return ServoResult(rng.normal(size=6), rng.normal(size=6), rng.normal(size=3), ServoReason.VELOCITY_LIMIT, "elbow")


def state_of(step: int, rng: np.random.Generator) -> WorldState:
    return WorldState(
        time=step / RATE,
        q=rng.normal(size=3) * AWKWARD[:3],
        dq=AWKWARD[3:6],
        gripper_opening=float(rng.random()),
        gripper_closed=bool(step % 16),
        pose_tool_in_world=Pose(rng.normal(size=3), rng.normal(size=4)),
        objects=tuple(ObjectState(number, Pose(rng.normal(size=3), rng.normal(size=4))) for number in (7, 3)),
        held=None if step % 24 else 3,
    )


def test_floats_come_back_exactly(tmp_path: Path, small_scene: SceneSpec) -> None:
    rng = np.random.default_rng(0)
    pads = [GamepadState(tuple(rng.uniform(-1, 1, 4)), tuple(rng.random(17))) for _ in range(20)]
    results = [result_of(rng) for _ in range(20)]
    states = {step: state_of(step, rng) for step in (0, 8, 16, 20)}
    path = tmp_path / "exact.mcap"
    with Recorder(path, small_scene, GamepadMapping(expo=0.1), RATE) as recorder:
        recorder.utterance("first sentence")
        recorder.utterance("zweiter Satz, größer")
        for step, (pad, result) in enumerate(zip(pads, results, strict=True)):
            if step in states:
                recorder.state(step, states[step])
            recorder.control(step, pad, result, 0.048)
        recorder.state(20, states[20])
    demo = load_demo(path)
    assert demo.complete
    assert demo.scene == small_scene
    assert demo.mapping == GamepadMapping(expo=0.1)
    assert demo.utterances == ("first sentence", "zweiter Satz, größer")
    assert [demo.inputs.gamepad(step) for step in range(20)] == pads
    np.testing.assert_array_equal(demo.commands.asked, [each.asked for each in results])
    np.testing.assert_array_equal(demo.commands.executed, [each.executed for each in results])
    np.testing.assert_array_equal(demo.commands.joint_velocity, [each.joint_velocity for each in results])
    assert set(demo.commands.reasons) == {"velocity limit"}
    track = list(states.values())
    np.testing.assert_array_equal(demo.states.steps, list(states))
    np.testing.assert_array_equal(demo.times, [each.time for each in track])
    np.testing.assert_array_equal(demo.states.q, [each.q for each in track])
    assert demo.states.q.tobytes() == np.array([each.q for each in track]).tobytes()  # signs of zero too
    np.testing.assert_array_equal(demo.states.dq, [each.dq for each in track])
    np.testing.assert_array_equal(demo.states.tool[:, :3], [each.pose_tool_in_world.position for each in track])
    np.testing.assert_array_equal(demo.states.tool[:, 3:], [each.pose_tool_in_world.orientation_xyzw for each in track])
    np.testing.assert_array_equal(demo.states.object_ids, [7, 3])
    np.testing.assert_array_equal(
        demo.states.object_positions,
        [[thing.pose_object_in_world.position for thing in each.objects] for each in track],
    )
    np.testing.assert_array_equal(demo.states.held, [3, -1, -1, -1])
    np.testing.assert_array_equal(demo.states.gripper_closed, [False, True, False, True])


def test_a_broken_devices_nan_comes_back_as_nan(tmp_path: Path, small_scene: SceneSpec) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "nan.mcap"
    with Recorder(path, small_scene, GamepadMapping(), RATE) as recorder:
        recorder.state(0, state_of(0, rng))
        recorder.control(0, GamepadState.from_controls(left_x=float("nan"), a=1.0), result_of(rng), 0.0)
    inputs = load_demo(path).inputs
    assert np.isnan(inputs.axes[0, 0])
    assert "left_x" in inputs.gamepad(0).fault()


def test_other_readers_find_topics_schemas_and_metadata(small_demo: Demo) -> None:
    with Path(small_demo.path).open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None
        assert {channel.topic: channel.message_encoding for channel in summary.channels.values()} == dict.fromkeys(
            SCHEMAS, "json"
        )
        for schema in summary.schemas.values():
            assert schema.encoding == "jsonschema"
            assert json.loads(schema.data)["type"] == "object"
        for schema, channel, message in reader.iter_messages():
            assert schema is not None
            content, declared = json.loads(message.data), json.loads(schema.data)
            assert set(content) == set(declared["required"]), channel.topic
            # Messages in time order, on the one clock of the control steps.
            assert message.log_time == content["step"] * 1_000_000_000 // RATE
        (metadata,) = reader.iter_metadata()
        assert json.loads(metadata.metadata["units"])["length"] == "m"
        assert metadata.metadata["robot"] == "three_dof"
        assert {"pybullet", "ruckig", "pin"} <= set(json.loads(metadata.metadata["versions"]))


def test_chunks_are_closed_at_least_once_a_second(small_demo: Demo) -> None:
    with Path(small_demo.path).open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    spans = [chunk.message_end_time - chunk.message_start_time for chunk in summary.chunk_indexes]
    assert len(spans) >= small_demo.duration
    assert max(spans) <= 1_000_000_000


def test_a_crash_loses_at_most_the_last_second(tmp_path: Path, small_scene: SceneSpec) -> None:
    rng = np.random.default_rng(0)
    path, steps = tmp_path / "crash.mcap", 700
    recorder = Recorder(path, small_scene, GamepadMapping(), RATE)
    for step in range(steps):
        if step % 8 == 0:
            recorder.state(step, state_of(step, rng))
        recorder.control(step, GamepadState(), result_of(rng), 0.0)
    assert recorder.sync()  # it went faster than real time; the disk's thread catches up
    # The process would end here: what the system already has is all there is.
    left = tmp_path / "left.mcap"
    left.write_bytes(path.read_bytes())
    recorder.abandon()
    with pytest.warns(IncompleteDemoWarning, match=r"left\.mcap: ends early; recovered 2\.\d s"):
        demo = load_demo(left)
    assert not demo.complete
    assert steps - len(demo.inputs) <= RATE


def test_leaving_through_an_exception_keeps_everything_but_says_so(tmp_path: Path, small_scene: SceneSpec) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "stopped.mcap"
    with (
        pytest.raises(KeyboardInterrupt, match="stop"),
        Recorder(path, small_scene, GamepadMapping(), RATE) as recorder,
    ):
        recorder.state(0, state_of(0, rng))
        for step in range(13):
            recorder.control(step, GamepadState(), result_of(rng), 0.0)
        raise KeyboardInterrupt("stop")
    with pytest.warns(IncompleteDemoWarning, match="ends early"):
        demo = load_demo(path)
    assert len(demo.inputs) == 13


def test_a_full_disk_is_told_in_one_line(small_scene: SceneSpec) -> None:
    full = Path("/dev/full")
    if not full.exists():
        pytest.skip("this system has no /dev/full")
    with pytest.raises(DemoError, match="^/dev/full: cannot be written on: No space left on device; what was recorded"):
        Recorder(full, small_scene, GamepadMapping(), RATE)


def test_a_place_that_cannot_be_written(tmp_path: Path, small_scene: SceneSpec) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(DemoError, match="cannot be written: "):
        Recorder(tmp_path / "file" / "x.mcap", small_scene, GamepadMapping(), RATE)
