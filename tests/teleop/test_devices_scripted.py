import numpy as np

from teleop import ScriptedOperator, Task
from teleop.devices.scripted import ScriptedDevice
from teleop.gamepad import RESTING, GamepadState
from teleop.record import INPUT_EVERY
from teleop.session import Session
from twin import SceneSpec, World
from twin.board import cell_centre
from twin.state import WorldState


def test_it_says_exactly_what_the_operator_does(small_scene: SceneSpec) -> None:
    """The device looks when `record_demo` looks, so the same seed moves the sticks the same way."""

    def operator() -> ScriptedOperator:
        return ScriptedOperator(Task(0, cell_centre(5, 2, 1)), np.random.default_rng(1))

    said: list[list[GamepadState]] = [[], []]
    with World.from_scene(small_scene) as world:
        session, person, gamepad = Session(world), operator(), RESTING
        for step in range(480):  # 2 s
            if step % INPUT_EVERY == 0:
                gamepad = person.act(world.state(), world.spec)
            said[0].append(gamepad)
            session.step(gamepad)
    with World.from_scene(small_scene) as world, ScriptedDevice(operator(), world) as device:
        session = Session(world)
        for step in range(480):
            reading = device.poll(float(step))
            assert (reading.connected, reading.timestamp, reading.fault) == (True, float(step), "")
            said[1].append(reading.gamepad)
            session.step(reading.gamepad)
    assert said[0] == said[1]
    assert any(state != RESTING for state in said[0])


class Failing:
    """An operator with a mistake in it."""

    done = False

    def act(self, state: WorldState, spec: SceneSpec) -> GamepadState:
        raise RuntimeError("no hands")


def test_an_operator_that_fails_is_a_lost_device(small_scene: SceneSpec) -> None:
    with World.from_scene(small_scene) as world, ScriptedDevice(Failing(), world) as device:
        for now in (1.0, 2.0):
            reading = device.poll(now)
            assert (reading.gamepad, reading.connected) == (RESTING, False)
        assert "the scripted operator" in reading.fault
