"""What is known of a table before commands are asked: learned from the robot's scripted collection, once, and kept."""

from collections.abc import Callable
from pathlib import Path

from executor.collections import LeedsCollection, OrderingCollection, make_collection
from executor.execution.evaluation.learned import Kept, Learned
from executor.files import new_folder
from learning import Knowledge, Learner
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
    kept = Kept.of(home, f"{robot}_{count}_{seed}")
    if not kept.complete:
        shown = new_folder(home / f"{robot}_{seed}")
        make = LeedsCollection if robot == "baxter" else OrderingCollection
        made = make_collection(make(shown, seed, LANGUAGES), range(count), jobs=jobs, on_demo=on_demo)
        kept.write(*_learn([each.path for each in made if each.done], shown / "observations", seed, jobs))
    return kept.read()


def _learn(demos: list[Path], cache: Path, seed: int, jobs: int) -> tuple[Knowledge, set[str]]:
    """Learn from recorded demos; returns all their sentences, too."""
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
    return learner.knowledge, heard
