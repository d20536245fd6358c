"""A learner of a Train-Robots release: learns from the key frames that its layouts imply, and can be examined."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from time import perf_counter, process_time
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
    said = said_of(commands)
    for scene in scenes:
        if scene.one_block:
            begun = perf_counter()
            lesson = learner.study(key_frames(scene, rng), said.get(scene.number, ()))
            on_scene(Studied(scene.number, lesson, perf_counter() - begun))


def said_of(commands: Iterable[Command]) -> dict[int, list[str]]:
    """Sentences by the number of the scene that they are about."""
    said: dict[int, list[str]] = {}
    for command in commands:
        said.setdefault(command.scene, []).append(command.sentence)
    return said


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
        epsilon: How sparse groundings are: for `thesis` the largest share of all pairs of n-grams and concepts that the
            integer program selects (thesis 6.4.3), for `readings` the least probability of a meaning that is tried.
            None leaves the method's own.
    """

    seed: int
    method: str = "readings"
    epsilon: float | None = None

    def __call__(self, scenes: Sequence[Scene], commands: Sequence[Command]) -> ReleaseStudent:
        """Learn from scenes and commands."""
        rng = np.random.default_rng(self.seed)
        learner = self._learner()
        study_release(learner, scenes, commands, rng)
        return ReleaseStudent(learner.knowledge, rng)

    def steps(
        self, scenes: Sequence[Scene], commands: Sequence[Command]
    ) -> Iterator[tuple[ReleaseStudent, int, float]]:
        """Learn scene by scene; scenes that move not one block are passed over.

        Yields the student so far, how many commands it has heard, and the processor time of the scene [s].
        """
        rng = np.random.default_rng(self.seed)
        learner = self._learner()
        said = said_of(commands)
        heard = 0
        for scene in scenes:
            if scene.one_block:
                begun = process_time()
                sentences = said.get(scene.number, [])
                learner.study(key_frames(scene, rng), sentences)
                heard += len(sentences)
                # What it is asked on the way draws its own noise, so that it learns the same whether asked or not.
                student = ReleaseStudent(learner.knowledge, np.random.default_rng([self.seed, heard]))
                yield student, heard, process_time() - begun

    def _learner(self) -> Learner:
        learner = Learner(seed=self.seed, method=self.method)
        if self.epsilon is not None:
            learner.knowledge.language.epsilon = self.epsilon
        return learner
