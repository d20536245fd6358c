"""The arm on the twin goes where it is told, within its limits."""

from collections.abc import Iterator

import numpy as np
import pytest

from executor.errors import RefusalError
from executor.motion import TOOL_LIMITS, Motion
from executor.motion_plan import MotionPlan, MoveTool
from twin import JointCommand, SceneSpec, World, board

WAYPOINTS = [(0.10, 0.10, 0.30), (0.30, 0.30, 0.30), (0.30, 0.30, 0.06), (0.05, 0.05, 0.35), (0.375, 0.025, 0.10)]
STILL = 0.001
"""What a tool may be off a waypoint [m]: the motion itself ends within 0.2 mm, servo and gravity add the rest."""


@pytest.fixture(scope="module")
def world() -> Iterator[World]:
    with World.from_scene(SceneSpec()) as empty:
        yield empty


class Watched(World):
    """A world that keeps the commands it was given and where the tool went."""

    def step(self, command: JointCommand) -> None:
        super().step(command)
        self.commands.append(command.velocity)
        self.tools.append(self.state().pose_tool_in_world.position)

    commands: list[np.ndarray]
    tools: list[np.ndarray]


def test_every_waypoint_is_reached_within_a_millimetre(world: World) -> None:
    motion = Motion(world)
    for point in WAYPOINTS:
        arrival = motion.move_to(np.array(point))
        assert arrival.error < STILL
        np.testing.assert_allclose(world.state().pose_tool_in_world.position, point, atol=STILL)
        assert np.abs(world.state().dq).max() < 0.05  # it stands between segments


def test_commands_and_tool_stay_within_limits() -> None:
    with Watched(SceneSpec()) as world:
        world.commands, world.tools = [], []
        motion = Motion(world)
        for point in WAYPOINTS:
            motion.move_to(np.array(point))
        commands = np.array(world.commands)
        acceleration = np.diff(commands, axis=0) / world.DT
        jerk = np.diff(acceleration, axis=0) / world.DT
        assert (np.abs(commands) <= world.robot.velocity).all()
        assert (np.abs(acceleration) <= world.robot.acceleration).all()
        assert (np.abs(jerk) <= world.robot.jerk).all()
        # 2%: the tool's speed is measured from positions that the motors follow with a little ripple.
        speed = np.linalg.norm(np.diff(world.tools, axis=0), axis=1) / world.DT
        assert speed.max() <= 1.02 * TOOL_LIMITS.velocity


def test_the_tool_follows_the_straight_line() -> None:
    with Watched(SceneSpec()) as world:
        world.commands, world.tools = [], []
        motion = Motion(world)
        motion.move_to(np.array([0.1, 0.05, 0.3]))
        world.tools.clear()
        motion.move_to(np.array([0.1, 0.35, 0.3]))
        # 5 mm: at 0.4 m/s the arm lags about two steps behind its reference, which bends the path a little.
        assert np.abs(np.array(world.tools)[:, (0, 2)] - [0.1, 0.3]).max() < 0.005


def test_gripper_opens_and_closes(world: World) -> None:
    motion = Motion(world)
    motion.grip(True)
    assert world.state().gripper_closed
    assert world.state().gripper_opening == pytest.approx(0.0, abs=0.002)
    motion.grip(False)
    assert not world.state().gripper_closed
    assert world.state().gripper_opening == pytest.approx(world.robot.gripper.max_opening, abs=0.002)


def test_every_cell_and_height_is_within_reach(world: World) -> None:
    cells = [(x, y, z) for x in (0, 7) for y in (0, 7) for z in (0, 7)]
    steps = tuple(MoveTool(board.cell_centre(*cell), "lower", 0) for cell in cells)
    Motion(world).check_reach(MotionPlan(steps, 0, None))


def test_what_is_out_of_reach_is_refused_before_anything_moves(world: World) -> None:
    before = world.time
    plan = MotionPlan((MoveTool(np.array([2.0, 0.0, 0.1]), "carry", 0),), 0, None)
    with pytest.raises(RefusalError, match=r"cannot reach that far: carry to \(2\.000, 0\.000, 0\.100\) m"):
        Motion(world).check_reach(plan)
    assert world.time == before
