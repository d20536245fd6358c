"""Playing a demo again, and checking that its inputs lead where they led: the replay certificate."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from robots.pose import FloatArray, Pose
from twin.state import WorldState
from twin.world import World

from .code_version import differences
from .demo import Demo, InputTrack
from .demo_reader import load_demo
from .drive_command import DriveCommand
from .errors import DemoError
from .event_watch import DriveOutcome
from .session import Session

TOLERANCE = 1e-6
"""Largest accepted difference between a recorded state and the one simulated afresh [m, rad, rad/s]."""

Drive = Callable[[DriveCommand], DriveOutcome]
"""One control step of a whole robot: limits a command and executes it."""
MakeDrive = Callable[[World, Demo], Drive]
"""Gives what drives a world as the demo's was driven."""


@dataclass(frozen=True, slots=True)
class ReplayReport:
    """How a demo compares with its inputs simulated afresh.

    Attributes:
        path: The demo.
        max_error: Largest absolute difference over all recorded states and executed commands [m, rad, m/s, rad/s].
        worst: What differs most, such as `object_positions`.
        worst_time: When it does, in the demo [s].
        states: Number of states compared.
        simulated: Simulated time [s].
        wall: Time it took [s].
        complete: False where the demo ends early; what was recovered was compared.
        prelude: Simulated time before the first compared state of a trimmed demo [s].
        warnings: What differs between the software that recorded the demo and what is here.
    """

    path: Path
    max_error: float
    worst: str
    worst_time: float
    states: int
    simulated: float
    wall: float
    complete: bool
    prelude: float = 0.0
    warnings: tuple[str, ...] = ()

    @property
    def success(self) -> bool:
        """Whether every recorded state was reached to 1e-6."""
        return self.max_error <= TOLERANCE

    @property
    def real_time_factor(self) -> float:
        """Simulated seconds a second."""
        return self.simulated / self.wall if self.wall > 0.0 else float("inf")


