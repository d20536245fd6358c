"""`showtell evaluate grounding` and `evaluate grammar`: words and sentences, as in tables 6.7 to 6.9 and 6.11."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from learning.evaluation.language_report import LanguageReport

Demos = Annotated[Path | None, typer.Argument(help="Folder of demos of a table with their truth beside them.")]
Release = Annotated[Path | None, typer.Option(help="Train-Robots release whose commands are looked at instead.")]
Folds = Annotated[int, typer.Option(min=2, help="Learn and ask in this many folds.")]
Cache = Annotated[Path | None, typer.Option(help="Folder that keeps the observations, as with `showtell perceive`.")]
Jobs = Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")]
Shown = Annotated[int, typer.Option(min=0, help="How many failures of each cause to list.")]


class Robot(StrEnum):
    """Whose collection."""

    THREE_DOF = "three_dof"
    BAXTER = "baxter"
    MICO_SEGWAY = "mico_segway"


def grounding(
    demos: Demos = None,
    robot: Annotated[Robot, typer.Option(help="Whose collection.")] = Robot.BAXTER,
    train_robots: Release = None,
    folds: Folds = 4,
    cache: Cache = None,
    plot: Annotated[Path | None, typer.Option(help="Picture of the learning curve (figure 6.19) to write.")] = None,
    jobs: Jobs = 0,
    failures: Shown = 5,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn words from demos, and compare what they mean with the truth, a supervised tagger and the thesis.

    Example: showtell evaluate grounding leeds/ --robot baxter --plot curve.png
    """
    from executor.commands.spoken_demos import spoken_demos
    from executor.errors import InputError
    from executor.picture import check_suffix
    from learning.evaluation.language_plot import plot_curve

    out = Output(as_json)
    if plot is not None:
        check_suffix(plot)
        if train_robots is not None:
            raise InputError("--plot draws the curve of demos of a table: `evaluate train-robots` has the board's")
    directory = _source(demos, train_robots, robot)
    if train_robots is not None:
        from executor.commands.release_language import release_language

        report = release_language(out, directory, folds=folds, seed=seed, jobs=jobs)
    else:
        from learning.evaluation.table_exam import grounding_exam

        spoken = spoken_demos(directory, robot.value, out, cache=cache, seed=seed, jobs=jobs)
        total = len(spoken) * (folds - 1) + (len(spoken) if plot is not None else 0)
        with out.progress("learning", total) as advance:
            report = grounding_exam(
                spoken, robot=robot.value, folds=folds, seed=seed, curve=plot is not None, on_demo=advance
            )
    if plot is not None and report.curve:
        plot_curve(report, plot)
        out.say(f"learning curve: {plot}")
    _tell_grounding(out, report)
    _tell_failures(out, report, failures)
    out.result(report.to_json())


