"""Demos that show actions: found by robot and true action, and perceived in parallel."""

from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from executor.actions.learned import true_name
from executor.errors import InputError

if TYPE_CHECKING:
    from learning.perception.observation import Observation


@dataclass(frozen=True, slots=True)
class ShownDemo:
    """A recorded demo with its true action.

    Attributes:
        path: The recording.
        robot: The robot that shows it.
        action: True name of the action, as the sidecar has it.
    """

    path: Path
    robot: str
    action: str


def shown_demos(folders: Sequence[Path], most: int, note: Callable[[str], None]) -> list[ShownDemo]:
    """The first demos of each robot and action in folders.

    Args:
        folders: Folders of demos with their truth beside them; each holds demos of one robot.
        most: How many of each robot and action.
        note: Called with a line about each demo that was passed over.

    Raises:
        InputError: A folder holds no demo, or no demo tells its action.
    """
    from executor.demo_files import demo_paths, read_demo
    from teleop.errors import DemoError
    from teleop.truth import read_truth

    found: defaultdict[tuple[str, str], list[ShownDemo]] = defaultdict(list)
    for folder in folders:
        robot = ""
        for path in demo_paths(folder):
            try:
                action = true_name(read_truth(path))
                robot = robot or read_demo(path).scene.robot
            except DemoError as error:
                note(f"passed over: {error}")
                continue
            if action is None:
                note(f"passed over: {path}: its truth names no action")
            elif len(found[robot, action]) < most:
                found[robot, action].append(ShownDemo(path, robot, action))
    demos = [demo for each in found.values() for demo in each]
    if not demos:
        raise InputError(
            f"{', '.join(map(str, folders))}: no demo tells its action; record some with `showtell record --collection`"
        )
    # In the order of the files: all actions follow each other, as they were shown.
    return sorted(demos, key=lambda demo: demo.path.name)


def observed(
    demos: Sequence[ShownDemo],
    cache: Path | None,
    seed: int,
    jobs: int,
    on_demo: Callable[[], None],
    note: Callable[[str], None],
) -> list[tuple["Observation", str]]:
    """Look at demos; those that cannot be perceived are passed over.

    Args:
        demos: The demos.
        cache: Folder in which observations are kept; None keeps none.
        seed: Seed of all noise.
        jobs: Processes; 0 takes one a core.
        on_demo: Called after every demo.
        note: Called with a line about each demo that was passed over.
    """
    from learning.perception.stage import perceive_demos

    with TemporaryDirectory() as temporary:
        folder = Path(temporary) if cache is None else cache
        paths = [demo.path for demo in demos]
        done = perceive_demos(paths, folder, seed=seed, jobs=jobs, on_done=lambda _: on_demo())
        pairs = []
        for demo, outcome in zip(demos, done, strict=True):
            if outcome.file is None:
                note(f"passed over: {demo.path}: {outcome.error}")
            else:
                pairs.append((outcome.observation().observation, demo.action))
    return pairs
