"""Graphlets played in physics: the same player on every robot, judged by the rules of success."""

import numpy as np
import pytest

from executor.actions.player import ActionPlayer, Played
from executor.actions.quantities import Quantities
from executor.actions.success import fault_of
from executor.actions.things import clear_below, corners_of
from executor.actions.witness import WitnessedWorld
from executor.collections.rules import UPRIGHT
from executor.follow import wait
from learning.graphs import ActionGraphlet, GraphletState, Side
from robots.kinematics import rotation_matrix
from robots.pose import FloatArray
from tests.executor.graphlets import MOVE
from twin import ObjectSpec, SceneSpec, TwinError, World
from twin.board import cell_centre
from twin.objects import object_model

THING = 3
PUT_DOWN = ActionGraphlet((MOVE.states[2], *MOVE.states[3:]))
GRASP = ActionGraphlet(MOVE.states[:3])
PRESS = ActionGraphlet(
    (GraphletState(True, False, 0), GraphletState(True, True, 0, side=Side.ABOVE), GraphletState(True, False, 0))
)
PUSH = ActionGraphlet(
    (
        GraphletState(True, False, 0),
        GraphletState(True, True, 0, side=Side.BESIDE),
        GraphletState(True, True, 1, side=Side.BESIDE),
    )
)


def cube(number: int, x: int, y: int, z: int = 0) -> ObjectSpec:
    place = tuple(cell_centre(x, y, z))
    return ObjectSpec.model_validate({"id": number, "shape": "cube", "colour": "red", "position": place})


def thing(name: str, x: float, y: float) -> ObjectSpec:
    return ObjectSpec.of_model(THING, name, (x, y, float(object_model(name).half_extents[2])))


def scene(robot: str, *objects: ObjectSpec, **more: object) -> SceneSpec:
    kind = "board" if robot == "three_dof" else "table"
    return SceneSpec.model_validate({"name": "played", "kind": kind, "robot": robot, "objects": objects, **more})


def play(
    spec: SceneSpec,
    graphlet: ActionGraphlet,
    action: str,
    goal: FloatArray | None = None,
    quantities: Quantities | None = None,
) -> tuple[Played, str]:
    """Play on the thing of a scene; returns how it went, and its fault."""
    with WitnessedWorld(spec) as world:
        player = ActionPlayer(world, np.random.default_rng(0))
        played = player.play(graphlet, THING, goal, quantities, lambda arm: world.watch(THING, arm))
        wait(world, 0.5, world.commanded_openings)
        evidence = world.evidence()
        return played, "" if evidence is None else fault_of(action, evidence, goal)


def test_a_block_is_moved_onto_another_one() -> None:
    goal = cell_centre(5, 2, 1)
    played, fault = play(scene("three_dof", cube(THING, 2, 5), cube(8, 5, 2)), MOVE, "move", goal)
    assert played == Played(True, arm="arm", started=True)
    assert fault == ""


def test_what_is_in_the_hand_already_is_put_down_from_there() -> None:
    start = tuple(cell_centre(4, 4, 7))
    held = cube(THING, 4, 4).model_copy(update={"position": start})
    spec = scene("three_dof", held, held=THING, gripper_closed=True, gripper_position=start)
    played, fault = play(spec, PUT_DOWN, "put down", cell_centre(1, 6, 0))
    assert played.success
    assert fault == ""


def test_an_action_that_starts_with_the_thing_in_the_hand_fetches_it_first() -> None:
    played, fault = play(scene("three_dof", cube(THING, 2, 5)), PUT_DOWN, "put down", cell_centre(5, 2, 0))
    assert played.success
    assert fault == ""


def test_a_can_is_pressed_and_stays() -> None:
    spec = scene("mico_segway", thing("small_red_can", 0.52, 0.05))
    played, fault = play(spec, PRESS, "press", quantities=Quantities(force={Side.ABOVE: 6.0}, durations={1: 0.3}))
    assert played.success
    assert fault == ""


def test_a_can_is_pushed_along_the_table() -> None:
    played, fault = play(
        scene("mico_segway", thing("small_red_can", 0.52, 0.05)), PUSH, "push", quantities=Quantities(shift=0.06)
    )
    assert played.success
    assert fault == ""


def test_either_arm_acts_on_what_only_it_reaches() -> None:
    played, fault = play(scene("baxter", thing("red_apple", 0.6, -0.45)), GRASP, "grasp")
    assert (played.success, played.arm, fault) == (True, "right", "")


def test_what_no_hand_fits_around_is_told_with_the_primitive_that_failed() -> None:
    played, _ = play(scene("baxter", thing("small_red_cup", 0.65, 0.2)), GRASP, "grasp")
    assert (played.success, played.primitive, played.started) == (False, "reach", False)
    assert played.reason == "no grasp: no part of the object fits between the fingers"


def test_an_unknown_object_is_an_error() -> None:
    with World(scene("three_dof", cube(THING, 2, 5))) as world, pytest.raises(TwinError, match="no object 7"):
        ActionPlayer(world, np.random.default_rng(0)).play(GRASP, 7)


def test_height_is_that_above_what_bears_a_thing() -> None:
    with World(scene("three_dof", cube(THING, 2, 5, 1), cube(8, 2, 5), cube(9, 6, 6))) as world:
        # Blocks rest with a gap of physics' contact margin, well below a millimetre.
        assert clear_below(world, THING) == pytest.approx(0.0, abs=1e-3)
        assert clear_below(world, 9) == pytest.approx(0.0, abs=1e-3)
        np.testing.assert_allclose(np.ptp(corners_of(world, THING), axis=0), 0.038, atol=1e-4)


@pytest.mark.parametrize("yaw", [0.8, 1.2])
def test_what_goes_into_a_bowl_is_lowered_into_it_and_does_not_tumble(yaw: float) -> None:
    """Let go of at the rim, and 12 mm beside the middle, the second of these falls on its side."""
    middle, off = np.array([0.60, 0.25]), np.array([0.0, 0.012])
    half = float(object_model("blue_bowl").half_extents[2])
    bowl = ObjectSpec.of_model(9, "blue_bowl", (*middle, half))
    block = thing("yellow_cube", 0.55, 0.075).model_copy(update={"yaw": yaw})
    goal = np.append(middle + off, 2.0 * half + float(object_model("yellow_cube").half_extents[2]))
    with World(scene("baxter", block, bowl)) as world:
        played = ActionPlayer(world, np.random.default_rng(0)).play(MOVE, THING, goal)
        wait(world, 0.5, world.commanded_openings)
        poses = {each.id: each.pose_object_in_world for each in world.state().objects}
    assert played.success, played.reason
    assert rotation_matrix(poses[THING].orientation_xyzw)[2, 2] > np.cos(UPRIGHT)  # the bowl's bottom is round
    assert np.linalg.norm(poses[THING].position[:2] - poses[9].position[:2]) < 0.02
    assert poses[THING].position[2] < 2.0 * half
    assert np.linalg.norm(poses[9].position[:2] - middle) < 0.006  # hardly pushed
