"""Real commands of a release, of groups that were not learned from."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.errors import InputError
from executor.execution.evaluation.case import Case, Expected
from learning.train_robots import Release, Scene, scene_spec

FOLDS = 4
HELD_OUT = 3
"""Groups whose number leaves this remainder are never learned from."""


@dataclass(frozen=True, slots=True)
class SplitRelease:
    """A release in two: what is learned from, and what is asked.

    Attributes:
        release: All of it.
        learned: Scenes of the groups to learn from.
        asked: Scenes of the others in which exactly one block moves.
    """

    release: Release
    learned: tuple[Scene, ...]
    asked: tuple[Scene, ...]

    @classmethod
    def load(cls, directory: Path) -> "SplitRelease":
        """Read a release and split it by group."""
        release = Release.load(directory)
        scenes = release.one_block_scenes()
        return cls(
            release,
            tuple(scene for scene in scenes if scene.group % FOLDS != HELD_OUT),
            tuple(scene for scene in scenes if scene.group % FOLDS == HELD_OUT),
        )


def release_cases(split: SplitRelease, count: int, seed: int) -> list[Case]:
    """Draw commands about held-out scenes at random, and say what each scene's after-layout asks for.

    Raises:
        InputError: There is no such command.
    """
    scenes = {scene.number: scene for scene in split.asked}
    commands = [command for command in split.release.commands if command.scene in scenes]
    if not commands:
        raise InputError(f"{split.release.directory}: no command speaks of a held-out scene in which one block moves")
    order = np.random.default_rng(seed).permutation(len(commands))[:count]
    cases = []
    for index in sorted(int(each) for each in order):
        command = commands[index]
        scene = scenes[command.scene]
        move = scene.move
        if move is None:
            continue
        cell = None if move.held_at_end else move.goal
        expected = Expected(object_id=move.object_id, cell=cell, strict=True)
        cases.append(Case(command.id, scene_spec(scene), command.sentence, expected, move.kind))
    return cases
