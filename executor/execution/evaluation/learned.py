"""What is known before commands are asked: learned from a scripted collection or from a release, once, and kept."""

import json
from collections.abc import Callable
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
from learning.grounding.ngrams import words_of
from robots.cache import user_folder

DEMOS = 200
"""Demos of the scripted collection, as many as `showtell demo` records."""


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
    path, said = home / f"{name}.json", home / f"{name}_sentences.json"
    if not (path.is_file() and said.is_file()):
        lessons = show_and_learn(BoardCollection(home / name, seed, None, VARIETY), demos, jobs, on_demo)
        from executor.demo_files import open_demo

        files = [home / name / one.path.name for one in lessons.recorded]
        sentences = sorted({each for file in files for each in open_demo(file).utterances})
        lessons.knowledge.save(path)
        with written_whole(said) as partial:
            partial.write_text(json.dumps(sentences), encoding="utf-8")
    sentences = json.loads(said.read_text(encoding="utf-8"))
    return Learned(path, frozenset(words_of(each) for each in sentences))


def from_release(split: SplitRelease, folder: Path | None, seed: int) -> Learned:
    """Learn from the groups of a release that are not asked, unless that was done before."""
    home = _home(folder)
    path = home / f"release_{len(split.learned)}_{len(split.release.commands)}_{seed}.json"
    commands = [command for command in split.release.commands if command.scene in {s.number for s in split.learned}]
    if not path.is_file():
        learner = Learner(seed=seed)
        study_release(learner, split.learned, commands, np.random.default_rng(seed))
        learner.settle()
        learner.knowledge.save(path)
    return Learned(path, frozenset(words_of(command.sentence) for command in commands))


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