class DemoPlayer:
    """Plays a demo's recorded inputs in a new world, step by step, and compares on the way. Use it with `with`.

    The world is made from the metadata; saved states are compared with, never restored. A trimmed demo starts in the
    middle of a motion: its prelude is played when the player is made.

    Attributes:
        demo: The demo.
        world: The world in which it is played.
        prelude: Simulated time before the demo's first step [s].
        error: Largest difference so far [m, rad, m/s, rad/s].
        worst: What differs most.
        worst_time: When, in the demo [s].
        compared: States compared so far.
    """

    def __init__(self, demo: Demo, make_drive: MakeDrive | None = None) -> None:
        """Set the scene up.

        Args:
            demo: The demo.
            make_drive: For a demo of a whole robot: gives what drives the world; None takes the usual session.

        Raises:
            DemoError: A trimmed demo lacks inputs from before its start.
            RobotError: The demo's robot is not here.
        """
        self.demo = demo
        self.error, self.worst, self.worst_time, self.compared = 0.0, "nothing", 0.0, 0
        before = 0 if demo.trim is None else demo.trim.first
        if before != (0 if demo.prelude is None else len(demo.prelude)):
            raise DemoError(f"{demo.path}: starts {before} steps into {demo.trim and demo.trim.origin}, whose inputs "
                            "before that are not all here: it cannot be simulated afresh")  # fmt: skip
        self._step = 0
        self._moments = {int(step): row for row, step in enumerate(demo.states.steps)}
        self.world = World.from_scene(demo.scene)
        try:
            self._take = self._session(make_drive)
            for step in range(before):
                self._take(step, True)
            self.prelude = self.world.time
            self._compare()
        except BaseException:
            self.world.close()
            raise

    def __enter__(self) -> Self:
        """Nothing to do: a player is open from the start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close the world."""
        self.close()

    def close(self) -> None:
        """Close the world."""
        self.world.close()

    @property
    def done(self) -> bool:
        """Whether the last input was played."""
        return self._step >= len(self.demo.inputs)

    def step(self) -> None:
        """Play one recorded input and compare what is recorded of it."""
        step, commands, arms = self._step, self.demo.commands, self.demo.arm_commands
        velocity, twists, base = self._take(step, False)
        moment = step / self.demo.rate
        self._note("joint_velocity", moment, commands.joint_velocity[step] - velocity)
        if arms is None:
            self._note("executed", moment, commands.executed[step] - twists[0])
        else:
            self._note("executed", moment, arms.executed[step] - twists)
            self._note("base_executed", moment, arms.base_executed[step] - base)
        self._step += 1
        self._compare()

    def _session(
        self, make_drive: MakeDrive | None
    ) -> Callable[[int, bool], tuple[FloatArray, FloatArray, FloatArray]]:
        """What plays an input (of the prelude): gives joint velocities (n,), twists (A, 6) and the base's (2,)."""
        demo, world = self.demo, self.world
        if demo.drive is None:
            session = Session(world, demo.mapping)
            still = np.zeros(2)

            def play(step: int, prelude: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
                track = demo.prelude if prelude else demo.inputs
                if not isinstance(track, InputTrack):
                    raise DemoError(f"{demo.path}: the inputs before its start are of another kind")
                result = session.step(track.gamepad(step))
                return result.joint_velocity, result.executed[None, :], still

            return play
        drive = (make_drive or _usual_drive)(world, demo)

        def play_drive(step: int, prelude: bool) -> tuple[FloatArray, FloatArray, FloatArray]:
            track = demo.prelude if prelude else demo.drive
            if track is None or isinstance(track, InputTrack):
                raise DemoError(f"{demo.path}: the inputs before its start are of another kind")
            result = drive(track.commands[step])
            twists = np.array([each.executed for each in result.arms.values()])
            return result.joint_velocity, twists, np.asarray(result.base_twist)

        return play_drive

    def _note(self, what: str, moment: float, difference: FloatArray | float) -> None:
        error = float(np.max(np.abs(difference), initial=0.0))
        if not error <= self.error:  # NaN counts as worst
            self.error, self.worst, self.worst_time = error, what, moment

    def _compare(self) -> None:
        """Compare with the state that was recorded before this step, if one was."""
        if self._step in self._moments:
            self._compare_state(self._moments[self._step], self.world.state())
            self.compared += 1

    def _compare_state(self, row: int, state: WorldState) -> None:
        recorded, hands, base = self.demo.states, self.demo.hands, self.demo.base
        moment = state.time - self.prelude
        self._note("time", moment, recorded.times[row] - moment)
        self._note("q", moment, recorded.q[row] - state.q)
        self._note("dq", moment, recorded.dq[row] - state.dq)
        self._note("tool", moment, recorded.tool[row] - _row(state.pose_tool_in_world))
        self._note("gripper_opening", moment, recorded.gripper_opening[row] - state.gripper_opening)
        self._note("gripper_closed", moment, float(recorded.gripper_closed[row]) - float(state.gripper_closed))
        poses = [each.pose_object_in_world for each in state.objects]
        if poses:
            positions = np.array([pose.position for pose in poses])
            orientations = np.array([pose.orientation_xyzw for pose in poses])
            self._note("object_positions", moment, recorded.object_positions[row] - positions)
            self._note("object_orientations", moment, recorded.object_orientations[row] - orientations)
        if hands is not None and len(state.arms) == len(hands.names):
            tools = np.array([_row(arm.pose_tool_in_world) for arm in state.arms])
            self._note("hands", moment, hands.tools[row] - tools)
            self._note("openings", moment, hands.openings[row] - [arm.gripper_opening for arm in state.arms])
        if base is not None and state.pose_base_in_world is not None:
            self._note("base", moment, base[row] - _row(state.pose_base_in_world))


def check_replay(demo: str | Path | Demo, make_drive: MakeDrive | None = None) -> ReplayReport:
    """Simulate a demo's recorded inputs afresh and compare with its recorded states.

    A new world is made from the metadata; saved states are compared with, never restored.

    Args:
        demo: The demo, or its file.
        make_drive: As for `DemoPlayer`.

    Raises:
        DemoError: The file is not a demo.
        RobotError: The demo's robot is not here.
    """
    if not isinstance(demo, Demo):
        demo = load_demo(demo)
    started = time.perf_counter()
    with DemoPlayer(demo, make_drive) as player:
        while not player.done:
            player.step()
        simulated = player.world.time
    return ReplayReport(
        path=demo.path,
        max_error=player.error,
        worst=player.worst,
        worst_time=player.worst_time,
        states=player.compared,
        simulated=simulated,
        wall=time.perf_counter() - started,
        complete=demo.complete,
        prelude=player.prelude,
        warnings=differences(demo.versions, demo.code),
    )


def _usual_drive(world: World, demo: Demo) -> Drive:
    """The session that drives a whole robot."""
    from .drive_session import DriveSession

    return DriveSession(world).step


def _row(pose: Pose) -> FloatArray:
    """Position and quaternion xyzw, (7,)."""
    return np.concatenate((pose.position, pose.orientation_xyzw))
