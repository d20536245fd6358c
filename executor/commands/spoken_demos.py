"""Demos with what is true of them and of what was said, for `showtell evaluate grounding` and `evaluate grammar`."""

from pathlib import Path
from typing import TYPE_CHECKING

from executor.errors import InputError

if TYPE_CHECKING:
    from executor.commands.output import Output
    from learning.evaluation.table_exam import SpokenDemo


def spoken_demos(
    where: Path, robot: str, out: "Output", *, cache: Path | None, seed: int, jobs: int
) -> "list[SpokenDemo]":
    """Recorded demos of a table, perceived first unless they were before, with the true trees of their sentences.

    Args:
        where: Folder of demos.
        robot: The robot that must have recorded them.
        out: Shows progress, and a line about each demo that is passed over.
        cache: Folder that keeps the observations; None is the one that `showtell perceive` takes.
        seed: Seed of perception.
        jobs: Processes that look at the pictures; 0 takes one a core.

    Raises:
        InputError: There is no demo of that robot of which something was said.
    """
    from executor.commands.perceive import CACHE
    from executor.demo_files import demo_paths, read_demo
    from learning.evaluation.concepts_demos import scored_demo
    from learning.evaluation.table_exam import SpokenDemo
    from learning.evaluation.table_gold import gold_sentences
    from learning.perception.stage import perceive_demos
    from robots import ShowtellError
    from teleop.truth import read_truth

    paths = demo_paths(where)
    folder = cache or (where if where.is_dir() else where.parent) / CACHE
    with out.progress("perceiving", len(paths)) as advance:
        perceived = perceive_demos(paths, folder, seed=seed, jobs=jobs, on_done=lambda done: advance())
    found: list[SpokenDemo] = []
    for each in perceived:
        if each.file is None:
            out.note(f"passed over: {each.demo}: {each.error}")
            continue
        try:
            demo = read_demo(each.demo)
            if demo.scene.robot != robot:
                raise InputError(f"{each.demo}: was recorded with {demo.scene.robot}, not with {robot}: see --robot")
            scored = scored_demo(demo, each.observation().observation, len(found))
            sentences = tuple(gold_sentences(read_truth(demo.path)))
        except ShowtellError as error:
            out.note(f"passed over: {error}")
            continue
        if sentences:
            found.append(SpokenDemo(scored, sentences))
    if not found:
        raise InputError(f"{where}: nothing was said of any demo of {robot}; record some with `showtell record`")
    return found
