"""A learner of a Train-Robots release: learns from the key frames that its layouts imply, and can be examined."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from learning.interpretation import Interpretation, Interpreter
from learning.knowledge import Knowledge
from learning.learner import Learner, Lesson
from learning.perception import perceive, percept_of
from learning.train_robots import Command, Scene, key_frames, observe_before

if TYPE_CHECKING:
    from learning.percept import Percept


@dataclass(frozen=True, slots=True)
class Studied:
    """One scene that was learned from.

    Attributes:
        scene: Its number.
        lesson: What came of it.
        seconds: Wall-clock time it took [s].
    """

    scene: int
    lesson: Lesson
    seconds: float


def study_release(
    learner: Learner,
    scenes: Iterable[Scene],
    commands: Iterable[Command],
    rng: np.random.Generator,
    on_scene: Callable[[Studied], None] = lambda studied: None,
) -> None:
    """Learn from scenes and the commands about them, scene by scene; scenes that move not one block are passed over.

    Args:
        learner: Who learns.
        scenes: Scenes, also those that no command speaks of.
        commands: Sentences about them.
        rng: Source of the noise of perception.
        on_scene: Called after every scene.
    """
    said: dict[int, list[str]] = {}
    for command in commands:
        said.setdefault(command.scene, []).append(command.sentence)
    for scene in scenes:
        if scene.one_block:
            begun = perf_counter()
            lesson = learner.study(key_frames(scene, rng), said.get(scene.number, ()))
            on_scene(Studied(scene.number, lesson, perf_counter() - begun))


class ReleaseStudent:
    """Knowledge that can be examined on a release.

    Args:
        knowledge: What was learned.
        rng: Source of the noise of perception.
    """

    def __init__(self, knowledge: Knowledge, rng: np.random.Generator) -> None:
        self.knowledge = knowledge
        self.rng = rng
        self._interpreter = Interpreter(knowledge)

    def percept(self, scene: Scene) -> "Percept":
        """Perceive a scene before anything moves; `object_ids` are indices in the before layout."""
        return percept_of(observe_before(scene, self.rng), self.knowledge.spaces)

    def shown_action(self, scene: Scene) -> int | None:
        """Number of the action concept that the scene shows, None when it shows none that is known."""
        if not scene.one_block:
            return None
        _, shown = perceive(key_frames(scene, self.rng), self.knowledge.spaces, learn_action=False)
        return shown.action if shown.action >= 0 else None

    def interpret(self, sentence: str, percept: "Percept") -> Interpretation:
        """Understand a sentence in a scene."""
        return self._interpreter.interpret(sentence, percept)


@dataclass(frozen=True, slots=True)
class LearnRelease:
    """Makes a student from scenes and commands; can be sent to another process.

    Attributes:
        seed: Seed of the noise of perception.
        method: How language is learned: `readings` or `thesis`.
    """

    seed: int
    method: str = "readings"

    def __call__(self, scenes: Sequence[Scene], commands: Sequence[Command]) -> ReleaseStudent:
        """Learn from scenes and commands."""
        rng = np.random.default_rng(self.seed)
        learner = Learner(seed=self.seed, method=self.method)
        study_release(learner, scenes, commands, rng)
        return ReleaseStudent(learner.knowledge, rng)
