"""A scripted person who drives any robot: reaches for things, grasps, carries, lets go, rolls about."""

import math
from collections.abc import Iterator

import numpy as np

from robots.model import RobotModel
from robots.pose import FloatArray
from teleop.drive_command import ArmWish, DriveCommand
from teleop.gamepad_mapping import GripperWish
from twin.scene_spec import SceneSpec
from twin.state import WorldState

LOOK_EVERY = 4
"""Control steps between two looks: 60 Hz, as devices report."""
SPEED = 0.18
"""Speed of the hand at full deflection [m/s]."""
GAIN = 2.5
"""How soon it slows down before a goal [1/s]."""
NEAR = 0.015
"""Nearer is there [m]."""
PATIENCE = 4.0
"""It gives a motion up after this time [s]."""
TREMBLE = 0.01
"""How much the thumb strays [m/s]."""

_Wish = tuple[FloatArray, GripperWish]


class ScriptedDriver:
    """Drives one arm after another towards things of the scene, and the base now and then.

    Attributes:
        done: Whether it has put the device down.
    """

    def __init__(self, robot: RobotModel, spec: SceneSpec, rng: np.random.Generator, reaches: int = 1) -> None:
        """Plan what to do.

        Args:
            robot: The robot.
            spec: Its scene.
            rng: Source of all its choices and its tremble.
            reaches: How many things it reaches for.
        """
        self.done = False
        self._robot, self._spec, self._rng = robot, spec, rng
        self._state: WorldState
        self._names = tuple(robot.arms)
        self._arm = 0
        self._strayed = np.zeros(3)
        self._base = (0.0, 0.0)
        self._script = self._do(reaches)

    def act(self, state: WorldState) -> DriveCommand:
        """Look at the world and say what is wanted now; call at 60 Hz."""
        self._state = state
        velocity, gripper = next(self._script, (np.zeros(3), "keep"))
        if self.done:
            return DriveCommand()
        self._strayed = 0.9 * self._strayed + self._rng.normal(0.0, TREMBLE * 0.4, 3)
        if velocity.any():
            velocity = velocity + self._strayed
        x, y, z = velocity.tolist()
        wish = ArmWish((x, y, z, 0.0, 0.0, 0.0), gripper=gripper)
        return DriveCommand({self._names[self._arm]: wish}, self._base)

    def _do(self, reaches: int) -> Iterator[_Wish]:
        things = [each.id for each in self._spec.objects]
        for _ in range(reaches):
            if self._robot.drive is not None:
                yield from self._roll()
            goal = self._place(int(self._rng.choice(things))) if things else self._tool() + 0.1
            self._arm = self._nearest(goal)
            above = float(self._rng.uniform(0.08, 0.16))
            yield from self._towards(goal + [0.0, 0.0, above])
            yield from self._towards(goal)
            yield from self._grip("close")
            yield from self._towards(goal + [0.0, 0.0, above])
            yield from self._towards(goal + np.append(self._rng.uniform(-0.15, 0.15, 2), above))
            yield from self._grip("open")
        self.done = True

    def _roll(self) -> Iterator[_Wish]:
        """A little way on the wheels."""
        self._base = (float(self._rng.uniform(-0.15, 0.15)), float(self._rng.uniform(-0.4, 0.4)))
        yield from self._rest(1.0)
        self._base = (0.0, 0.0)
        yield from self._rest(0.3)

    def _towards(self, goal: FloatArray) -> Iterator[_Wish]:
        give_up = self._state.time + PATIENCE
        while self._state.time < give_up:
            off = goal - self._tool()
            distance = math.sqrt(float(off @ off))
            if distance < NEAR:
                return
            yield off / distance * min(SPEED, GAIN * distance), "keep"

    def _grip(self, wish: GripperWish) -> Iterator[_Wish]:
        yield np.zeros(3), wish
        yield from self._rest(0.6)

    def _rest(self, seconds: float) -> Iterator[_Wish]:
        until = self._state.time + seconds
        while self._state.time < until:
            yield np.zeros(3), "keep"

    def _place(self, identity: int) -> FloatArray:
        return next(each.pose_object_in_world.position.copy() for each in self._state.objects if each.id == identity)

    def _tool(self) -> FloatArray:
        return self._state.arms[self._arm].pose_tool_in_world.position

    def _nearest(self, goal: FloatArray) -> int:
        tools = [arm.pose_tool_in_world.position for arm in self._state.arms]
        return int(np.argmin([float(np.linalg.norm(tool - goal)) for tool in tools]))
