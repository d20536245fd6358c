"""Demos with what is true of them, for `showtell evaluate concepts`: of a release, or recorded with sidecars."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from executor.errors import InputError

if TYPE_CHECKING:
    from executor.commands.output import Output
    from learning.evaluation.concepts import ScoredDemo
    from learning.perception.stage import PerceivedDemo

Shown = tuple[int, Iterator["ScoredDemo"]]
"""How many demos there are, and the demos."""


def board_scenes(directory: Path, count: int | None, seed: int) -> Shown:
    """Scenes of a release with the thesis's extensions, observed without physics.

    Args:
        directory: The release.
        count: How many scenes, drawn at random and kept in their order; None takes all.
        seed: Seed of extensions, choice and noise.

    Raises:
        ReleaseError: The release is malformed.
        InputError: In no scene does exactly one block move.
    """
    from learning.evaluation.concepts_board import extended_scenes, scored_scenes
    from learning.train_robots import Release

    rng = np.random.default_rng(seed)
    scenes = extended_scenes(Release.load(directory), rng)
    if not scenes:
        raise InputError(f"{directory}: in no scene does exactly one block move; there is nothing to look at")
    chosen = _chosen(len(scenes), count, seed)
    return len(chosen), scored_scenes([scenes[index] for index in chosen], rng)


def recorded_demos(
    where: Path, robot: str, out: "Output", *, cache: Path | None, count: int | None, seed: int, jobs: int
) -> Shown:
    """Recorded demos of a robot, with the truth of their sidecars; perceived first, unless they were before.

    Args:
        where: Folder of demos.
        robot: The robot that must have recorded them.
        out: Shows progress, and a line about each demo that is passed over.
        cache: Folder that keeps the observations; None is the one that `showtell perceive` takes.
        count: How many demos, drawn at random and kept in their order; None takes all.
        seed: Seed of choice and noise.
        jobs: Processes that look at the pictures; 0 takes one a core.

    Raises:
        InputError: There is no demo of that robot that could be perceived.
    """
    from executor.commands.perceive import CACHE
    from executor.demo_files import demo_paths
    from learning.perception.stage import perceive_demos

    paths = demo_paths(where)
    chosen = [paths[index] for index in _chosen(len(paths), count, seed)]
    folder = cache or (where if where.is_dir() else where.parent) / CACHE
    with out.progress("perceiving", len(chosen)) as advance:
        perceived = perceive_demos(chosen, folder, seed=seed, jobs=jobs, on_done=lambda done: advance())
    for each in perceived:
        if each.file is None:
            out.note(f"passed over: {each.demo}: {each.error}")
    usable = [each for each in perceived if each.file is not None]
    if not usable:
        raise InputError(f"{where}: no demo could be perceived; there is nothing to learn concepts from")
    return len(usable), _recorded(usable, robot, out)


def _recorded(perceived: list["PerceivedDemo"], robot: str, out: "Output") -> Iterator["ScoredDemo"]:
    """Put the truth of each demo beside what was perceived of it."""
    from executor.demo_files import read_demo
    from learning.evaluation.concepts_demos import scored_demo
    from robots import ShowtellError

    shown = 0
    for number, each in enumerate(perceived):
        try:
            demo = read_demo(each.demo)
            if demo.scene.robot != robot:
                raise InputError(f"{each.demo}: was recorded with {demo.scene.robot}, not with {robot}: see --robot")
            scored = scored_demo(demo, each.observation().observation, number)
        except ShowtellError as error:
            out.note(f"passed over: {error}")
            continue
        shown += 1
        yield scored
    if not shown:
        raise InputError(f"no demo of {robot} could be used: there is nothing to learn concepts from")


def _chosen(total: int, count: int | None, seed: int) -> list[int]:
    """Indices of some of `total`, ascending."""
    if count is None or count >= total:
        return list(range(total))
    return sorted(np.random.default_rng([seed, total]).choice(total, count, replace=False).tolist())
