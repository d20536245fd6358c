"""`showtell evaluate`: how good is what was learned? One command an experiment."""

import os
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands import evaluate_actions, evaluate_concepts, evaluate_language, evaluate_tracking
from executor.commands.output import Json, Output, Seed, ShowtellGroup

if TYPE_CHECKING:
    from learning.evaluation import TrainRobotsReport

app = typer.Typer(
    cls=ShowtellGroup, no_args_is_help=True, help="Reproduce an experiment, with our figures and each baseline's."
)

evaluate_actions.add_to(app)
evaluate_concepts.add_to(app)
evaluate_language.add_to(app)
evaluate_tracking.add_to(app)


class Split(StrEnum):
    """How commands are dealt out to folds."""

    GROUPS = "groups"
    COMMANDS = "commands"


class Method(StrEnum):
    """How language is learned."""

    READINGS = "readings"
    THESIS = "thesis"


@app.callback()
def _experiments() -> None:
    """Reproduce an experiment, with our figures and each baseline's."""


@app.command("train-robots")
def train_robots(
    directory: Annotated[Path, typer.Argument(help="Directory with commands.txt and configuration.txt.")],
    knowledge: Annotated[Path | None, typer.Option(help="Ask this knowledge all commands.")] = None,
    folds: Annotated[
        int | None, typer.Option(min=2, help="Learn and ask in this many folds (4 without --knowledge).")
    ] = None,
    split: Annotated[Split, typer.Option(help="What shares a fold: scenes of a group, or nothing.")] = Split.GROUPS,
    method: Annotated[Method, typer.Option(help="How language is learned in folds.")] = Method.READINGS,
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
    from executor.release_student import LearnRelease, ReleaseStudent
    from learning import Knowledge
    from learning.evaluation import cross_validate, examine
    from learning.train_robots import Release

    out = Output(as_json)
    if knowledge is not None and folds is not None:
        raise InputError("give --knowledge to ask what was learned before, or --folds to learn anew, not both")
    release = Release.load(directory)
    if not release.commands:
        raise InputError(f"{directory}: commands.txt holds no command; there is nothing to ask")
    if knowledge is not None:
        student = ReleaseStudent(Knowledge.load(knowledge), np.random.default_rng(seed))
        with out.progress("asking", len(release.commands)) as advance:
            report = examine(release, student, seed=seed, on_answer=advance)
    else:
        count = folds or 4
        with out.progress(f"learning and asking {count} folds", count) as advance:
            report = cross_validate(
                release,
                LearnRelease(seed, method.value),
                folds=count,
                split=split.value,
                seed=seed,
                jobs=jobs or len(os.sched_getaffinity(0)),
                on_fold=lambda done, total: advance(),
            )
    _tell(out, report, failures)
    out.result(report.to_json())


def _tell(out: Output, report: "TrainRobotsReport", failures: int) -> None:
    """Print the figures beside the baselines', by kind of command, and some failures."""
    figures = report.to_json()
    main = {name: value for name, value in figures["figures"].items() if not name.startswith("kind.")}
    rows = [(name, _figure(value)) for name, value in main.items()]
    rows += [(f"baseline {name}", _figure(value)) for name, value in figures["baselines"].items()]
    out.table("Train-Robots commands", ("figure", "value"), rows)
    kinds = [(kind, commands, right, _figure(right / commands)) for kind, commands, right in report.kind_table()]
    if kinds:
        out.table("By kind of command", ("kind", "commands", "right", "share"), kinds)
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
