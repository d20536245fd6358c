"""Sentences are read back here by a small reader of its own, which knows English words and the scene only."""

import re

import numpy as np
import pytest

from teleop import DescribedTask, ScriptedOperator, Session, TaskError, random_task
from tests.teleop.conftest import place, scene_of
from twin import ObjectSpec, SceneSpec, World, random_board
from twin.board import BLOCK, CELL, CELLS, nearest_cell

COLOURS = {"turquoise": "cyan", "pink": "magenta", "purple": "magenta", "grey": "gray"}
SHAPES = {"block": "cube", "brick": "cube", "pyramid": "prism"}
CORNERS = {"front left": (7, 7), "front right": (7, 0), "back left": (0, 7), "back right": (0, 0)}
BESIDE = {"left of": (0, 1), "right of": (0, -1), "in front of": (1, 0), "behind": (-1, 0)}
VERBS = "put down|pick up|put|place|move|take|grab|lift|drop|release"
LOOK = r"the (?:(?P<{0}colour>\w+) )?(?P<{0}shape>cube|block|brick|prism|pyramid)"
BELOW = LOOK.replace("{0}", "{0}below_")
PHRASE = LOOK + r"(?: that is (?:in the (?P<{0}corner>\w+ \w+) corner|on(?: top of)? " + BELOW + "))?"
PLACE = r"(?P<on>on top of|onto|on)|(?:to the )?(?P<beside>left of|right of|in front of|behind)"
SENTENCE = re.compile(
    rf"(?P<verb>{VERBS}) {PHRASE.format('moved_')}(?: and (?:put|place|move) it)?"
    rf"(?: (?:{PLACE}) {PHRASE.format('to_')}"
    rf"| in the (?P<goal_corner>\w+ \w+) corner)?"
)


def cell_of(block: ObjectSpec) -> tuple[int, int, int]:
    return nearest_cell(np.array(block.position))


def looks_like(block: ObjectSpec, colour: str | None, shape: str) -> bool:
    return SHAPES.get(shape, shape) == block.shape and (colour is None or COLOURS.get(colour, colour) == block.colour)


def meant(scene: SceneSpec, words: dict[str, str | None], prefix: str) -> list[ObjectSpec]:
    """All blocks that a noun phrase fits."""
    found = []
    for block in scene.objects:
        x, y, z = cell_of(block)
        below = [each for each in scene.objects if cell_of(each) == (x, y, z - 1)]
        colour, shape = words[f"{prefix}below_colour"], words[f"{prefix}below_shape"]
        if (
            looks_like(block, words[f"{prefix}colour"], words[f"{prefix}shape"] or "")
            and (not words[f"{prefix}corner"] or CORNERS[words[f"{prefix}corner"] or ""] == (x, y))
            and (not shape or any(looks_like(each, colour, shape) for each in below))
        ):
            found.append(block)
    return found


def read(asked: DescribedTask) -> tuple[list[ObjectSpec], tuple[int, int, int] | None]:
    """The blocks that a sentence may move, and the cell where one would come to rest, in the reading that there is."""
    match = SENTENCE.fullmatch(asked.sentence)
    assert match, asked.sentence
    words = match.groupdict()
    scene, goal = asked.scene, None
    if words["on"] or words["beside"]:
        (reference,) = meant(scene, words, "to_")
        x, y, z = cell_of(reference)
        dx, dy = (0, 0) if words["on"] else BESIDE[words["beside"]]
        goal = (x + dx, y + dy, z + 1 if words["on"] else z)
    elif words["goal_corner"]:
        x, y = CORNERS[words["goal_corner"]]
        goal = (x, y, sum(cell_of(each)[:2] == (x, y) for each in scene.objects))
    return meant(scene, words, "moved_"), goal


def blocks_at(scene: SceneSpec) -> dict[tuple[int, int, int], ObjectSpec]:
    return {cell_of(each): each for each in scene.objects}


