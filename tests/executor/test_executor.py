"""Sentences carried out and refused in small scenes of our own."""

import re

import numpy as np
import pytest

from executor import Executor, InputError
from executor.report import ExecutionReport
from learning import Knowledge
from twin import ObjectSpec, SceneSpec, World, board

HALF_CELL = board.CELL / 2


def block(number: int, colour: str, cell: tuple[int, int, int], shape: str = "cube") -> ObjectSpec:
    return ObjectSpec.model_validate(
        {"id": number, "shape": shape, "colour": colour, "position": tuple(board.cell_centre(*cell))}
    )


SCENE = SceneSpec(
    objects=(
        block(0, "red", (2, 2, 0)),
        block(1, "blue", (5, 3, 0)),
        block(2, "green", (6, 6, 0)),
        block(3, "yellow", (6, 6, 1)),
        block(4, "white", (4, 3, 0), "prism"),
    )
)
HOLDING = SceneSpec(
    objects=(block(0, "red", (2, 2, 6)), block(1, "blue", (5, 3, 0))),
    gripper_position=tuple(board.cell_centre(2, 2, 6)),
    gripper_closed=True,
    held=0,
)


def say(knowledge: Knowledge, scene: SceneSpec, sentence: str, **options: bool) -> tuple[ExecutionReport, World]:
    with World.from_scene(scene) as world:
        report = Executor(world, knowledge, np.random.default_rng(0)).execute(sentence, **options)
        state = world.state()
    return report, state


def place(state: object, number: int) -> np.ndarray:
    return next(each.pose_object_in_world.position for each in state.objects if each.id == number)


def test_a_sentence_moves_the_right_block(knowledge: Knowledge) -> None:
    report, state = say(knowledge, SCENE, "Put the red cube on the blue block!")
    assert report.success and not report.refused
    assert np.linalg.norm(place(state, 0) - board.cell_centre(5, 3, 1)) < HALF_CELL
    for number, cell in ((1, (5, 3, 0)), (2, (6, 6, 0)), (3, (6, 6, 1)), (4, (4, 3, 0))):
        assert np.linalg.norm(place(state, number) - board.cell_centre(*cell)) < 0.003
    assert "“red” as colour_" in report.explanation
    assert report.attempts == 1
    assert set(report.durations) == {"perceive", "interpret", "plan", "to_motion", "move", "simulated"}


def test_a_lone_take_ends_with_the_block_in_the_gripper(knowledge: Knowledge) -> None:
    report, state = say(knowledge, SCENE, "take the white prism")
    assert report.success
    assert state.held == 4 and state.gripper_closed
    assert place(state, 4)[2] > 2 * board.BLOCK


def test_a_lone_drop_lets_go_of_what_is_held(knowledge: Knowledge) -> None:
    report, state = say(knowledge, HOLDING, "drop the red block on the blue block")
    assert report.success
    assert state.held is None
    assert np.linalg.norm(place(state, 0) - board.cell_centre(5, 3, 1)) < HALF_CELL


def test_plan_only_moves_nothing(knowledge: Knowledge) -> None:
    report, state = say(knowledge, SCENE, "put the red cube on the blue cube", plan_only=True)
    assert report.success and report.plan is not None and report.outcome is None
    assert state.time == 0.0


@pytest.mark.parametrize(
    ("scene", "sentence", "why"),
    [
        (SCENE, "schiebe den roten Würfel", r"never heard “schiebe”, “den”, “roten”, “würfel”"),
        (SCENE, "take the magenta cube", r"“magenta”"),
        (SCENE, "take the white sphere", r"never heard “sphere”"),
        (SCENE, "take the cube", r"3 things fit “cube”: which one"),
        (SCENE, "take the green cube", r"another block stands on what is “green”, “cube”"),
        (SCENE, "drop the red cube", r"“drop” needs a block in the gripper, and the robot holds nothing"),
        (HOLDING, "take the blue cube", r"(gripper holds)|(put that one first)"),
    ],
)
def test_what_cannot_be_done_is_explained(knowledge: Knowledge, scene: SceneSpec, sentence: str, why: str) -> None:
    report, state = say(knowledge, scene, sentence)
    assert not report.success and report.refused
    assert state.time == 0.0  # nothing moved
    assert re.search(why, report.explanation)


def test_no_word_at_all_is_bad_input(knowledge: Knowledge) -> None:
    with pytest.raises(InputError, match="holds no word; say what to do"):
        say(knowledge, SCENE, " ?! ")


def test_same_seed_same_report(knowledge: Knowledge) -> None:
    first, second = (say(knowledge, SCENE, "put the red cube on the blue cube")[0].to_dict() for _ in range(2))
    for each in (first, second):
        del each["durations"]
    assert first == second
