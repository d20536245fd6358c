"""`showtell evaluate describe`: are the sentences that we make understood, and are they true?"""

from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    import numpy as np

    from learning import Knowledge
    from learning.evaluation.describe_report import Described, DescribeReport
    from learning.evaluation.folds import Fold
    from learning.train_robots import Release

FOLDS = 4
"""Folds that demos or groups of scenes are dealt out to."""


class TableRobot(StrEnum):
    """Whose collection."""

    BAXTER = "baxter"
    MICO_SEGWAY = "mico_segway"


def describe(
    demos: Annotated[Path | None, typer.Argument(help="Folder of demos of a table with their truth.")] = None,
    robot: Annotated[TableRobot, typer.Option(help="Whose collection.")] = TableRobot.BAXTER,
    train_robots: Annotated[Path | None, typer.Option(help="Train-Robots release to describe scenes of.")] = None,
    knowledge: Annotated[
        Path | None, typer.Option(help="Knowledge to speak by, learned from other demos; learned here without it.")
    ] = None,
    folds: Annotated[
        int, typer.Option(min=1, max=FOLDS, help=f"How many of {FOLDS} folds to learn without and describe.")
    ] = FOLDS,
    count: Annotated[int, typer.Option("--demos", min=1, help="Demos to describe.")] = 200,
    objects: Annotated[int, typer.Option(min=1, help="Objects to describe.")] = 200,
    cache: Annotated[Path | None, typer.Option(help="Folder that keeps the observations.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes that look at demos; 0 takes one a core.")] = 0,
    shown: Annotated[int, typer.Option("--sentences", min=0, help="How many sentences to list.")] = 20,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Say what demos show and where objects are that were not learned from, and check how that is understood.

    Example: showtell evaluate describe --train-robots train-robots/ --folds 1
    """
    from executor.errors import InputError
    from executor.knowledge_fit import check_fit
    from learning import Knowledge

    out = Output(as_json)
    if (demos is None) == (train_robots is None):
        raise InputError("give either a folder of demos or --train-robots with the folder of a release")
    if knowledge is not None:
        check_fit(Knowledge.load(knowledge), "table" if train_robots is None else "board", knowledge)
    if train_robots is not None:
        report = _board(out, train_robots, knowledge, folds, count, objects, seed)
    else:
        report = _table(out, demos or Path(), robot.value, knowledge, folds, count, objects, cache, jobs, seed)
    _tell(out, report, shown)
    out.result(report.to_json())


def _board(
    out: Output, directory: Path, knowledge: Path | None, folds: int, demos: int, objects: int, seed: int
) -> "DescribeReport":
    import numpy as np

    from learning import Knowledge
    from learning.evaluation.describe_report import DescribeReport
    from learning.evaluation.folds import make_folds
    from learning.train_robots import Release

    release = Release.load(directory)
    rng = np.random.default_rng(seed)
    described: list[Described] = []
    people: list[tuple[bool, bool | None]] = []
    dealt = make_folds(release, FOLDS, "groups", np.random.default_rng(seed)) if knowledge is None else []
    parts: list[Fold | None] = [*dealt[:folds]] or [None]
    for number, part in enumerate(parts):
        learned = Knowledge.load(knowledge) if knowledge is not None else _learned(out, part, seed)
        some = [total // len(parts) + (number < total % len(parts)) for total in (demos, objects)]
        with out.progress("describing", sum(some)) as advance:
            mine, theirs = _described(release, part, learned, some, rng, advance)
        described += mine
        people += theirs
    true = [truly for _, truly in people if truly is not None]
    baselines = {
        "people.event.same": _mean([same for same, _ in people]),
        "people.event.true": _mean(true) if true else None,
    }
    settings = {"folds": None if knowledge is not None else folds, "of": FOLDS, "split": "groups"}
    return DescribeReport(tuple(described), baselines, seed, settings)


def _learned(out: Output, fold: "Fold | None", seed: int) -> "Knowledge":
    from executor.release_student import LearnRelease

    if fold is None:
        from learning import Knowledge

        return Knowledge()
    out.note(f"learning from {len(fold.learned)} commands of the other groups")
    learned = LearnRelease(seed)(fold.scenes, fold.learned).knowledge
    learned.rehear()
    return learned


def _described(
    release: "Release",
    fold: "Fold | None",
    knowledge: "Knowledge",
    some: list[int],
    rng: "np.random.Generator",
    advance: Callable[[], None],
) -> "tuple[list[Described], list[tuple[bool, bool | None]]]":
    """Describe scenes of a fold, or of all the release; and how people's own commands fare there."""
    from learning.evaluation.annotation import load_annotations
    from learning.evaluation.describe_board import BoardDescriber, describe_scenes
    from learning.evaluation.describe_truth import SupervisedReader
    from learning.saying.speaker import Speaker

    trees = load_annotations(release.directory)
    asked = release.commands if fold is None else fold.asked
    taught = asked if fold is None else fold.learned
    reader = None
    if trees is not None:
        reader = SupervisedReader((each.sentence, trees[each.id]) for each in taught if each.id in trees)
    learned = set() if fold is None else {scene.number for scene in fold.scenes}
    scenes = [scene for scene in release.scenes.values() if scene.number not in learned]
    describer = BoardDescriber(knowledge, Speaker(knowledge), reader, rng)
    rows = describe_scenes(describer, scenes, demos=some[0], objects=some[1], rng=rng, on_done=advance)
    numbers = {each.source for each in rows}
    theirs = [
        each
        for scene in scenes
        if f"scene {scene.number}" in numbers
        for each in describer.people(scene, [command for command in asked if command.scene == scene.number])
    ]
    return rows, theirs


def _table(
    out: Output,
    directory: Path,
    robot: str,
    knowledge: Path | None,
    folds: int,
    demos: int,
    objects: int,
    cache: Path | None,
    jobs: int,
    seed: int,
) -> "DescribeReport":
    import numpy as np

    from executor.commands.spoken_demos import spoken_demos
    from learning import Knowledge, Learner
    from learning.evaluation.describe_report import DescribeReport
    from learning.evaluation.describe_table import describe_demos

    spoken = spoken_demos(directory, robot, out, cache=cache, seed=seed, jobs=jobs)
    rng = np.random.default_rng(seed)
    described: list[Described] = []
    parts = 1 if knowledge is not None else folds
    for fold in range(parts):
        mine = list(enumerate(spoken))
        if knowledge is not None:
            learned = Knowledge.load(knowledge)
        else:
            mine = [(number, demo) for number, demo in enumerate(spoken) if number % FOLDS == fold]
            learner = Learner(seed=seed)
            with out.progress("learning", len(spoken) - len(mine)) as advance:
                for number, demo in enumerate(spoken):
                    if number % FOLDS != fold:
                        learner.study(demo.demo.observation, demo.demo.utterances)
                        advance()
            learner.settle()
            learned = learner.knowledge
        some = [total // parts + (fold < total % parts) for total in (demos, objects)]
        chosen = mine[: some[0]]
        with out.progress("describing", len(chosen) + some[1]) as advance:
            described += describe_demos(learned, chosen, objects=some[1], rng=rng, on_done=advance)
    settings = {"folds": None if knowledge is not None else folds, "of": FOLDS, "demos": len(spoken)}
    return DescribeReport(tuple(described), {}, seed, settings)


def _tell(out: Output, report: "DescribeReport", shown: int) -> None:
    rows = [(name, _figure(value)) for name, value in report.figures().items()]
    rows += [(f"baseline {name}", _figure(value)) for name, value in report.baselines.items()]
    out.table("Sentences that we make", ("figure", "value"), rows)
    causes = report.causes()
    if causes:
        out.table("What is wrong with some", ("cause", "how many"), [(cause, str(number)) for cause, number in causes])
    said = [(each.source, each.text or "-", each.cause) for each in report.described[:: _stride(report, shown)]][:shown]
    if said:
        out.table("Some of them", ("of", "sentence", "what is wrong"), said)
    out.say(f"settings: {dict(report.settings)}; seed {report.seed}")


def _stride(report: "DescribeReport", shown: int) -> int:
    return max(1, len(report.described) // max(1, shown))


def _mean(values: list[bool]) -> float | None:
    return sum(values) / len(values) if values else None


def _figure(value: float | None) -> str:
    if value is None:
        return "-"
    return str(int(value)) if float(value).is_integer() and value > 1 else f"{value:.3f}"


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(describe)
