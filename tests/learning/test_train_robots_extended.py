"""The extended release: other shapes and colours in half of the scenes, and sentences that match."""

from pathlib import Path

import numpy as np
import pytest

from learning.evaluation.annotation import annotations_of, load_annotations
from learning.train_robots import CHANGES, Release, extended
from learning.train_robots.extended import said_otherwise

PRISM, CUBE, RED = CHANGES


@pytest.fixture
def release(synthetic_release_directory: Path) -> Release:
    return Release.load(synthetic_release_directory)


def test_half_of_the_scenes_make_each_change_and_others_stay(release: Release) -> None:
    more = extended(release, np.random.default_rng(0))
    for change in CHANGES:
        changed = [number for number, changes in more.changes.items() if change in changes]
        assert len(changed) == len(release.scenes) // 2
    for number, scene in more.scenes.items():
        for before, after in zip(release.scenes[number].before.blocks, scene.before.blocks, strict=True):
            assert before.cell == after.cell
            turned = PRISM in more.changes[number] and before.shape == "prism"
            assert (after.shape == "sphere") == turned
        assert scene.move == release.scenes[number].move


def test_one_seed_gives_one_extension(release: Release) -> None:
    one, same = (extended(release, np.random.default_rng(7)) for _ in range(2))
    assert one.commands == same.commands
    assert one.scenes == same.scenes
    assert one.commands != extended(release, np.random.default_rng(8)).commands


@pytest.mark.parametrize(
    ("sentence", "changed"),
    [
        ("Red pyramid, left of the red block", "Black ball, left of the black drum"),
        ("put teh redd thing down", "put teh redd thing down"),
        ("the prism's top", "the sphere's top"),
    ],
)
def test_words_for_what_changed_change_alike(sentence: str, changed: str) -> None:
    assert said_otherwise(sentence, CHANGES) == changed


def test_annotated_words_change_with_their_scenes(release: Release) -> None:
    more = extended(release, np.random.default_rng(0))
    trees, before = annotations_of(more), load_annotations(release.directory)
    assert trees is not None
    assert before is not None
    for command in more.commands:
        old, new = before[command.id], trees[command.id]
        wanted = ["sphere" if PRISM in more.changes[command.scene] and v == "prism" else v for v in old.values("type")]
        wanted = ["cylinder" if CUBE in more.changes[command.scene] and v == "cube" else v for v in wanted]
        assert new.values("type") == wanted
        assert ("red" in new.values("color")) == (
            "red" in old.values("color") and RED not in more.changes[command.scene]
        )
