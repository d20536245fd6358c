"""A Train-Robots release on disk: commands and scenes. `annotation.txt` is left to the scorer."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from learning.errors import ReleaseError
from learning.train_robots.change import Change
from learning.train_robots.layout import (
    COLOUR_OF_CODE,
    COORDINATES,
    GRIPPER_CODES,
    GROUP_IMAGES,
    SHAPE_OF_CODE,
    Block,
    Cell,
    Layout,
)
from learning.train_robots.reader import Line, read_lines, spelled
from learning.train_robots.scene import SCENES_PER_GROUP, Scene, images_of_scene

COMMANDS_FILE = "commands.txt"
CONFIGURATION_FILE = "configuration.txt"


@dataclass(frozen=True, slots=True)
class Command:
    """One sentence about a scene."""

    id: int
    scene: int
    sentence: str


@dataclass(frozen=True)
class Release:
    """All commands and scenes of a directory in the public format.

    Attributes:
        directory: Where it was read from.
        scenes: Scene number to scene, in rising order; also the scenes that no command speaks of.
        commands: The commands in the order of the file.
        changes: What each scene changed, in the extended release; empty in a public one.
    """

    directory: Path
    scenes: dict[int, Scene]
    commands: tuple[Command, ...]
    changes: Mapping[int, tuple[Change, ...]] = field(default_factory=dict)

    @classmethod
    def load(cls, directory: str | Path) -> "Release":
        """Read `commands.txt` and `configuration.txt` of a directory.

        Raises ReleaseError that names file, line, value and what is allowed.
        """
        folder = Path(directory)
        if not folder.is_dir():
            raise ReleaseError(f"'{folder}' is not a directory; expected one with commands.txt and configuration.txt")
        scenes = _scenes(folder / CONFIGURATION_FILE)
        return cls(folder, scenes, _commands(folder / COMMANDS_FILE, scenes))

    def one_block_scenes(self) -> list[Scene]:
        """Scenes in which exactly one block differs, in rising order."""
        return [scene for scene in self.scenes.values() if scene.one_block]

    def commands_of(self, scene: int) -> tuple[Command, ...]:
        """Commands about one scene, in the order of the file."""
        return tuple(command for command in self.commands if command.scene == scene)


def _commands(path: Path, scenes: dict[int, Scene]) -> tuple[Command, ...]:
    commands: dict[int, Command] = {}
    for line in read_lines(path):
        if not line.text:
            continue
        id_text, scene_text, sentence = line.columns(3, "command id, scene number, sentence")
        command = Command(line.integer(id_text, "command id"), line.integer(scene_text, "scene number"), sentence)
        if command.id in commands:
            raise line.error(f"command id {command.id} stands twice; ids must differ")
        if command.scene not in scenes:
            group, before, after = images_of_scene(command.scene)
            raise line.error(
                f"scene {command.scene} needs the layouts of images {before} and {after} of group {group}, which "
                f"{CONFIGURATION_FILE} lacks; allowed scenes: {_scene_ranges(scenes)}"
            )
        commands[command.id] = command
    return tuple(commands.values())


def _scenes(path: Path) -> dict[int, Scene]:
    """Read all layouts and pair them up; every group must have all its images."""
    layouts: dict[tuple[int, int], Layout] = {}
    record: list[Line] = []
    lines = list(read_lines(path))
    for line in [*lines, Line(path, len(lines) + 1, "")]:
        if line.text:
            record.append(line)
        elif record:
            layout = _layout(record)
            if (layout.group, layout.image) in layouts:
                raise record[0].error(f"group {layout.group} image {layout.image} stands twice")
            layouts[layout.group, layout.image] = layout
            record = []
    if not layouts:
        raise ReleaseError(f"{path}: holds no layout; a layout begins with a line of group and image")
    groups = sorted({group for group, _ in layouts})
    scenes: dict[int, Scene] = {}
    for group in groups:
        for image in GROUP_IMAGES:
            if (group, image) not in layouts:
                raise ReleaseError(
                    f"{path}: group {group} has no layout of image {image}; every group needs images "
                    f"{spelled(GROUP_IMAGES)}"
                )
        first = (group - 1) * SCENES_PER_GROUP + 1
        for number in range(first, first + SCENES_PER_GROUP):
            _, before, after = images_of_scene(number)
            scenes[number] = Scene(number, layouts[group, before], layouts[group, after])
    return scenes


def _layout(record: list[Line]) -> Layout:
    head = record[0]
    group_text, image_text = head.columns(2, "group, image")
    group, image = head.integer(group_text, "group"), head.integer(image_text, "image", GROUP_IMAGES)
    if len(record) < 2:
        raise head.error(f"group {group} image {image} has no gripper line (x, y, z, O or C)")
    *place, code = record[1].columns(4, "gripper x, y, z, O or C")
    gripper = _cell(record[1], place)
    closed = record[1].choice(code, "gripper code", GRIPPER_CODES) == "C"
    blocks: list[Block] = []
    taken: set[Cell] = set()
    for line in record[2:]:
        *place, colour, shape = line.columns(5, "block x, y, z, colour, shape")
        cell = _cell(line, place)
        if cell in taken:
            raise line.error(f"cell {cell} of group {group} image {image} holds two blocks")
        taken.add(cell)
        colour = COLOUR_OF_CODE[line.choice(colour, "colour code", COLOUR_OF_CODE)]
        blocks.append(Block(cell, colour, SHAPE_OF_CODE[line.choice(shape, "shape code", SHAPE_OF_CODE)]))
    return Layout(group, image, gripper, closed, tuple(blocks))


def _cell(line: Line, fields: list[str]) -> Cell:
    x, y, z = (line.integer(field, f"cell {axis}", COORDINATES) for axis, field in zip("xyz", fields, strict=True))
    return x, y, z


def _scene_ranges(scenes: dict[int, Scene]) -> str:
    """Write scene numbers as ranges, such as `1..8, 17..24`."""
    ranges: list[list[int]] = []
    for number in sorted(scenes):
        if ranges and number == ranges[-1][1] + 1:
            ranges[-1][1] = number
        else:
            ranges.append([number, number])
    return ", ".join(f"{first}..{last}" for first, last in ranges) or "none"
