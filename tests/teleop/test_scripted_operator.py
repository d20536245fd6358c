import numpy as np
import pytest

from teleop import ScriptedOperator, Session, Task
from tests.teleop.conftest import place, scene_of
from twin import SceneSpec, World
from twin.board import BLOCK, CELL, cell_centre

SOON = 25.0
"""Simulated time in which any of these tasks is done, further attempts included [s]."""


def drive(world: World, operator: ScriptedOperator) -> float:
    """Let an operator work at 60 Hz until it is done; returns the simulated time."""
    session = Session(world)
    while not operator.done and world.time < SOON:
        gamepad = operator.act(world.state(), world.spec)
        for _ in range(4):
            session.step(gamepad)
    return world.time


def where(world: World, number: int) -> np.ndarray:
    found: np.ndarray = next(each for each in world.state().objects if each.id == number).pose_object_in_world.position
    return found


def assert_in_cell(world: World, number: int, cell: tuple[int, int, int]) -> None:
    off = where(world, number) - cell_centre(*cell)
    assert np.abs(off[:2]).max() < CELL / 2, (number, off)
    assert abs(off[2]) < BLOCK / 2, (number, off)


def tower(x: int, y: int, height: int, first: int) -> list[tuple[tuple[int, int, int], str, str]]:
    colours = ("blue", "cyan", "yellow", "green")
    return [((x, y, z), colours[(first + z) % 4], "cube") for z in range(height)]


@pytest.mark.parametrize("seed", range(4))
def test_pick_and_place(small_scene: SceneSpec, seed: int) -> None:
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(0, cell_centre(5, 2, 1)), np.random.default_rng(seed))
        took = drive(world, operator)
        assert operator.success
        assert_in_cell(world, 0, (5, 2, 1))
        assert np.linalg.norm(where(world, 0) - cell_centre(5, 2, 1)) < 0.004  # its hand is good to 2 or 3 mm
        assert world.state().held is None
        assert 3.0 < took < 10.0  # a person's pace


def test_a_prism_between_two_towers_goes_to_another_gap() -> None:
    """Towers of five on both finger sides at the start and at the goal: 12 mm between blocks, 3 mm fingers."""
    blocks = [((3, 4, 0), "red", "prism")]
    for x, y in ((3, 3), (3, 5), (5, 1), (5, 3)):
        blocks += tower(x, y, 5, x + y)
    with World.from_scene(scene_of(*blocks)) as world:
        operator = ScriptedOperator(Task(0, cell_centre(5, 2, 0)), np.random.default_rng(3))
        drive(world, operator)
        assert operator.success
        assert_in_cell(world, 0, (5, 2, 0))
        for number, (cell, _, _) in enumerate(blocks[1:], start=1):
            assert_in_cell(world, number, cell)
            assert np.linalg.norm(where(world, number) - cell_centre(*cell)) < 0.003  # nothing was pushed


def test_carries_over_a_tall_tower_on_the_way() -> None:
    blocks = [((3, 1, 0), "red", "cube"), *tower(3, 3, 7, 0)]
    with World.from_scene(scene_of(*blocks)) as world:
        operator = ScriptedOperator(Task(0, cell_centre(3, 5, 0)), np.random.default_rng(0))
        drive(world, operator)
        assert_in_cell(world, 0, (3, 5, 0))
        for number, (cell, _, _) in enumerate(blocks[1:], start=1):
            assert_in_cell(world, number, cell)


def test_lone_take_ends_with_the_block_in_the_gripper_at_its_goal(small_scene: SceneSpec) -> None:
    goal = cell_centre(5, 3, 7)
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(2, goal, release=False), np.random.default_rng(0))
        drive(world, operator)
        state = world.state()
        assert operator.success
        assert state.held == 2
        assert state.gripper_closed
        np.testing.assert_allclose(where(world, 2), goal, atol=0.010)


def test_take_without_a_goal_lifts_a_little(small_scene: SceneSpec) -> None:
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(1, None), np.random.default_rng(0))
        drive(world, operator)
        assert world.state().held == 1
        assert where(world, 1)[2] - cell_centre(5, 2, 0)[2] == pytest.approx(0.08, abs=0.01)


def test_lone_drop_lets_go_of_what_it_holds() -> None:
    held = place(4, 4, 7)
    scene = scene_of(
        ((4, 4, 7), "red", "cube"), ((4, 4, 0), "blue", "cube"), gripper_position=held, gripper_closed=True, held=0
    )
    with World.from_scene(scene) as world:
        operator = ScriptedOperator(Task(None, cell_centre(4, 4, 1)), np.random.default_rng(0))
        drive(world, operator)
        state = world.state()
        assert operator.success
        assert_in_cell(world, 0, (4, 4, 1))
        assert (state.held, state.gripper_closed) == (None, False)


def test_tries_again_when_the_block_was_lost(small_scene: SceneSpec) -> None:
    """Somebody opens the gripper while the block is lifted; the operator sees it fall and takes it again."""
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(0, cell_centre(5, 5, 0)), np.random.default_rng(0))
        session = Session(world)
        disturbed = False
        while not operator.done and world.time < SOON:
            state = world.state()
            gamepad = operator.act(state, world.spec)
            if not disturbed and where(world, 0)[2] > 0.03:
                session.opening, disturbed = world.robot.gripper.max_opening, True
            for _ in range(4):
                session.step(gamepad)
        assert disturbed
        assert operator.attempts >= 2
        assert operator.success
        assert_in_cell(world, 0, (5, 5, 0))


def test_nothing_in_the_gripper_is_said(small_scene: SceneSpec) -> None:
    with World.from_scene(small_scene) as world:
        operator = ScriptedOperator(Task(None, cell_centre(5, 5, 0)), np.random.default_rng(0))
        drive(world, operator)
        assert operator.success is False
        assert operator.note == "there is nothing in the gripper"


def test_the_same_seed_moves_the_same_thumbs(small_scene: SceneSpec) -> None:
    runs = []
    for seed in (5, 5, 6):
        with World.from_scene(small_scene) as world:
            operator = ScriptedOperator(Task(0, None), np.random.default_rng(seed))
            session = Session(world)
            pads = []
            for _ in range(90):
                pads.append(operator.act(world.state(), world.spec))
                for _ in range(4):
                    session.step(pads[-1])
            runs.append(pads)
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]