@pytest.mark.parametrize("seed", range(150))
def test_names_one_block_and_one_goal(seed: int) -> None:
    rng = np.random.default_rng([seed, 1])
    asked = random_task(random_board(np.random.default_rng(seed), seed=seed), rng, variety=0.5)
    moved, goal = read(asked)
    assert [each.id for each in moved] == [asked.object_id], asked.sentence
    standing = blocks_at(asked.scene)
    x, y, z = cell_of(moved[0])
    assert (x, y, z + 1) not in standing, "what is moved is clear"
    assert (asked.task.object_id is None) == (asked.kind == "drop") == (asked.scene.held is not None)
    assert asked.task.release == (asked.kind != "take")
    assert asked.task.goal is not None
    if asked.kind != "move":
        assert goal is None
        assert asked.task.goal[:2] == pytest.approx(moved[0].position[:2])  # straight up, straight down
    if asked.kind == "move":
        assert nearest_cell(asked.task.goal) == goal, asked.sentence
    if asked.kind != "take":
        gx, gy, gz = nearest_cell(asked.task.goal)
        assert 0 <= gx < CELLS
        assert 0 <= gy < CELLS
        assert (gx, gy, gz) not in standing
        # The goal is where a block comes to rest: on the board, or on a cube that is not the moved block itself.
        below = standing.get((gx, gy, gz - 1))
        assert (gz == 0) if below is None else (below.shape == "cube" and below.id != asked.object_id)


def test_a_crowd_of_alike_blocks_is_told_apart_by_place() -> None:
    scene = scene_of(
        ((7, 7, 0), "red", "cube"),
        ((3, 3, 0), "red", "cube"),
        ((3, 3, 1), "blue", "cube"),
        ((5, 5, 0), "green", "cube"),
        ((5, 5, 1), "red", "cube"),
    )
    sentences = {}
    for seed in range(40):
        asked = random_task(scene, np.random.default_rng(seed), kinds=("take",), variety=0.0)
        sentences[asked.sentence] = asked.object_id
    assert sentences == {
        "pick up the red cube that is in the front left corner": 0,
        "pick up the blue cube": 2,
        "pick up the red cube that is on top of the green cube": 4,
    }
    plain = [random_task(scene, np.random.default_rng(seed), relative=False).sentence for seed in range(40)]
    assert not any("that is" in sentence for sentence in plain)


def test_sentences_vary_and_repeat_with_their_seed() -> None:
    def say(seed: int) -> str:
        return random_task(random_board(np.random.default_rng(3)), np.random.default_rng(seed)).sentence

    assert [say(seed) for seed in range(30)] == [say(seed) for seed in range(30)]
    assert len({say(seed) for seed in range(60)}) > 40


def test_all_kinds_and_templates_come_up() -> None:
    found = [random_task(random_board(np.random.default_rng(seed)), np.random.default_rng(seed)) for seed in range(150)]
    assert {asked.kind for asked in found} == {"move", "take", "drop"}
    assert {asked.template.removeprefix("take-") for asked in found} == {"take", "drop", "on", "beside", "corner"}
    assert 0.35 < np.mean([asked.kind == "move" for asked in found]) < 0.65  # half of them, 150 draws


def test_truth_tells_what_scoring_needs(small_scene: SceneSpec) -> None:
    asked = random_task(small_scene, np.random.default_rng(0), kinds=("move",))
    truth = asked.truth()
    block = small_scene.objects[asked.object_id]
    assert truth["moved"] == {"id": block.id, "colour": block.colour, "shape": block.shape}
    assert truth["task"] == "move"
    assert truth["sentence"] == asked.sentence


@pytest.mark.parametrize("kind", ["move", "take", "drop"])
def test_the_operator_can_do_what_was_said(kind: str) -> None:
    asked = random_task(random_board(np.random.default_rng(11)), np.random.default_rng(2), kinds=(kind,))  # type: ignore[arg-type]
    with World.from_scene(asked.scene) as world:
        operator = ScriptedOperator(asked.task, np.random.default_rng(0))
        session = Session(world)
        while not operator.done and world.time < 25.0:
            gamepad = operator.act(world.state(), world.spec)
            for _ in range(4):
                session.step(gamepad)
        end = {each.id: each.pose_object_in_world.position for each in world.state().objects}[asked.object_id]
        assert asked.task.goal is not None
        assert np.abs((end - asked.task.goal)[:2]).max() < CELL / 2
        assert abs((end - asked.task.goal)[2]) < BLOCK / 2


def test_impossible_requests_are_explained() -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(TaskError, match="task kind 'dance' is unknown; choose from move, take, drop"):
        random_task(scene_of(), rng, kinds=("dance",))  # type: ignore[arg-type]
    with pytest.raises(TaskError, match="no block that could be moved"):
        random_task(scene_of(), rng)
    twins = scene_of(((1, 1, 0), "red", "cube"), ((2, 3, 0), "red", "cube"))
    with pytest.raises(TaskError, match="no block that could be moved and described by itself"):
        random_task(twins, rng, kinds=("take",))
    held = scene_of(((4, 4, 7), "red", "cube"), held=0, gripper_closed=True, gripper_position=place(4, 4, 7))
    with pytest.raises(TaskError, match="starts with block 0 in the gripper"):
        random_task(held, rng)
