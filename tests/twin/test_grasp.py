"""Blocks are taken, carried and put down by friction alone, also between towers; stacks stand."""

import numpy as np
import pytest

from twin import JointCommand, ObjectSpec, SceneSpec, World, WorldState
from twin.board import BLOCK, CELL, cell_centre

from .conftest import Hand

OPEN = 0.048
OVER = 0.36
"""Height at which a block is carried over towers of eight [m]."""


def block(number: int, shape: str, x: int, y: int, z: int = 0, shift: tuple[float, float] = (0.0, 0.0)) -> ObjectSpec:
    position = cell_centre(x, y, z) + [*shift, 0.0]
    return ObjectSpec.model_validate({"id": number, "shape": shape, "colour": "red", "position": tuple(position)})


def tower(first: int, height: int, x: int, y: int) -> list[ObjectSpec]:
    return [block(first + z, "cube", x, y, z) for z in range(height)]


def moved(state: WorldState, spec: SceneSpec, skip: int) -> float:
    """How far any object but one is from where it was specified [m]."""
    return max(
        float(np.linalg.norm(each.pose_object_in_world.position - np.array(said.position)))
        for each, said in zip(state.objects, spec.objects, strict=True)
        if each.id != skip
    )


def test_a_stack_of_eight_stands() -> None:
    spec = SceneSpec(objects=tuple(tower(0, 8, 3, 3)))
    with World.from_scene(spec) as world:
        world.snapshot()  # wakes the blocks, so that physics and not sleep holds the stack
        for _ in range(480):
            world.step(JointCommand(np.zeros(3), OPEN))
        # The specification is the ideal stack; sagging contacts and settling stay below a millimetre.
        assert moved(world.state(), spec, skip=-1) < 0.001


@pytest.mark.parametrize("shape", ["cube", "prism"])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (0.004, -0.003)])
def test_a_block_between_towers_is_carried_onto_another(
    hand: type[Hand], shape: str, shift: tuple[float, float]
) -> None:
    towers = [*tower(1, 8, 3, 2), *tower(9, 8, 3, 4), *tower(17, 4, 2, 3), *tower(21, 4, 4, 3), *tower(25, 7, 6, 5)]
    spec = SceneSpec(objects=(block(0, shape, 3, 3, 0, shift), *towers))
    with World.from_scene(spec) as world:
        offsets = []

        def watch(world: World) -> None:
            state = world.state()
            if state.held == 0 and state.pose_tool_in_world.position[2] > 0.05:
                offsets.append(state.objects[0].pose_object_in_world.position - state.pose_tool_in_world.position)

        driver = hand(world, watch)
        start, goal = cell_centre(3, 3, 0), cell_centre(6, 5, 7)
        driver.move(np.array([*start[:2], OVER]))
        driver.move(start)
        assert world.state().held is None
        driver.grip(0.0)
        assert world.state().held == 0
        driver.move(np.array([*start[:2], OVER]))
        driver.move(np.array([*goal[:2], OVER]), speed=0.4)
        assert world.state().held == 0
        # The block follows the gripper: static friction holds it in its place between the fingers.
        assert np.ptp(np.array(offsets), axis=0).max() < 0.0005
        driver.move(goal + [0, 0, 0.001])
        driver.grip(OPEN)
        driver.move(np.array([*goal[:2], OVER]))
        driver.wait(240)
        state = world.state()
        assert state.held is None
        ended = state.objects[0].pose_object_in_world
        # The fingers centre a block in y, not in x.
        np.testing.assert_allclose(ended.position, goal + [shift[0], 0, 0], atol=0.0015)
        assert abs(ended.orientation_xyzw[3]) > 0.999
        assert moved(state, spec, skip=0) < 0.0015


@pytest.mark.parametrize("shape", ["cube", "prism"])
def test_a_block_held_at_the_start_stays_and_then_falls(shape: str) -> None:
    held = block(3, shape, 0, 0)
    with World.from_scene(SceneSpec(objects=(held,), held=3, gripper_position=(0.225, 0.225, 0.05))) as world:
        state = world.state()
        assert state.held == 3 and state.gripper_closed
        np.testing.assert_allclose(state.objects[0].pose_object_in_world.position, (0.225, 0.225, 0.05), atol=1e-4)
        # Three seconds: longer than PyBullet lets a resting body stay awake.
        for _ in range(720):
            world.step(JointCommand(np.zeros(3), 0.0))
        state = world.state()
        assert state.held == 3
        np.testing.assert_allclose(state.objects[0].pose_object_in_world.position, (0.225, 0.225, 0.05), atol=1e-4)
        for _ in range(120):
            world.step(JointCommand(np.zeros(3), OPEN))
        state = world.state()
        assert state.held is None
        # It does not stay asleep in mid-air.
        assert state.objects[0].pose_object_in_world.position[2] == pytest.approx(BLOCK / 2, abs=0.002)


def test_the_open_gripper_fits_between_neighbours(hand: type[Hand]) -> None:
    around = [(x, y) for x in (2, 3, 4) for y in (2, 3, 4) if (x, y) != (3, 3)]
    objects = [each for number, cell in enumerate(around) for each in tower(8 * number, 8, *cell)]
    spec = SceneSpec(objects=tuple(objects))
    with World.from_scene(spec) as world:
        driver = hand(world)
        down = cell_centre(3, 3, 0)
        driver.move(np.array([*down[:2], OVER]))
        driver.move(down)
        driver.grip(0.0)
        driver.grip(OPEN)
        driver.move(np.array([*down[:2], OVER]))
        assert moved(world.state(), spec, skip=-1) < 0.001


def test_a_blocked_arm_stops_pushing_when_told_to_go_back() -> None:
    """The arm is pressed on the table for a second: its targets must not run on below it."""
    with World.from_scene(SceneSpec(gripper_position=(0.2, 0.2, 0.03))) as world:
        down = np.array([0.0, 0.0, -0.15])

        def drive(twist: np.ndarray, steps: int) -> None:
            for _ in range(steps):
                jacobian = world.robot.jacobian(world.state().q)
                world.step(JointCommand(np.linalg.solve(jacobian[:3], twist), OPEN))

        drive(down, 240)
        pressed = world.state().pose_tool_in_world.position[2]
        drive(-down, 48)
        assert world.state().pose_tool_in_world.position[2] > pressed + 0.015
        assert pressed > 0.019 - 0.014


def test_the_prism_rests_on_its_base_with_upright_end_faces() -> None:
    with World.from_scene(SceneSpec(objects=(block(0, "prism", 3, 3),))) as world:
        pose = world.state().objects[0].pose_object_in_world
        np.testing.assert_allclose(pose.position, cell_centre(3, 3, 0), atol=1e-4)
        np.testing.assert_allclose(np.abs(pose.orientation_xyzw), [0, 0, 0, 1], atol=1e-3)
    assert CELL - BLOCK >= 0.012
