"""Small board demos for tests: random stacks, and what is done with one block."""

from dataclasses import dataclass

import numpy as np

from learning.perception import KeyFrame, Observation, observe_key_frames
from twin.board import COLOURS_RGB, cell_centre
from twin.scene_spec import ObjectSpec

Cell = tuple[int, int, int]
CARRY = 9
"""Level at which the gripper travels."""


@dataclass(frozen=True)
class BoardDemo:
    """A demo and the truth about it."""

    observation: Observation
    objects: tuple[ObjectSpec, ...]
    cells: tuple[Cell, ...]
    moved: int
    goal: Cell


def blocks(*placed: tuple[Cell, str, str]) -> tuple[ObjectSpec, ...]:
    """Objects from (cell, colour, shape); ids are 10, 11, ..."""
    return tuple(
        ObjectSpec(id=10 + i, shape=shape, colour=colour, position=tuple(map(float, cell_centre(*cell))))
        for i, (cell, colour, shape) in enumerate(placed)
    )


def key_frames(cells: list[Cell], moved: int, goal: Cell, kind: str) -> list[KeyFrame]:
    """True key frames of a take (straight up to the goal), a drop (from the gripper down) or a move."""
    start = cells[moved]
    over = (start[0], start[1], CARRY)
    steps: list[tuple[Cell, bool, Cell]] = []  # gripper, closed, block
    if kind != "drop":
        steps += [(over, False, start), (start, False, start)]
    steps.append((start, True, start))
    if kind == "move":
        steps.append((over, True, over))
    if kind != "take":
        steps.append(((goal[0], goal[1], CARRY), True, (goal[0], goal[1], CARRY)))
    steps.append((goal, True, goal))
    if kind != "take":
        steps += [(goal, False, goal), ((goal[0], goal[1], CARRY), False, goal)]
    still = np.array([cell_centre(*cell) for cell in cells])
    frames = []
    for gripper, closed, block in steps:
        location = still.copy()
        location[moved] = cell_centre(*block)
        frames.append(KeyFrame(cell_centre(*gripper), closed, location))
    return frames


def random_demo(rng: np.random.Generator, kind: str = "move", columns: int = 7) -> BoardDemo:
    """Random stacks of up to three blocks, of which a topmost one is taken, dropped or moved."""
    places = [(int(p) // 8, int(p) % 8) for p in rng.choice(64, columns + 1, replace=False)]
    cells: list[Cell] = [(x, y, z) for x, y in places[:-1] for z in range(int(rng.integers(1, 4)))]
    colours = [str(rng.choice(list(COLOURS_RGB))) for _ in cells]
    tops = [i for i, (x, y, z) in enumerate(cells) if (x, y, z + 1) not in cells]
    shapes = ["prism" if i in tops and rng.random() < 0.3 else "cube" for i in range(len(cells))]
    moved = int(rng.choice(tops))
    goal: Cell = (*places[-1], 0)
    if kind == "take":
        goal = (cells[moved][0], cells[moved][1], CARRY)
    if kind == "drop":
        goal, cells[moved] = cells[moved], (cells[moved][0], cells[moved][1], CARRY)
    objects = blocks(*zip(cells, colours, shapes, strict=True))
    observation = observe_key_frames(key_frames(cells, moved, goal, kind), objects, rng)
    return BoardDemo(observation, objects, tuple(cells), moved, goal)
