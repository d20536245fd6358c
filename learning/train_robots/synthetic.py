"""A small release of our own making in the public format, so that tests need no download.

Layouts are random, sentences come from a few templates of our own, and each has its Robot Control Language tree. Within
a layout no two blocks share colour and shape, so that every sentence means one move.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np

from learning.train_robots.layout import COLOUR_OF_CODE, GROUP_IMAGES, SHAPE_OF_CODE, Block, Cell, Layout, Shape
from learning.train_robots.scene import SCENES_PER_GROUP, Scene, ShownMove, images_of_scene
from twin.board import CELLS

COMMANDS_PER_SCENE = 2
LINE_END = "\r\n"

_CORNERS: dict[tuple[int, int], tuple[str, str]] = {
    (0, 0): ("back", "right"),
    (0, CELLS - 1): ("back", "left"),
    (CELLS - 1, 0): ("front", "right"),
    (CELLS - 1, CELLS - 1): ("front", "left"),
}
_COLOUR_WORDS = {colour: (colour,) for colour in COLOUR_OF_CODE.values()} | {
    "gray": ("grey", "gray"),
    "magenta": ("pink", "purple"),
    "cyan": ("turquoise", "cyan"),
}
_SHAPE_WORDS: dict[Shape, tuple[str, ...]] = {"cube": ("cube", "block", "box"), "prism": ("pyramid", "prism")}
_ACTION_WORDS = {"move": ("move", "place", "put"), "take": ("pick up", "take", "grab"), "drop": ("drop", "release")}
_ABOVE_WORDS = ("on top of", "on", "onto")
_LIFTED = 6
"""Level in which a held block hangs."""


def write_synthetic_release(directory: Path, rng: np.random.Generator, *, scenes: int = 48) -> None:
    """Write `commands.txt`, `configuration.txt` and `annotation.txt` of about `scenes` scenes into a directory.

    Every group has its eight scenes, so `scenes` is rounded up to a multiple of eight. A quarter of them are lone takes
    and drops.
    """
    groups = -(-scenes // SCENES_PER_GROUP)
    layouts = {}
    for group in range(1, groups + 1):
        for layout in _group_layouts(group, rng):
            layouts[group, layout.image] = layout
    commands: list[str] = []
    annotations: list[str] = []
    for number in range(1, groups * SCENES_PER_GROUP + 1):
        group, before, after = images_of_scene(number)
        scene = Scene(number, layouts[group, before], layouts[group, after])
        for _ in range(COMMANDS_PER_SCENE):
            identifier = len(commands) + 1
            sentence, tree = _Sentence(rng).about(scene)
            commands.append(f"{identifier}\t{number}\t{sentence}")
            annotations.append(f"{identifier}\trcl\t{tree}")
    directory.mkdir(parents=True, exist_ok=True)
    for name, lines in (
        ("commands.txt", commands),
        ("annotation.txt", annotations),
        ("configuration.txt", [line for layout in layouts.values() for line in _layout_lines(layout)]),
    ):
        (directory / name).write_bytes("".join(line + LINE_END for line in lines).encode())


def _group_layouts(group: int, rng: np.random.Generator) -> list[Layout]:
    """Image 1 has six cubes on the board, one in a corner, and three blocks on them; the others are one move away."""
    corners = list(_CORNERS)
    inner = [(x, y) for x in range(1, CELLS - 1) for y in range(1, CELLS - 1)]
    corner = corners[rng.integers(len(corners))]
    colours = list(rng.permutation(list(COLOUR_OF_CODE.values())))
    columns = [corner, *(inner[i] for i in rng.choice(len(inner), 5, replace=False))]
    blocks = [Block((x, y, 0), str(colour), "cube") for (x, y), colour in zip(columns, colours, strict=False)]
    prism_colours = rng.permutation(colours)
    for index, (x, y) in enumerate(columns[1:4]):
        on_top = Block((x, y, 1), str(colours[-1]), "cube") if index == 0 else None
        blocks.append(on_top or Block((x, y, 1), str(prism_colours[index]), "prism"))
    first = Layout(group, 1, _free_cell(blocks, rng), closed=False, blocks=tuple(blocks))
    layouts = [first]
    movable = [i for i, b in enumerate(blocks) if b.cell[2] == 1 or b.cell[:2] == corner]
    for image in GROUP_IMAGES[1:]:
        index = int(movable[rng.integers(len(movable))])
        x, y, _ = blocks[index].cell
        held = image == GROUP_IMAGES[-1]
        goal = (x, y, _LIFTED) if held else _free_goal(first, index, rng)
        moved = list(blocks)
        moved[index] = replace(blocks[index], cell=goal)
        gripper = goal if held else _free_cell(moved, rng)
        layouts.append(Layout(group, image, gripper, closed=held, blocks=tuple(moved)))
    return layouts


def _free_goal(layout: Layout, moved: int, rng: np.random.Generator) -> Cell:
    """Choose a clear cube to land on, or an empty corner."""
    taken = {block.cell for block in layout.blocks}
    goals: list[Cell] = [(x, y, 0) for x, y in _CORNERS if (x, y, 0) not in taken]
    for index, block in enumerate(layout.blocks):
        x, y, z = block.cell
        if index != moved and block.shape == "cube" and (x, y, z + 1) not in taken:
            goals.append((x, y, z + 1))
    return goals[rng.integers(len(goals))]


def _free_cell(blocks: list[Block], rng: np.random.Generator) -> Cell:
    """Choose where the open gripper hangs: over a column that leaves room."""
    x, y = (int(v) for v in rng.integers(0, CELLS, 2))
    return x, y, max([b.cell[2] for b in blocks if b.cell[:2] == (x, y)], default=-1) + 4


def _layout_lines(layout: Layout) -> list[str]:
    colour_codes = {name: code for code, name in COLOUR_OF_CODE.items()}
    shape_codes = {name: code for code, name in SHAPE_OF_CODE.items()}
    rows: list[tuple[object, ...]] = [
        (layout.group, layout.image),
        (*layout.gripper, "C" if layout.closed else "O"),
        *((*block.cell, colour_codes[block.colour], shape_codes[block.shape]) for block in layout.blocks),
    ]
    return ["\t".join(str(field) for field in row) for row in rows] + [""]


class _Sentence:
    """One sentence under construction, with the tree of what was said."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._words: list[str] = []

    def about(self, scene: Scene) -> tuple[str, str]:
        """Return a sentence and its tree for a scene."""
        move = scene.move
        if move is None:
            raise ValueError(f"scene {scene.number} does not move exactly one block")
        if move.kind == "take":
            tree = (
                f"(event: {self._leaf('action', 'take', _ACTION_WORDS['take'])} {self._block(scene, move.object_id)})"
            )
        elif move.kind == "move" and self._rng.random() < 0.4:
            tree = self._take_then_drop(scene, move)
        else:
            action = self._leaf("action", move.kind, _ACTION_WORDS[move.kind])
            tree = f"(event: {action} {self._block(scene, move.object_id)} {self._destination(scene, move)})"
        return " ".join(self._words), tree

    def _take_then_drop(self, scene: Scene, move: ShownMove) -> str:
        take = self._leaf("action", "take", _ACTION_WORDS["take"])
        entity = self._block(scene, move.object_id, identifier=1)
        self._say("and")
        drop = self._leaf("action", "drop", ("put", "place"))
        reference = f"(entity: {self._leaf('type', 'reference', ('it',))} (reference-id: 1))"
        destination = self._destination(scene, move)
        return f"(sequence: (event: {take} {entity}) (event: {drop} {reference} {destination}))"

    def _say(self, words: str) -> str:
        """Append words and return their `(token: first last)`."""
        first = len(self._words) + 1
        self._words += words.split()
        last = len(self._words)
        return f"(token: {first} {last})" if last > first else f"(token: {first})"

    def _leaf(self, label: str, value: str, choices: tuple[str, ...]) -> str:
        return f"({label}: {value} {self._say(str(self._rng.choice(choices)))})"

    def _block(self, scene: Scene, index: int, identifier: int | None = None) -> str:
        block = scene.before.blocks[index]
        self._say("the")
        colour = self._leaf("color", block.colour, _COLOUR_WORDS[block.colour])
        shape = self._leaf("type", block.shape, _SHAPE_WORDS[block.shape])
        return f"(entity: {'' if identifier is None else f'(id: {identifier}) '}{colour} {shape})"

    def _destination(self, scene: Scene, move: ShownMove) -> str:
        x, y, z = move.goal
        if z == 0:
            relation = self._leaf("relation", "within", ("in",))
            self._say("the")
            indicators = " ".join(self._leaf("indicator", word, (word,)) for word in _CORNERS[x, y])
            ground = f"(entity: {indicators} {self._leaf('type', 'corner', ('corner',))})"
        else:
            relation = self._leaf("relation", "above", _ABOVE_WORDS)
            below = next(i for i, block in enumerate(scene.before.blocks) if block.cell == (x, y, z - 1))
            ground = self._block(scene, below)
        return f"(destination: (spatial-relation: {relation} {ground}))"