def grammar(
    demos: Demos = None,
    robot: Annotated[Robot, typer.Option(help="Whose collection.")] = Robot.BAXTER,
    train_robots: Release = None,
    folds: Folds = 4,
    cache: Cache = None,
    jobs: Jobs = 0,
    failures: Shown = 5,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn a grammar from demos, and compare its trees with the true ones, and with bounds above and below.

    Example: showtell evaluate grammar leeds/ --robot baxter --json
    """
    from executor.commands.spoken_demos import spoken_demos

    out = Output(as_json)
    directory = _source(demos, train_robots, robot)
    if train_robots is not None:
        from executor.commands.release_language import release_language

        report = release_language(out, directory, folds=folds, seed=seed, jobs=jobs)
    else:
        from learning.evaluation.table_exam import grammar_exam

        spoken = spoken_demos(directory, robot.value, out, cache=cache, seed=seed, jobs=jobs)
        with out.progress("learning", len(spoken) * (folds - 1)) as advance:
            report = grammar_exam(spoken, robot=robot.value, folds=folds, seed=seed, on_demo=advance)
    _tell_grammar(out, report)
    _tell_failures(out, report, failures)
    out.result(report.to_json())


def _source(demos: Path | None, train_robots: Path | None, robot: Robot) -> Path:
    """The folder that is looked at.

    Raises:
        InputError: None was given, or two, or one that does not fit the robot.
    """
    from executor.errors import InputError

    if demos is not None and train_robots is not None or (demos or train_robots) is None:
        raise InputError("give either a folder of demos or --train-robots with the folder of a release")
    if demos is not None and robot is Robot.THREE_DOF:
        raise InputError("demos of the board have no true trees beside them: give --train-robots with a release")
    return demos or train_robots or Path()


def _tell_grounding(out: Output, report: "LanguageReport") -> None:
    from learning.evaluation import language_thesis
    from learning.evaluation.language_report import spaces_in

    figures, baselines = report.figures(), report.baselines()
    spaces = spaces_in({**figures, **baselines}, "f1") or spaces_in(baselines, "hmm")
    theirs = language_thesis.GROUNDING.get(report.robot, {})
    rows = []
    for space in spaces:
        thesis = theirs.get(space)
        published = ("-", "-") if thesis is None else (f"{thesis[0]:.2f}", f"{thesis[1]:.2f}")
        rows.append((space, _figure(figures.get(f"f1.{space}")), _figure(baselines.get(f"hmm.{space}")), *published))
    columns = ("feature", "ours", "HMM (supervised)", "thesis, own data", "its HMM")
    out.table(f"F1 of grounding, {report.robot} (thesis table 6.7)", columns, rows)
    by_use = spaces_in(figures, "f1_by_use")
    if by_use:
        out.table(
            "The same with each pair counted as often as it is used",
            ("feature", "ours", "HMM (supervised)"),
            [
                (space, _figure(figures[f"f1_by_use.{space}"]), _figure(baselines.get(f"hmm_by_use.{space}")))
                for space in by_use
            ],
        )
    languages = sorted({name.split(".")[2] for name in figures if name.count(".") == 2 and name.startswith("f1.")})
    if len(languages) > 1:
        heads = [f"{who} {language}" for language in languages for who in ("ours", "HMM")]
        table = [
            (
                space,
                *(
                    _figure(source.get(f"{before}.{space}.{language}"))
                    for language in languages
                    for before, source in (("f1", figures), ("hmm", baselines))
                ),
            )
            for space in spaces
        ]
        out.table("F1 by language (thesis table 6.8)", ("feature", *heads), table)
    if figures.get("translation.accuracy") is not None:
        out.say(f"translations right: {_figure(figures['translation.accuracy'])} (thesis 6.4.2)")
    if report.curve:
        table = [(str(learned), *(_figure(scores.get(space)) for space in spaces)) for learned, scores in report.curve]
        out.table("F1 with more and more demos (figure 6.19)", ("learned from", *spaces), table)


def _tell_grammar(out: Output, report: "LanguageReport") -> None:
    from learning.evaluation import language_thesis

    figures, baselines = report.figures(), report.baselines()
    names = sorted(name for name in figures if name.startswith("subtree_score"))
    rows = [
        (
            name.removeprefix("subtree_score").lstrip(".") or "all",
            *(_figure(baselines.get(f"{who}.{name}")) for who in ("right_branching", "unsupervised")),
            _figure(figures[name]),
            _figure(baselines.get(f"supervised.{name}")),
        )
        for name in names
    ]
    thesis = language_thesis.GRAMMAR.get(report.robot)
    if thesis is not None:
        rows.append(("thesis, own data", "-", *(f"{value:.2f}" for value in thesis)))
    columns = ("language", "right branching", "unsupervised", "ours", "supervised PCFG")
    out.table(f"Sub-tree score, {report.robot} (thesis tables 6.9 and 6.11)", columns, rows)
    folds = [(str(number + 1), _figure(fold.figures.get("subtree_score"))) for number, fold in enumerate(report.folds)]
    out.table("By fold", ("fold", "ours"), folds)


def _tell_failures(out: Output, report: "LanguageReport", most: int) -> None:
    causes = report.causes()
    if causes:
        out.table("Failures by cause", ("cause", "how many"), [(cause, str(count)) for cause, count in causes])
    rows = [
        (each.cause, each.language, each.text, each.detail)
        for cause, _ in causes
        for each in [failure for failure in report.failures() if failure.cause == cause][:most]
    ]
    if rows:
        out.table(f"Up to {most} of each", ("cause", "language", "text", "what came"), rows)
    out.say(f"settings: {dict(report.settings)}; seed {report.seed}")


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def add_to(app: typer.Typer) -> None:
    """Add the commands to an app."""
    app.command()(grounding)
    app.command()(grammar)
