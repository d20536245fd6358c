"""What a demo keeps of robots with several arms and a base, of events and of time."""

import json
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from robots import load_robot
from robots.pose import Pose
from teleop import DemoError, GamepadMapping, GamepadState, Recorder, load_demo
from teleop.demo_events import Event, Sentence
from teleop.drive_command import ArmWish, DriveCommand
from tests.teleop.demo_drive import random_command, random_result
from twin import ArmState, SceneSpec, WorldState

RATE = 240
STILL = DriveCommand({"left": ArmWish()})


def two_armed_state(step: int, rng: np.random.Generator) -> WorldState:
    def pose() -> Pose:
        return Pose(rng.normal(size=3), rng.normal(size=4))

    arms = tuple(
        ArmState(float(rng.random()), bool(step % 16), pose(), held, rng.normal(size=6), (1.0, float(rng.normal())))
        for held in (None, 7)
    )
    one = arms[0]
    q, dq = rng.normal(size=(2, 14))
    tool = one.pose_tool_in_world
    return WorldState(step / RATE, q, dq, one.gripper_opening, one.gripper_closed, tool, (), None, None, arms, pose())


def test_both_arms_and_what_was_wanted_of_them_come_back_exactly(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    commands = [random_command(rng) for _ in range(16)]
    results = [random_result(rng) for _ in range(16)]
    states = {step: two_armed_state(step, rng) for step in (0, 8, 16)}
    path, robot = tmp_path / "two.mcap", load_robot("baxter")
    spec = SceneSpec(kind="table", robot="baxter")
    with Recorder(path, spec, GamepadMapping(), RATE, robot=robot, details={"drive_mapping": "[speed]"}) as recorder:
        for step, (command, result) in enumerate(zip(commands, results, strict=True)):
            if step in states:
                recorder.state(step, states[step])
            recorder.drive(step, GamepadState(), command, result)
        recorder.state(16, states[16])
    demo = load_demo(path)
    assert demo.drive is not None and demo.arm_commands is not None and demo.hands is not None
    assert list(demo.drive.commands) == commands
    assert demo.arm_commands.names == demo.hands.names == ("left", "right")
    asked = [[arm.asked for arm in each.arms.values()] for each in results]
    np.testing.assert_array_equal(demo.arm_commands.asked, asked)
    np.testing.assert_array_equal(demo.arm_commands.base_executed, [each.base_twist for each in results])
    np.testing.assert_array_equal(demo.arm_commands.openings, [[0.04, 0.02]] * 16)
    np.testing.assert_array_equal(demo.commands.joint_velocity, [each.joint_velocity for each in results])
    np.testing.assert_array_equal(
        demo.hands.tools[:, :, :3],
        [[arm.pose_tool_in_world.position for arm in each.arms] for each in states.values()],
    )
    np.testing.assert_array_equal(demo.hands.held, [[-1, 7]] * 3)
    np.testing.assert_array_equal(
        demo.hands.wrist_wrenches, [[arm.wrist_wrench for arm in each.arms] for each in states.values()]
    )
    assert demo.base is None  # Baxter stands still
    assert demo.metadata["drive_mapping"] == "[speed]"
    assert json.loads(demo.metadata["arms"])["right"] == list(robot.arms["right"].joint_names)


def test_a_base_on_wheels_is_recorded(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path, state = tmp_path / "wheels.mcap", two_armed_state(0, np.random.default_rng(1))
    state = replace(state, arms=state.arms[:1])
    with Recorder(path, SceneSpec(), GamepadMapping(), RATE, robot=load_robot("mico_segway")) as recorder:
        recorder.state(0, state)
        recorder.drive(0, GamepadState(), random_command(rng), random_result(rng))
    base = load_demo(path).base
    assert base is not None and state.pose_base_in_world is not None
    np.testing.assert_array_equal(base[0, :3], state.pose_base_in_world.position)


def test_what_repeats_is_read_as_one_command_and_nan_stays_nan(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "same.mcap"
    broken = DriveCommand({"left": ArmWish((float("nan"),) * 6)}, fault="left_x is nan")
    with Recorder(path, SceneSpec(), GamepadMapping(), RATE, robot=load_robot("baxter")) as recorder:
        recorder.state(0, two_armed_state(0, rng))
        for step, command in enumerate([STILL, STILL, broken]):
            recorder.drive(step, GamepadState(), command, random_result(rng))
    drive = load_demo(path).drive
    assert drive is not None
    assert drive.commands[0] is drive.commands[1]
    assert np.isnan(drive.commands[2].arms["left"].twist).all()
    assert drive.commands[2].fault == "left_x is nan"


def test_events_are_noticed_once(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "events.mcap"
    slow = {"state": "slowed", "reason": "collision"}
    steps = [
        (STILL, {}),
        (STILL, slow),
        (STILL, slow),
        (DriveCommand(STILL.arms, stop=True), {"state": "stopped", "reason": "emergency stop"}),
        (DriveCommand(STILL.arms, age=0.2), {"openings": {"left": 0.0, "right": 0.02}}),
        *[(DriveCommand(STILL.arms, age=0.3), {})] * 70,
        (STILL, {}),
    ]
    with Recorder(path, SceneSpec(), GamepadMapping(), RATE, robot=load_robot("baxter")) as recorder:
        recorder.state(0, two_armed_state(0, rng))
        for step, (command, changes) in enumerate(steps):
            recorder.drive(step, GamepadState(), command, random_result(rng, **changes))
        recorder.event("operator", "another page holds control")
        with pytest.raises(DemoError, match="of kind 'party': use one of safety, stop, device"):
            recorder.event("party", "")  # type: ignore[arg-type]
    events = load_demo(path).events
    assert [(each.step, each.kind, each.text, each.arm) for each in events] == [
        (1, "safety", "slowed: collision", ""),
        (3, "stop", "emergency stop", ""),
        (3, "safety", "stopped: emergency stop", ""),
        (4, "stop", "emergency stop released", ""),
        (4, "device", "lost: input is older than 0.1 s; the last input came 4 ms before", ""),
        (4, "gripper", "closes", "left"),
        (5, "gripper", "opens", "left"),
        (63, "safety", "ok", ""),  # a quarter of a second after the stop
        (75, "device", "found again", ""),
        (75, "operator", "another page holds control", ""),
    ]


def test_sentences_remember_when_and_the_last_outcome_counts(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "said.mcap"
    with Recorder(path, SceneSpec(), GamepadMapping(), RATE, robot=load_robot("baxter")) as recorder:
        recorder.utterance("watch")
        recorder.state(0, two_armed_state(0, rng))
        for step in range(3):
            recorder.drive(step, GamepadState(), STILL, random_result(rng))
        recorder.utterance("now")
        recorder.utterance("done", "after")
        recorder.outcome("success")
        recorder.outcome("failure", "it fell")
        with pytest.raises(DemoError, match="cannot be 'so so': use one of success, failure, unknown"):
            recorder.outcome("so so")  # type: ignore[arg-type]
    demo = load_demo(path)
    assert demo.sentences == (Sentence("watch"), Sentence("now", 2, "during"), Sentence("done", 2, "after"))
    assert demo.outcome is not None
    assert (demo.outcome.outcome, demo.outcome.note) == ("failure", "it fell")


def test_messages_carry_simulated_and_wall_clock_time(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    path = tmp_path / "time.mcap"
    before = time.time_ns()
    with Recorder(path, SceneSpec(), GamepadMapping(), RATE, robot=load_robot("baxter")) as recorder:
        recorder.state(0, two_armed_state(0, rng))
        for step in range(4):
            recorder.drive(step, GamepadState(), STILL, random_result(rng))
            time.sleep(0.01)
        recorder.event("record", "end")
    after = time.time_ns()
    demo = load_demo(path)
    assert demo.wall_ns is not None
    assert before - 1_000_000 <= demo.wall_ns[0] < demo.wall_ns[-1] <= after + 1_000_000  # the two clocks agree to 1 ms
    assert (np.diff(demo.wall_ns) >= 10_000_000).all()
    assert isinstance(demo.events[-1], Event) and demo.events[-1].wall_ns >= demo.wall_ns[-1]
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            assert message.log_time == message.sequence * 1_000_000_000 // RATE, channel.topic


def test_details_may_not_replace_the_demos_own_metadata(tmp_path: Path) -> None:
    with pytest.raises(DemoError, match="details may not be named rate, scene: these are the demo's own"):
        Recorder(tmp_path / "x.mcap", SceneSpec(), GamepadMapping(), RATE, details={"scene": "", "rate": ""})


def test_an_existing_demo_is_not_replaced_when_that_is_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "there.mcap"
    path.write_text("precious")
    with pytest.raises(DemoError, match="cannot be written: File exists"):
        Recorder(path, SceneSpec(), GamepadMapping(), RATE, exclusive=True)
    assert path.read_text() == "precious"
