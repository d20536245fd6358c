"""A hand to drive the arm with: straight lines by the Jacobian, nothing but joint velocities."""

from collections.abc import Callable

import numpy as np
import pytest

from robots.pose import FloatArray
from twin import JointCommand, World

SPEED = 0.25
"""Tool speed of the drives [m/s]."""


class Hand:
    """Drives a world's arm; `each_step` is called after every step."""

    def __init__(self, world: World, each_step: Callable[[World], None] = lambda world: None) -> None:
        self.world = world
        self.each_step = each_step
        self.opening = 0.0 if world.state().gripper_closed else world.robot.gripper.max_opening

    def wait(self, steps: int) -> None:
        for _ in range(steps):
            self._step(np.zeros(3))

    def grip(self, opening: float) -> None:
        self.opening = opening
        self.wait(96)

    def move(self, goal: FloatArray, speed: float = SPEED) -> None:
        """Go straight to a tool position (3,) [m] and stop there."""
        goal = np.asarray(goal, dtype=float)
        for _ in range(4000):
            position, jacobian = self.world.robot.position_and_jacobian(self.world.state().q)
            error = goal - position
            distance = float(np.linalg.norm(error))
            if distance < 2e-4:
                self.wait(12)
                return
            # Slows down over the last centimetres, as a person does.
            velocity = error / distance * min(speed, 8 * distance)
            self._step(np.linalg.solve(jacobian[:3], velocity))
        raise AssertionError(f"the tool did not reach {goal}: {distance} m away")

    def _step(self, velocity: FloatArray) -> None:
        self.world.step(JointCommand(velocity, self.opening))
        self.each_step(self.world)


@pytest.fixture
def hand() -> type[Hand]:
    return Hand
