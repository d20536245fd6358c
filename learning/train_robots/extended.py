"""The extended Train-Robots release (thesis 6.2.1): more shapes and colours, and sentences changed to match.

Half of the scenes turn prisms to spheres, another half cubes to cylinders, another half red to black, so that no shape
and no colour is in every scene. The words that name them change alike, one word for one; all other words, and mistakes
in them, stay.
"""

import re
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from learning.train_robots.change import CHANGES, Change
from learning.train_robots.layout import Block, Layout
from learning.train_robots.release import Command, Release
from learning.train_robots.scene import Scene

_WORD = re.compile(r"[A-Za-z]+")


def extended(release: Release, rng: np.random.Generator) -> Release:
    """Return a release with the changes made; scenes, groups and commands keep their numbers.

    Scenes of one group share a layout; each changes its own copy of it.

    Args:
        release: The public release of two shapes and eight colours.
        rng: Draws the halves.
    """
    numbers = np.array(sorted(release.scenes))
    halves = [set(rng.choice(numbers, len(numbers) // 2, replace=False).tolist()) for _ in CHANGES]
    changes = {
        number: tuple(change for change, half in zip(CHANGES, halves, strict=True) if number in half)
        for number in release.scenes
    }
    return Release(
        release.directory,
        {
            number: Scene(number, _changed(scene.before, changes[number]), _changed(scene.after, changes[number]))
            for number, scene in release.scenes.items()
        },
        tuple(
            Command(each.id, each.scene, said_otherwise(each.sentence, changes[each.scene]))
            for each in release.commands
        ),
        changes,
    )


def said_otherwise(sentence: str, changes: Sequence[Change]) -> str:
    """Put the words of some changes into a sentence; capitals at the beginning of words stay."""
    words = {old: new for change in changes for old, new in change.words.items()}

    def put(match: re.Match[str]) -> str:
        word = match.group()
        new = words.get(word.lower(), word)
        return new.capitalize() if word[0].isupper() else new

    return _WORD.sub(put, sentence)


def _changed(layout: Layout, changes: Sequence[Change]) -> Layout:
    blocks = []
    for block in layout.blocks:
        looks = {change.what: change.new for change in changes if getattr(block, change.what) == change.old}
        blocks.append(Block(block.cell, looks.get("colour", block.colour), looks.get("shape", block.shape)))
    return replace(layout, blocks=tuple(blocks))
