"""`showtell learn`: one incremental pass over demos or over a Train-Robots release."""

from pathlib import Path
from statistics import median
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from learning import Learner
    from learning.learner import Lesson

SPAN = 100
"""Demos at either end whose median times are compared."""


def learn(
    demos: Annotated[Path | None, typer.Argument(help="Folder of demos, or one demo.")] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="Knowledge file to write.")] = Path("knowledge.json"),
    train_robots: Annotated[
        Path | None, typer.Option(help="Learn from the layouts and commands of this release instead.")
    ] = None,
    resume: Annotated[Path | None, typer.Option(help="Knowledge to go on from.")] = None,
    skip_broken: Annotated[bool, typer.Option("--skip-broken", help="Pass over demos that are incomplete.")] = False,
    jobs: Annotated[int, typer.Option(min=0, help="Processes that look at demos of a table; 0 takes one a core.")] = 0,
    method: Annotated[str, typer.Option(help="How language is learned: `readings` or `thesis`.")] = "readings",
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn from demos and the sentences said with them, one demo at a time.

    Example: showtell learn demos/ -o knowledge.json
    """
    from executor.errors import InputError
    from executor.execution.knowledge_lock import locked
    from executor.files import check_place
    from learning import Knowledge, Learner

    out = Output(as_json)
    if (demos is None) == (train_robots is None):
        raise InputError("give either a folder of demos or --train-robots with the folder of a release")
    check_place(output)
    learner = Learner(Knowledge.load(resume) if resume else None, seed=seed, method=method)
    before = learner.knowledge.demos
    if demos is not None:
        lessons = _from_demos(out, learner, demos, skip_broken, seed, jobs)
    else:
        lessons = _from_release(out, learner, train_robots, seed)
    learner.settle()
    with locked(output):
        learner.knowledge.save(output)
    _tell(out, learner, output, before, lessons, seed)


def _from_demos(
    out: Output, learner: "Learner", where: Path, skip_broken: bool, seed: int, jobs: int
) -> list[tuple["Lesson", float]]:
    """Learn from recorded demos; returns what came of each and the time it took [s].

    What cameras saw at a table is perceived first, in parallel, and kept for the next time (`showtell perceive`).
    """
    from executor.commands.perceive import CACHE
    from executor.demo_files import demo_paths, open_demo
    from executor.errors import InputError
    from learning.perception.stage import perceive_demos
    from robots import ShowtellError

    paths = demo_paths(where)
    seen = {}
    if _at_table(paths):
        folder = (where if where.is_dir() else where.parent) / CACHE
        with out.progress("perceiving", len(paths)) as advance:
            done = perceive_demos(paths, folder, seed=seed, jobs=jobs, on_done=lambda outcome: advance())
        seen = {each.demo: each for each in done}
    lessons = []
    with out.progress("learning", len(paths)) as advance:
        for path in paths:
            try:
                demo = open_demo(path)
                begun = perf_counter()
                if path in seen:
                    lesson = learner.study(seen[path].observation().observation, demo.utterances)
                else:
                    lesson = learner.observe(demo)
                lessons.append((lesson, perf_counter() - begun))
            except ShowtellError as error:
                if not skip_broken:
                    raise
                out.note(f"passed over: {error}")
            advance()
    if not lessons:
        raise InputError(f"{where}: every demo is broken; nothing was learned")
    return lessons


def _at_table(paths: list[Path]) -> bool:
    """Whether the first demo that can be read shows a table."""
    from executor.demo_files import read_demo
    from robots import ShowtellError

    for path in paths:
        try:
            return read_demo(path).scene.kind != "board"
        except ShowtellError:
            continue
    return False


def _from_release(out: Output, learner: "Learner", directory: Path | None, seed: int) -> list[tuple["Lesson", float]]:
    """Learn from the key frames of a release; returns what came of each scene and the time it took [s]."""
    import numpy as np

    from executor.errors import InputError
    from executor.release_student import Studied, study_release
    from learning.train_robots import Release

    release = Release.load(directory or Path())
    lessons: list[tuple[Lesson, float]] = []
    scenes = release.one_block_scenes()
    if not scenes:
        raise InputError(f"{directory}: in no scene does exactly one block move; there is nothing to learn from")
    with out.progress("learning", len(scenes)) as advance:

        def keep(studied: Studied) -> None:
            lessons.append((studied.lesson, studied.seconds))
            advance()

        study_release(learner, scenes, release.commands, np.random.default_rng(seed), keep)
    return lessons


def _tell(
    out: Output, learner: "Learner", output: Path, before: int, lessons: list[tuple["Lesson", float]], seed: int
) -> None:
    """Print what came of it."""
    knowledge = learner.knowledge
    times = [seconds for _, seconds in lessons]
    heard = sum(lesson.sentences for lesson, _ in lessons)
    validated = sum(lesson.validated for lesson, _ in lessons)
    first, last = median(times[:SPAN]), median(times[-SPAN:])
    concepts = {name: len(mixture.components) for name, mixture in knowledge.spaces.mixtures.items()}
    concepts["action"] = len(knowledge.spaces.actions)
    out.say(f"{len(lessons)} demos learned from" + (f", on top of {before} earlier ones" if before else ""))
    unheard = sum(lesson.unheard for lesson, _ in lessons)
    out.say(f"{heard} sentences heard, {validated} of them read in a way that does what was shown")
    if unheard:
        out.say(f"{unheard} more were passed over: no action was seen with them")
    out.say("concepts: " + ", ".join(f"{count} {name}" for name, count in concepts.items()))
    span = min(SPAN, len(times))
    out.say(f"time a demo: median of the first {span} {1000 * first:.0f} ms, of the last {span} {1000 * last:.0f} ms")
    out.say(f"knowledge: {output} ({output.stat().st_size / 1000:.0f} kB)")
    out.result(
        {
            "knowledge": output,
            "bytes": output.stat().st_size,
            "demos": len(lessons),
            "demos_before": before,
            "sentences": heard,
            "validated": validated,
            "concepts": concepts,
            "median_seconds_first": round(first, 4),
            "median_seconds_last": round(last, 4),
            "seed": seed,
        }
    )


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(learn)
