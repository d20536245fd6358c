"""`showtell evaluate train-robots`: how many of the public release's commands are understood rightly."""

from collections.abc import Sequence
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from learning.evaluation import TrainRobotsReport
    from learning.train_robots import Release


class Split(StrEnum):
    """How commands are dealt out to folds."""

    GROUPS = "groups"
    COMMANDS = "commands"


class Method(StrEnum):
    """How language is learned."""

    READINGS = "readings"
    THESIS = "thesis"


def train_robots(
    directory: Annotated[Path, typer.Argument(help="Directory with commands.txt and configuration.txt.")],
    knowledge: Annotated[Path | None, typer.Option(help="Ask this knowledge all commands.")] = None,
    folds: Annotated[
        int | None, typer.Option(min=2, help="Learn and ask in this many folds (4 without --knowledge).")
    ] = None,
    split: Annotated[Split, typer.Option(help="What shares a fold: scenes of a group, or nothing.")] = Split.GROUPS,
    method: Annotated[Method, typer.Option(help="How language is learned in folds.")] = Method.READINGS,
    extended: Annotated[
        bool, typer.Option("--extended", help="Also learn and ask the extended release: more shapes and colours.")
    ] = False,
    epsilon: Annotated[
        list[float] | None,
        typer.Option(
            help="Sparsity of groundings, in 0..1 (figure 6.22). Repeat it to compare several; first is ours."
        ),
    ] = None,
    commands: Annotated[
        int, typer.Option(min=0, help="Use about this many commands, evenly from all; 0 takes all.")
    ] = 0,
    plot: Annotated[Path | None, typer.Option(help="Picture of the learning curve (figure 6.19) to write.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes for folds; 0 takes one a core.")] = 0,
    failures: Annotated[int, typer.Option(min=0, help="How many failures to list.")] = 10,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Ask the commands of a Train-Robots release: is the right block moved to the right cell?

    Example: showtell evaluate train-robots train-robots/ --folds 4 --split groups --json
    """
    import numpy as np

    from executor.errors import InputError
    from executor.knowledge_fit import check_fit
    from executor.picture import check_suffix
    from executor.release_student import LearnRelease, ReleaseStudent
    from learning import Knowledge
    from learning.evaluation import cross_validate, examine
    from learning.train_robots import Release
    from learning.train_robots import extended as extend
    from robots.workers import worker_count

    out = Output(as_json)
    values = epsilon or []
    if knowledge is not None and (folds is not None or extended or values or plot is not None):
        raise InputError(
            "--knowledge asks what was learned before; --folds, --extended, --epsilon and --plot learn anew: not both"
        )
    if any(not 0.0 < value < 1.0 for value in values):
        raise InputError(f"--epsilon {', '.join(map(str, values))}: give shares above 0 and below 1, such as 0.05")
    if plot is not None:
        check_suffix(plot)
    release = _some(Release.load(directory), commands)
    if not release.commands:
        raise InputError(f"{directory}: commands.txt holds no command; there is nothing to ask")
    if knowledge is not None:
        known = Knowledge.load(knowledge)
        check_fit(known, "board", knowledge)
        student = ReleaseStudent(known, np.random.default_rng(seed))
        with out.progress("asking", len(release.commands)) as advance:
            report = examine(release, student, seed=seed, on_answer=advance)
        _tell(out, report, failures)
        out.result(report.to_json())
        return
    count = folds or 4
    runs = 1 + extended + max(0, len(values) - 1)

    def run(asked: Release, value: float | None, *, curve: bool = False) -> "TrainRobotsReport":
        return cross_validate(
            asked,
            LearnRelease(seed, method.value, value),
            folds=count,
            split=split.value,
            seed=seed,
            jobs=worker_count(jobs),
            curve=curve,
            on_fold=lambda done, total: advance(),
        )

    with out.progress(f"learning and asking {count} folds", count * runs) as advance:
        report = run(release, values[0] if values else None, curve=plot is not None)
        more = run(extend(release, np.random.default_rng(seed)), values[0] if values else None) if extended else None
        compared = [(value, report if number == 0 else run(release, value)) for number, value in enumerate(values)]
    _tell(out, report, failures)
    result = report.to_json()
    if more is not None:
        _tell(out, more, failures, "Extended release (thesis 6.2.1)")
        result["extended"] = more.to_json()
        result["figures"] |= {f"extended.{name}": more.figures()[name] for name in BESIDE}
    accuracies = [(value, float(each.figures()["execution_accuracy"] or 0.0)) for value, each in compared]
    if len(accuracies) > 1:
        out.table("Sensitivity to ε (figure 6.22)", ("ε", "accuracy"), [(v, _figure(a)) for v, a in accuracies])
    result["figures"] |= {f"epsilon.{value}.execution_accuracy": share for value, share in accuracies}
    if plot is not None:
        _draw(out, plot, report, accuracies)
    out.result(result)


BESIDE = ("commands", "execution_accuracy", "execution_accuracy_without_held", "rcl_exact", "subtree_score")
"""Figures of the extended release that stand beside the public one's."""


def _some(release: "Release", count: int) -> "Release":
    """The release with about so many of its commands, taken evenly."""
    if not 0 < count < len(release.commands):
        return release
    return replace(release, commands=release.commands[:: round(len(release.commands) / count)])


def _draw(out: Output, path: Path, report: "TrainRobotsReport", accuracies: Sequence[tuple[float, float]]) -> None:
    from learning.evaluation.train_robots_plot import plot_learning

    others = [
        (name.removesuffix(".execution_accuracy"), value)
        for name, value in report.to_json()["baselines"].items()
        if value is not None
    ]
    plot_learning(path, report.curve, accuracies if len(accuracies) > 1 else (), others)
    rows = [(heard, _figure(share)) for heard, share in report.curve]
    out.table("With more and more commands (figure 6.19)", ("commands heard", "accuracy of a sample"), rows)
    out.say(f"learning curve: {path}")


def _tell(out: Output, report: "TrainRobotsReport", failures: int, title: str = "Train-Robots commands") -> None:
    """Print the figures beside the baselines', by kind of command, and some failures."""
    figures = report.to_json()
    main = {name: value for name, value in figures["figures"].items() if not name.startswith("kind.")}
    rows = [(name, _figure(value)) for name, value in main.items()]
    rows += [(f"baseline {name}", _figure(value)) for name, value in figures["baselines"].items()]
    out.table(title, ("figure", "value"), rows)
    kinds = [(kind, commands, right, _figure(right / commands)) for kind, commands, right in report.kind_table()]
    if kinds:
        out.table("By kind of command", ("kind", "commands", "right", "share"), kinds)
    if report.reasons():
        out.table("Failures by reason", ("reason", "commands"), report.reasons())
    wrong = figures["failures"][:failures]
    if wrong:
        out.table(
            f"First {len(wrong)} of {len(figures['failures'])} failures",
            ("command", "scene", "sentence", "reason"),
            [(each["command"], each["scene"], each["sentence"], each["reason"]) for each in wrong],
        )
    out.say(f"settings: {figures['settings']}; seed {figures['seed']}; machine: {figures['machine']}")


def _figure(value: float | None) -> str:
    if value is None:
        return "-"
    return str(int(value)) if float(value).is_integer() and value > 1 else f"{value:.3f}"


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command("train-robots")(train_robots)
