"""What is known before commands are asked: learned from a scripted collection or from a release, once, and kept."""

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from executor.collection import VARIETY, BoardCollection
from executor.execution.evaluation.release_cases import SplitRelease
from executor.files import new_folder, written_whole
from executor.knowledge_fit import check_fit
from executor.release_student import study_release
from executor.showcase import show_and_learn
from learning import Knowledge, Learner
from learning.code_digest import code_digest
from learning.grounding.ngrams import words_of
from robots.cache import user_folder

DEMOS = 200
"""Demos of the scripted collection, as many as `showtell demo` records."""


@dataclass(frozen=True, slots=True)
class Kept:
    """Files of what was learned once; another version of the learner has others.

    Attributes:
        knowledge: Knowledge file.
        sentences: Sentences that it was learned from.
    """

    knowledge: Path
    sentences: Path

    @classmethod
    def of(cls, home: Path, name: str) -> "Kept":
        """Files in a folder for what goes by a name."""
        stem = f"{name}.{code_digest()}"
        return cls(home / f"{stem}.json", home / f"{stem}.sentences.json")

    @property
    def complete(self) -> bool:
        """Whether all was learned and written."""
        return self.knowledge.is_file() and self.sentences.is_file()

    def write(self, knowledge: Knowledge, sentences: Iterable[str]) -> None:
        """Write what was learned, and delete what earlier learners left under the same name."""
        knowledge.save(self.knowledge)
        with written_whole(self.sentences) as partial:
            partial.write_text(json.dumps(sorted(set(sentences)), ensure_ascii=False), encoding="utf-8")
        name = self.knowledge.name.split(".")[0]
        for path in self.knowledge.parent.glob(f"{name}.*.json"):
            if path not in (self.knowledge, self.sentences):
                path.unlink(missing_ok=True)

    def read(self) -> "Learned":
        """What was learned."""
        sentences = json.loads(self.sentences.read_text(encoding="utf-8"))
        return Learned(self.knowledge, frozenset(words_of(each) for each in sentences))


@dataclass(frozen=True, slots=True)
class Learned:
    """Knowledge, and what it was learned from.

    Attributes:
        path: Knowledge file.
        heard: Words of every sentence that it was learned from; empty where that is not known.
    """

    path: Path
    heard: frozenset[tuple[str, ...]] = frozenset()


def from_collection(
    folder: Path | None, demos: int, seed: int, jobs: int, on_demo: Callable[[], None] = lambda: None
) -> Learned:
    """Learn from the scripted collection of the board, unless that was done before.

    Args:
        folder: Where demos and knowledge are kept; None takes the user's cache.
        demos: How many demos.
        seed: Seed of the collection.
        jobs: Processes that record; 0 takes one a core.
        on_demo: Called after every demo.
    """
    home = _home(folder)
    name = f"board_{demos}_{seed}"
    kept = Kept.of(home, name)
    if not kept.complete:
        lessons = show_and_learn(BoardCollection(home / name, seed, None, VARIETY), demos, jobs, on_demo)
        from executor.demo_files import open_demo

        files = [home / name / one.path.name for one in lessons.recorded]
        kept.write(lessons.knowledge, (each for file in files for each in open_demo(file).utterances))
    return kept.read()


def from_release(split: SplitRelease, folder: Path | None, seed: int) -> Learned:
    """Learn from the groups of a release that are not asked, unless that was done before."""
    home = _home(folder)
    kept = Kept.of(home, f"release_{len(split.learned)}_{len(split.release.commands)}_{seed}")
    if not kept.complete:
        scenes = {scene.number for scene in split.learned}
        commands = [command for command in split.release.commands if command.scene in scenes]
        learner = Learner(seed=seed)
        study_release(learner, split.learned, commands, np.random.default_rng(seed))
        learner.settle()
        kept.write(learner.knowledge, (command.sentence for command in commands))
    return kept.read()


def given(path: Path, kind: str) -> Learned:
    """Knowledge that someone brings, for scenes of a kind, `board` or `table`.

    Raises:
        KnowledgeError: It is none.
        InputError: It was learned on another kind of scene.
    """
    check_fit(Knowledge.load(path), kind, path)
    return Learned(path)


def _home(folder: Path | None) -> Path:
    return new_folder(user_folder("execution") if folder is None else folder)
