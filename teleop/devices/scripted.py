"""The scripted operator as a device."""

from typing import Protocol

from teleop.gamepad import RESTING, GamepadState
from twin.scene_spec import SceneSpec
from twin.state import WorldState
from twin.world import World

from .device import DeviceBase, DeviceReading

PERIOD = 1.0 / 60.0
"""The operator looks at the world this often, in simulated time [s]."""


class Operator(Protocol):
    """Whoever holds the gamepad; `ScriptedOperator` is one."""

    @property
    def done(self) -> bool:
        """Whether the gamepad has been put down."""

    def act(self, state: WorldState, spec: SceneSpec) -> GamepadState:
        """Look at the world and say what the gamepad says now."""


class ScriptedDevice(DeviceBase):
    """An operator made of code that looks at one world, 60 times in each simulated second.

    Attributes:
        operator: The operator.
        world: The world it looks at.
    """

    def __init__(self, operator: Operator, world: World, name: str = "scripted operator") -> None:
        """Hand the operator the gamepad.

        Args:
            operator: The operator.
            world: The world it looks at.
            name: What it is called in messages.
        """
        self.operator = operator
        self.world = world
        self._name = name
        self._gamepad = RESTING
        self._next = 0
        self._seen = 0.0
        self._open = True

    @property
    def done(self) -> bool:
        """Whether the operator has put the gamepad down."""
        return self.operator.done

    def poll(self, now: float) -> DeviceReading:
        """Say what the operator's gamepad says; an operator that fails is a reading that is not connected."""
        if not self._open:
            return DeviceReading(RESTING, self._seen, False, self._name, f"the {self._name} was closed")
        step = round(self.world.time / self.world.DT)
        every = max(round(PERIOD / self.world.DT), 1)
        if step >= self._next:
            self._next = step - step % every + every
            try:
                self._gamepad = self.operator.act(self.world.state(), self.world.spec)
            except Exception as error:  # whatever fails in it must brake the robot, not the loop
                self._open = False
                fault = f"the {self._name} failed: {type(error).__name__}: {error}"
                return DeviceReading(RESTING, self._seen, False, self._name, fault)
        self._seen = now
        return DeviceReading(self._gamepad, now, True, self._name)

    def close(self) -> None:
        """Take the gamepad away."""
        self._open = False
