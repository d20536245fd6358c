from pathlib import Path

import numpy as np
import pytest

from teleop import Demo, GamepadMapping, GamepadState, ScriptedOperator, Task, TeleopError, record_demo, truth_path
from twin import JointCommand, SceneSpec, World, WorldState


class Pusher:
    """Holds the stick up and never puts the gamepad down."""

    done = False

    def __init__(self) -> None:
        self.looks: list[float] = []

    def act(self, state: WorldState, spec: SceneSpec) -> GamepadState:
        self.looks.append(state.time)
        return GamepadState.from_controls(left_y=-1.0)


def test_ends_after_the_longest_time_and_looks_at_60_hz(small_scene: SceneSpec, tmp_path: Path) -> None:
    pusher = Pusher()
    mapping = GamepadMapping(top_speed=0.1)
    with World.from_scene(small_scene) as world:
        demo = record_demo(world, pusher, tmp_path / "push.mcap", mapping=mapping, longest=0.5)
    assert demo.duration == 0.5
    assert demo.complete
    assert demo.mapping == mapping
    np.testing.assert_allclose(np.diff(pusher.looks), 1 / 60)
    assert demo.states.tool[-1, 0] - demo.states.tool[0, 0] == pytest.approx(0.05, abs=0.015)  # 0.1 m/s, less the start


def test_the_recording_is_what_the_world_did(small_scene: SceneSpec, small_demo: Demo, tmp_path: Path) -> None:
    assert small_demo.utterances == ("put the red cube on the blue cube",)
    assert small_demo.scene == small_scene
    np.testing.assert_array_equal(small_demo.states.object_ids, [0, 1, 2])
    assert small_demo.states.gripper_closed.any()
    assert 0 in small_demo.states.held
    with World.from_scene(small_scene) as world:
        demo = record_demo(world, ScriptedOperator(Task(0, None), np.random.default_rng(0)), tmp_path / "take.mcap")
        state = world.state()
    np.testing.assert_array_equal(demo.states.q[-1], state.q)
    np.testing.assert_array_equal(demo.states.tool[-1, :3], state.pose_tool_in_world.position)
    assert demo.states.held[-1] == state.held == 0
    assert not truth_path(demo.path).exists()


def test_a_world_that_has_moved_is_refused(small_scene: SceneSpec, tmp_path: Path) -> None:
    with World.from_scene(small_scene) as world:
        world.step(JointCommand(np.zeros(3), 0.048))
        with pytest.raises(TeleopError, match=r"already 0\.004 s old: make a new one"):
            record_demo(world, Pusher(), tmp_path / "late.mcap")
    assert not (tmp_path / "late.mcap").exists()
