"""Playing a demo again, and checking that its inputs lead where they led."""

import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robots.pose import FloatArray
from twin.state import WorldState
from twin.world import World

from .demo import Demo
from .demo_reader import load_demo
from .session import Session

TOLERANCE = 1e-6
"""Largest accepted difference between a recorded state and the one simulated afresh [m, rad, rad/s]."""


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """How a demo compares with its inputs simulated afresh.

    Attributes:
        path: The demo.
        max_error: Largest absolute difference over all recorded states and executed commands [m, rad, m/s, rad/s].
        worst: What differs most, such as `object_positions`.
        worst_time: When it does [s].
        states: Number of states compared.
        simulated: Simulated time [s].
        wall: Time it took [s].
        complete: False where the demo ends early; what was recovered was compared.
    """

    path: Path
    max_error: float
    worst: str
    worst_time: float
    states: int
    simulated: float
    wall: float
    complete: bool

    @property
    def success(self) -> bool:
        """Whether every recorded state was reached to 1e-6."""
        return self.max_error <= TOLERANCE

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds a second."""
        return self.simulated / self.wall if self.wall > 0.0 else float("inf")


def check_replay(demo: str | Path | Demo) -> ReplayReport:
    """Simulate a demo's recorded gamepad inputs afresh and compare with its recorded states.

    A new world is made from the metadata; saved states are compared with, never restored.

    Raises:
        DemoError: The file is not a demo.
        RobotError: The demo's robot is not here.
    """
    if not isinstance(demo, Demo):
        demo = load_demo(demo)
    worst = _Worst()
    moments = {int(step): row for row, step in enumerate(demo.states.steps)}
    compared = 0
    started = time.perf_counter()
    with World.from_scene(demo.scene) as world:
        session = Session(world, demo.mapping)
        for step in range(len(demo.inputs) + 1):
            if step in moments:
                worst.compare_state(demo, moments[step], world.state())
                compared += 1
            if step < len(demo.inputs):
                result = session.step(demo.inputs.gamepad(step))
                worst.note("executed", step * world.DT, demo.commands.executed[step] - result.executed)
        simulated = world.time
    wall = time.perf_counter() - started
    return ReplayReport(demo.path, worst.error, worst.what, worst.time, compared, simulated, wall, demo.complete)


class _Worst:
    """The largest difference so far."""

    def __init__(self) -> None:
        self.error, self.what, self.time = 0.0, "nothing", 0.0

    def note(self, what: str, moment: float, difference: FloatArray | float) -> None:
        error = float(np.max(np.abs(difference), initial=0.0))
        if not error <= self.error:  # NaN counts as worst
            self.error, self.what, self.time = error, what, moment

    def compare_state(self, demo: Demo, row: int, state: WorldState) -> None:
        recorded, moment = demo.states, state.time
        tool = state.pose_tool_in_world
        poses = [each.pose_object_in_world for each in state.objects]
        self.note("time", moment, recorded.times[row] - state.time)
        self.note("q", moment, recorded.q[row] - state.q)
        self.note("dq", moment, recorded.dq[row] - state.dq)
        self.note("tool", moment, recorded.tool[row] - np.concatenate((tool.position, tool.orientation_xyzw)))
        self.note("gripper_opening", moment, recorded.gripper_opening[row] - state.gripper_opening)
        self.note("gripper_closed", moment, float(recorded.gripper_closed[row]) - float(state.gripper_closed))
        if poses:
            positions = np.array([pose.position for pose in poses])
            orientations = np.array([pose.orientation_xyzw for pose in poses])
            self.note("object_positions", moment, recorded.object_positions[row] - positions)
            self.note("object_orientations", moment, recorded.object_orientations[row] - orientations)
