"""What is known of a table before commands are asked: learned from the robot's scripted collection, once, and kept."""

import json
from collections.abc import Callable
from pathlib import Path

from executor.collections import LeedsCollection, OrderingCollection, make_collection
from executor.execution.evaluation.learned import Learned
from executor.files import new_folder, written_whole
from learning import Learner
from learning.grounding.ngrams import words_of
from learning.perception.stage import perceive_demos
from robots.cache import user_folder

DEMOS = {"baxter": 102, "mico_segway": 224}
"""Demos that are recorded where nobody says how many: each thing of the tabletop twice; at the counter each action with
each thing once."""
LANGUAGES = ("en", "ar")


def usual_demos(robot: str, demos: int | None) -> int:
    """How many demos are learned from."""
    return DEMOS[robot] if demos is None else demos


def from_table_collection(
    robot: str, folder: Path | None, demos: int | None, seed: int, jobs: int, on_demo: Callable[[], None]
) -> Learned:
    """Record, perceive and learn a collection, unless that was done before; each step goes on where it was cut off.

    Args:
        robot: `baxter` or `mico_segway`.
        folder: Where demos and knowledge are kept; None takes the user's cache.
        demos: How many demos; None takes the usual number.
        seed: Seed of the collection.
        jobs: Processes; 0 takes one a core.
        on_demo: Called after every demo that was recorded.
    """
    count = usual_demos(robot, demos)
    home = new_folder(user_folder("execution") if folder is None else folder)
    name = f"{robot}_{count}_{seed}"
    path, said = home / f"{name}.json", home / f"{name}_sentences.json"
    if not (path.is_file() and said.is_file()):
        shown = new_folder(home / f"{robot}_{seed}")
        make = LeedsCollection if robot == "baxter" else OrderingCollection
        made = make_collection(make(shown, seed, LANGUAGES), range(count), jobs=jobs, on_demo=on_demo)
        sentences = _learn([each.path for each in made if each.done], shown / "observations", path, seed, jobs)
        with written_whole(said) as partial:
            partial.write_text(json.dumps(sentences, ensure_ascii=False), encoding="utf-8")
    return Learned(path, frozenset(words_of(each) for each in json.loads(said.read_text(encoding="utf-8"))))


def _learn(demos: list[Path], cache: Path, path: Path, seed: int, jobs: int) -> list[str]:
    """Learn from recorded demos; returns all their sentences."""
    from teleop import load_demo

    learner = Learner(seed=seed)
    heard: set[str] = set()
    for done in perceive_demos(demos, cache, seed=seed, jobs=jobs):
        if done.file is None:
            continue
        utterances = load_demo(done.demo).utterances
        learner.study(done.observation().observation, utterances)
        heard.update(utterances)
    learner.settle()
    learner.knowledge.save(path)
    return sorted(heard)
