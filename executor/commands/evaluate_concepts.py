"""`showtell evaluate concepts`: do the concepts found agree with the classes there are? Tables 6.1, 6.3 to 6.5."""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import Json, Output, Seed

if TYPE_CHECKING:
    from learning.concepts import SpaceSet
    from learning.evaluation.concepts_metrics import ClusterScores
    from learning.evaluation.concepts_report import ConceptRow, ConceptsReport
    from learning.evaluation.concepts_thesis import ThesisTable
    from learning.evaluation.concepts_truth import TruthRules


class Robot(StrEnum):
    """Whose table."""

    THREE_DOF = "three_dof"
    BAXTER = "baxter"
    MICO_SEGWAY = "mico_segway"


def concepts(
    demos: Annotated[Path | None, typer.Argument(help="Folder of demos with their truth beside them.")] = None,
    robot: Annotated[Robot, typer.Option(help="Whose table of the thesis: 6.3, 6.4 or 6.5.")] = Robot.THREE_DOF,
    train_robots: Annotated[
        Path | None, typer.Option(help="Release whose extended scenes are looked at instead, without physics.")
    ] = None,
    count: Annotated[int | None, typer.Option(min=1, help="So many demos only, drawn at random.")] = None,
    labels: Annotated[int, typer.Option(min=0, help="Name one object in so many demos too; prints the gain.")] = 0,
    pure: Annotated[bool, typer.Option(help="Run the pure IGMM of appendix A too.")] = True,
    sentences: Annotated[
        bool, typer.Option("--sentences", help="Learn from the sentences too, for the memory curve.")
    ] = False,
    cache: Annotated[
        Path | None, typer.Option(help="Folder that keeps the observations, as with `showtell perceive`.")
    ] = None,
    plot: Annotated[Path | None, typer.Option(help="Picture of the memory curve (figure 6.24) to write.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes that look at demos; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Learn concepts from demos, and compare them with the true classes, with an SVM and with the thesis.

    Example: showtell evaluate concepts --robot three_dof --train-robots train-robots/ --json

    Example: showtell evaluate concepts --robot baxter leeds/ --plot memory.png
    """
    from executor.commands.scored_demos import board_scenes, recorded_demos
    from executor.errors import InputError
    from executor.picture import check_suffix
    from learning import Learner
    from learning.evaluation.concepts import evaluate_concepts
    from learning.evaluation.concepts_memory import plot_memory

    out = Output(as_json)
    if (demos is None) == (train_robots is None):
        raise InputError("give either a folder of demos or --train-robots with the folder of a release")
    if train_robots is not None and robot is not Robot.THREE_DOF:
        raise InputError(f"--train-robots shows the board of three_dof, not {robot.value}: give a folder of demos")
    if plot is not None:
        check_suffix(plot)
    spaces, rules = spaces_and_rules(robot)
    if train_robots is not None:
        total, shown = board_scenes(train_robots, count, seed)
    else:
        total, shown = recorded_demos(demos or Path(), robot.value, out, cache=cache, count=count, seed=seed, jobs=jobs)
    learner = Learner(seed=seed) if sentences else None
    with out.progress("looking and learning", total) as advance:
        report = evaluate_concepts(
            shown,
            total,
            spaces,
            rules,
            robot=robot.value,
            seed=seed,
            pure=pure,
            labels=labels,
            learner=learner,
            on_demo=advance,
        )
    if plot is not None:
        plot_memory(report.memory, plot)
        out.say(f"memory curve: {plot}")
    tell(out, report)
    out.result(report.to_json())


def spaces_and_rules(robot: Robot) -> tuple["SpaceSet", "TruthRules"]:
    """Feature spaces of a robot, and the true classes of its table."""
    from learning.concepts import BOARD, COUNTER, TABLE
    from learning.evaluation.concepts_truth import BOARD_RULES, COUNTER_RULES, TABLE_RULES

    return {
        Robot.THREE_DOF: (BOARD, BOARD_RULES),
        Robot.BAXTER: (TABLE, TABLE_RULES),
        Robot.MICO_SEGWAY: (COUNTER, COUNTER_RULES),
    }[robot]


def tell(out: Output, report: "ConceptsReport") -> None:
    """Print the tables."""
    thesis = report.thesis
    metrics = [
        (
            row.name,
            str(row.instances),
            f"{row.ours.mutual_information:.2f}",
            *(f"{value:.3f}" for value in (row.ours.normalised, row.ours.homogeneity, row.ours.completeness)),
            f"{row.ours.v_measure:.3f}",
        )
        for row in report.rows
    ]
    for row in report.rows:
        if row.unmeasured:
            out.say(f"{row.name} was never measured of {row.unmeasured} objects: they are scored for nobody")
    number = thesis.table if thesis else "6.3"
    columns = ("feature", "instances", "MI", "NMI", "homogeneity", "completeness", "V-measure")
    out.table(f"Concepts of {report.robot}: ours (thesis table {number})", columns, metrics)
    beside = [(row.name, _ours(row), _figure(row.svm), _pure(row.pure, row.pure_known), _theirs(row, thesis))
              for row in report.rows]  # fmt: skip
    sources = ("feature", "ours", "SVM", "pure IGMM", "thesis, own data")
    out.table("V-measure, and concepts found (true ones)", sources, beside)
    labelled = [
        (row.name, f"{row.ours.v_measure:.3f}", f"{row.labelled:.3f}", f"{row.labelled - row.ours.v_measure:+.3f}",
         f"{row.concepts} -> {row.labelled_concepts}")
        for row in report.rows
        if row.labelled is not None
    ]  # fmt: skip
    if labelled:
        title = f"With one object named in each of {report.settings['labels']} demos"
        out.table(title, ("feature", "V without", "V with", "gain", "concepts"), labelled)
    _tell_collection(out, report)
    _tell_memory(out, report)
    out.say(f"settings: {dict(report.settings)}; seed {report.seed}")


def _tell_collection(out: Output, report: "ConceptsReport") -> None:
    summary, thesis = report.summary, report.thesis
    ours = (summary.clips, summary.frames, summary.commands, summary.words, f"{summary.objects:.1f}")
    rows = [("ours", *map(str, ours))]
    if thesis is not None:
        theirs = (thesis.clips, thesis.frames, thesis.commands, thesis.words, thesis.objects)
        rows.append((f"thesis: {thesis.collection}", *map(str, theirs)))
    out.table(
        "Collection (table 6.1)",
        ("collection", "clips", "frames", "commands", "unique words", "objects (mean)"),
        rows,
    )


def _tell_memory(out: Output, report: "ConceptsReport") -> None:
    """Sizes after a quarter, a half and all of the demos."""
    points = report.memory
    if not points:
        return
    picked = [points[min(len(points) - 1, round(share * (len(points) - 1)))] for share in (0.1, 0.25, 0.5, 0.75, 1.0)]
    rows = [(name, *(f"{point.parts.get(name, 0) / 1000:.1f}" for point in picked)) for name in (*points[-1].parts,)]
    rows.append(("all", *(f"{point.total / 1000:.1f}" for point in picked)))
    out.table(
        "Size of the knowledge in kB (figure 6.24)", ("part", *(f"{point.demos} demos" for point in picked)), rows
    )
    out.say(
        f"time a demo, perception apart: {report.first_ms:.1f} ms from the 10th on, {report.last_ms:.1f} ms at the end"
    )


def _ours(row: "ConceptRow") -> str:
    found = f"{row.concepts} of {row.known}" if row.concepts != row.known else str(row.known)
    return f"{row.ours.v_measure:.3f}: {found} ({row.classes})"


def _figure(value: float | None) -> str:
    return "-" if value is None else f"{value:.3f}"


def _pure(scores: "ClusterScores | None", known: int | None) -> str:
    return "-" if scores is None else f"{scores.v_measure:.3f}: {known}"


def _theirs(row: "ConceptRow", thesis: "ThesisTable | None") -> str:
    theirs = thesis.rows.get(row.name) if thesis else None
    if theirs is None:
        return "-"
    return f"{theirs.v_measure:.2f}: {theirs.concepts} ({theirs.classes}), SVM {theirs.svm:.2f}"


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(concepts)
