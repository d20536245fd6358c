"""Board scenes to score concepts on: the extended Train-Robots release of the thesis (6.2.1), without physics."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from learning.evaluation.concepts import ScoredDemo
from learning.evaluation.concepts_truth import TrueDemo
from learning.perception.observe import observe_key_frames
from learning.train_robots.key_frames import implied_key_frames
from learning.train_robots.release import Release
from learning.train_robots.scene import Scene
from learning.train_robots.scene_spec import scene_spec
from twin.scene_spec import ObjectSpec

CHANGES = (("shape", "prism", "sphere"), ("shape", "cube", "cylinder"), ("colour", "red", "black"))
"""What half of the scenes change, each another half: property, value, new value."""


@dataclass(frozen=True, slots=True)
class ExtendedScene:
    """A scene of the release with the thesis's changes.

    Attributes:
        scene: The scene.
        objects: Its objects as they look after the changes, in the order of the before layout.
        sentences: What people said of it, with the words of the changes.
    """

    scene: Scene
    objects: tuple[ObjectSpec, ...]
    sentences: tuple[str, ...]


def extended_scenes(release: Release, rng: np.random.Generator) -> list[ExtendedScene]:
    """The one-block scenes of a release, extended.

    Half of the scenes turn prisms to spheres, another half cubes to cylinders, another half red to black.

    Args:
        release: The public release of two shapes and eight colours.
        rng: Draws the halves.
    """
    numbers = np.array(sorted(release.scenes))
    halves = [set(rng.choice(numbers, len(numbers) // 2, replace=False).tolist()) for _ in CHANGES]
    return [
        _extended(
            scene, [change for change, half in zip(CHANGES, halves, strict=True) if scene.number in half], release
        )
        for scene in release.one_block_scenes()
    ]


def scored_scenes(scenes: Sequence[ExtendedScene], rng: np.random.Generator) -> Iterator[ScoredDemo]:
    """Observe the key frames that each scene implies, through the board's noise; a group is what shares a layout."""
    for extended in scenes:
        scene = extended.scene
        frames = implied_key_frames(scene)
        observation = observe_key_frames(frames, extended.objects, rng)
        move = scene.move
        truth = TrueDemo(
            properties={
                "colour": tuple(thing.colour for thing in extended.objects),
                "shape": tuple(thing.shape for thing in extended.objects),
            },
            first=frames[0].object_location,
            last=frames[-1].object_location,
            action=None if move is None else move.kind,
        )
        yield ScoredDemo(observation, truth, extended.sentences, group=scene.group)


def _extended(scene: Scene, changes: Sequence[tuple[str, str, str]], release: Release) -> ExtendedScene:
    objects = []
    for thing in scene_spec(scene).objects:
        new = {what: value for what, old, value in changes if getattr(thing, what) == old}
        objects.append(thing.model_copy(update=new))
    sentences = []
    for command in release.commands_of(scene.number):
        sentence = command.sentence
        for _, old, value in changes:
            sentence = sentence.replace(old, value)
        sentences.append(sentence)
    return ExtendedScene(scene, tuple(objects), tuple(sentences))
