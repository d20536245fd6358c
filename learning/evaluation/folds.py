"""Splitting a release into folds for cross-validation."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from learning.errors import LearningError
from learning.train_robots.release import Command, Release
from learning.train_robots.scene import Scene

Split = Literal["groups", "commands"]


@dataclass(frozen=True, slots=True)
class Fold:
    """One fold: what to learn from and what to ask.

    Attributes:
        number: Fold number, from 0.
        scenes: Scenes to learn from, in rising order; also those that no command speaks of.
        learned: Commands to learn from, in the order of the file.
        asked: Commands to ask, in the order of the file.
    """

    number: int
    scenes: tuple[Scene, ...]
    learned: tuple[Command, ...]
    asked: tuple[Command, ...]


def make_folds(release: Release, count: int, split: Split, rng: np.random.Generator) -> list[Fold]:
    """Split a release into folds.

    Args:
        release: What to split.
        count: Number of folds, at least 2.
        split: `groups` puts a command in fold `group % count`, so that no layout is seen both in learning and in
            asking; `commands` deals the commands out at random (the thesis's way), and scenes are seen in both.
        rng: Deals the commands out.

    Raises:
        LearningError: `count` is below 2 or above the number of groups or commands.
    """
    groups = {scene.group for scene in release.scenes.values()}
    most = min(len(groups), len(release.commands)) if split == "groups" else len(release.commands)
    if not 2 <= count <= most:
        raise LearningError(f"{count} folds by {split} are not possible here; choose 2..{most}")
    if split == "groups":
        fold_of = {command.id: release.scenes[command.scene].group % count for command in release.commands}
    else:
        dealt = rng.permutation(np.arange(len(release.commands)) % count)
        fold_of = {command.id: int(fold) for command, fold in zip(release.commands, dealt, strict=True)}
    return [
        Fold(
            number=number,
            scenes=tuple(s for s in release.scenes.values() if split == "commands" or s.group % count != number),
            learned=tuple(c for c in release.commands if fold_of[c.id] != number),
            asked=tuple(c for c in release.commands if fold_of[c.id] == number),
        )
        for number in range(count)
    ]
