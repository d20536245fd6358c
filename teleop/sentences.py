"""Random tasks with English sentences that describe them, for demos made by the scripted operator.

Left is +y, right is -y, front is +x (where the robot looks, away from it) and behind is -x. A sentence names a block
that is the only one of its description in the scene, and a goal that is one place.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from twin.board import CELLS
from twin.scene_spec import ObjectSpec, SceneSpec

from .errors import TaskError
from .referring import CORNERS, DIRECTIONS, ON_WORDS, Board, Cell, Words, standing_position
from .task import Task

Kind = Literal["move", "take", "drop"]
KINDS: tuple[Kind, ...] = ("move", "take", "drop")

MOVE_VERBS = ("put", "place", "move")
TAKE_VERBS = ("pick up", "take", "grab", "lift")
DROP_VERBS = ("drop", "put down", "release")
TWO_STEPS = 0.3
"""Share of moves that are told in two steps: take ... and put it ..."""
HELD_LEVEL = 7
"""Level of the cell in which a block is held at the start of a drop."""
LIFTED = 0.10
"""How far a lone take lifts the block [m]."""
TRIES = 200


@dataclass(frozen=True, slots=True)
class DescribedTask:
    """A task, its scene and a sentence for it.

    Attributes:
        scene: The scene; for a drop, the moved block starts in the closed gripper.
        task: What the operator is to do.
        sentence: What a person might say of it.
        kind: `move`, `take` or `drop`.
        object_id: The moved block.
        template: Which template made the sentence.
    """

    scene: SceneSpec
    task: Task
    sentence: str
    kind: Kind
    object_id: int
    template: str

    def truth(self) -> dict[str, Any]:
        """What is true of the demo, for the sidecar that only evaluation opens."""
        block = next(each for each in self.scene.objects if each.id == self.object_id)
        goal = None if self.task.goal is None else [float(value) for value in self.task.goal]
        return {
            "task": self.kind,
            "moved": {"id": block.id, "colour": block.colour, "shape": block.shape},
            "goal": goal,
            "release": self.task.release,
            "sentence": self.sentence,
            "template": self.template,
            "objects": {str(each.id): {"colour": each.colour, "shape": each.shape} for each in self.scene.objects},
        }


@dataclass(frozen=True, slots=True)
class _Destination:
    cell: Cell
    words: str
    template: str


def random_task(
    scene: SceneSpec,
    rng: np.random.Generator,
    *,
    kinds: Sequence[Kind] = KINDS,
    variety: float = 0.25,
    relative: bool = True,
) -> DescribedTask:
    """Choose a task that can be done in a scene, and a sentence that says which block and where without doubt.

    Args:
        scene: A board scene whose blocks stand in cells, nothing held.
        rng: Source of chance.
        kinds: Kinds to choose from; half of the tasks are moves if moves are among them.
        variety: Probability of each word being a synonym of the plain one.
        relative: Whether a block that shares its look may be named by where it stands (`that is in ...`).

    Raises:
        TaskError: A kind is unknown, or no task was found that could be described.
    """
    for kind in kinds:
        if kind not in KINDS:
            raise TaskError(f"task kind {kind!r} is unknown; choose from {', '.join(KINDS)}")
    if scene.held is not None:
        raise TaskError(
            f"scene {scene.name!r} starts with block {scene.held} in the gripper; give one that starts free"
        )
    words = Words(rng, variety, relative)
    board = Board(scene)
    movable = [each for each in scene.objects if board.clear(each)]
    weights = np.array([len(kinds) - 1.0 if kind == "move" and len(kinds) > 1 else 1.0 for kind in kinds])
    for _ in range(TRIES if movable and kinds else 0):
        kind = kinds[int(rng.choice(len(kinds), p=weights / weights.sum()))]
        block = movable[int(rng.integers(len(movable)))]
        found = _MAKERS[kind](scene, board, block, words)
        if found is not None:
            return found
    raise TaskError(f"scene {scene.name!r} has no block that could be moved and described by itself")


def _move(scene: SceneSpec, board: Board, block: ObjectSpec, words: Words) -> DescribedTask | None:
    phrase = board.phrase(block, words)
    destinations = _destinations(board, block, words)
    if phrase is None or not destinations:
        return None
    # First the kind of place, then the place: else the many cells beside blocks would crowd out corners.
    template = str(words.rng.choice(sorted({each.template for each in destinations})))
    fitting = [each for each in destinations if each.template == template]
    to = fitting[int(words.rng.integers(len(fitting)))]
    verb = words.one_of(MOVE_VERBS)
    if words.rng.random() < TWO_STEPS:
        sentence = f"{words.one_of(TAKE_VERBS[:3])} {phrase} and {verb} it {to.words}"
        template = f"take-{template}"
    else:
        sentence = f"{verb} {phrase} {to.words}"
    task = Task(block.id, np.array(standing_position(to.cell)))
    return DescribedTask(scene, task, sentence, "move", block.id, template)


def _take(scene: SceneSpec, board: Board, block: ObjectSpec, words: Words) -> DescribedTask | None:
    phrase = board.phrase(block, words)
    if phrase is None:
        return None
    x, y, z = standing_position(board.cell[block.id])
    task = Task(block.id, np.array((x, y, z + LIFTED)), release=False)
    return DescribedTask(scene, task, f"{words.one_of(TAKE_VERBS)} {phrase}", "take", block.id, "take")


def _drop(scene: SceneSpec, board: Board, block: ObjectSpec, words: Words) -> DescribedTask | None:
    """Take a block out of the scene into the gripper, over a column where it can be let go."""
    others = scene.model_copy(update={"objects": tuple(each for each in scene.objects if each.id != block.id)})
    board = Board(others)
    free = [cell for cx in range(CELLS) for cy in range(CELLS) if (cell := board.free_cell(cx, cy))]
    below = [cell for cell in free if cell[2] < HELD_LEVEL - 1]
    on_blocks = [cell for cell in below if cell[2] > 0]
    if on_blocks and words.rng.random() < 0.5:
        below = on_blocks
    cell = below[int(words.rng.integers(len(below)))]
    x, y, _ = cell
    held = standing_position((x, y, HELD_LEVEL))
    objects = tuple(
        each.model_copy(update={"position": held}) if each.id == block.id else each for each in scene.objects
    )
    changed = scene.model_copy(
        update={"objects": objects, "held": block.id, "gripper_closed": True, "gripper_position": held}
    )
    phrase = Board(changed).phrase(block, words)
    if phrase is None:
        return None
    task = Task(None, np.array(standing_position(cell)))
    return DescribedTask(changed, task, f"{words.one_of(DROP_VERBS)} {phrase}", "drop", block.id, "drop")


_MAKERS = {"move": _move, "take": _take, "drop": _drop}


def _destinations(board: Board, block: ObjectSpec, words: Words) -> list[_Destination]:
    """Places that can be named by themselves: on a clear cube, beside an identified block, in a corner."""
    places = []
    own = board.cell[block.id]
    for other in board.blocks:
        if other.id == block.id or not board.clear(other):
            continue
        name = board.phrase(other, words)
        if name is None:
            continue
        x, y, z = board.cell[other.id]
        if other.shape == "cube" and z + 1 < CELLS:
            places.append(_Destination((x, y, z + 1), f"{words.one_of(ON_WORDS)} {name}", "on"))
        for (dx, dy), phrases in DIRECTIONS.items():
            # Only where the block comes to stand on the level of the one beside it, so that the direction is level.
            if board.free_cell(x + dx, y + dy) == (x + dx, y + dy, z) and own[:2] != (x + dx, y + dy):
                cell = (x + dx, y + dy, z)
                places.append(_Destination(cell, f"{words.one_of(phrases)} {name}", "beside"))
    for (x, y), corner in CORNERS.items():
        free = board.free_cell(x, y)
        if free is not None and own[:2] != (x, y):
            places.append(_Destination(free, f"in the {corner}", "corner"))
    return places
