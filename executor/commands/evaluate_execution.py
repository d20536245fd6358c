"""`showtell evaluate execution`: are commands carried out, and can the answer be trusted?"""

from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.evaluate_tables import TableExam
from executor.commands.output import FAILED, Json, Output, Seed
from executor.execution.answer import OnAmbiguous

if TYPE_CHECKING:
    from collections.abc import Callable

    from executor.execution.evaluation.endurance import Endurance
    from executor.execution.evaluation.learned import Learned
    from executor.execution.evaluation.verdict import Verdict


ROBOTS = ("three_dof", "baxter", "mico_segway")


class SuiteName(StrEnum):
    """Commands that should be answered without a motion."""

    AMBIGUOUS = "ambiguous"
    IMPOSSIBLE = "impossible"
    UNKNOWN_WORD = "unknown-word"


def execution(
    robot: Annotated[
        str, typer.Option(help="Robot: three_dof on the board, baxter or mico_segway at a table.")
    ] = "three_dof",
    commands: Annotated[int | None, typer.Option(min=1, help="How many: 100, or 50 of a suite.")] = None,
    knowledge: Annotated[
        Path | None, typer.Option(help="Use this knowledge; without it, learn from the scripted collection first.")
    ] = None,
    sentences: Annotated[
        Path | None,
        typer.Option(help="Lines of seed, sentence, and what should come of it, with tabs between (see --help)."),
    ] = None,
    train_robots: Annotated[
        Path | None, typer.Option(help="Real commands of this release, of groups not learned from.")
    ] = None,
    suite: Annotated[SuiteName | None, typer.Option(help="Commands that should be answered without a motion.")] = None,
    minutes: Annotated[
        float | None, typer.Option(min=0.1, help="Commands without a pause for so many simulated minutes.")
    ] = None,
    on_ambiguous: Annotated[
        OnAmbiguous, typer.Option(help="Ask, or take the best, where several fit.")
    ] = OnAmbiguous.ASK,
    clear: Annotated[bool, typer.Option("--clear", help="Put aside what is in the way.")] = False,
    variety: Annotated[float, typer.Option(min=0.0, max=1.0, help="How often a synonym is said.")] = 0.25,
    demos: Annotated[
        int | None,
        typer.Option(min=1, help="Demos to learn from: 200 (board), 102 (Baxter) or 224 (Mico)."),
    ] = None,
    language: Annotated[str, typer.Option(help="Language of the sentences at a table: en or ar.")] = "en",
    cache: Annotated[Path | None, typer.Option(help="Folder for what is learned; else the user's cache.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    failures: Annotated[int, typer.Option(min=0, help="How many failures to list.")] = 10,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Carry out new commands in new scenes, and judge by the truth what came of them.

    Scenes and sentences are made from the seed, and none was in the demos. `false_success` counts commands that were
    reported done and were not. A line of `--sentences` is the seed of a board scene, a tab, the sentence, and, if it is
    to be scored, a tab and the right answer (`ambiguous`, `impossible`, `unknown-word`), or a tab, the object's id, a
    tab and `held` or the cell `x,y,z`. At a table the seed is that of a tabletop or ordering scene, and a thing ends
    `held`, in a part of the table (`top left`), in a relation to another (`in 2`, `left 3`), or as an action leaves it
    (`press`).

    Example: showtell evaluate execution --robot three_dof --commands 100 --seed 1

    Example: showtell evaluate execution --train-robots train-robots/ --commands 200

    Example: showtell evaluate execution --robot baxter --commands 100

    Example: showtell evaluate execution --robot mico_segway --suite unknown-word
    """
    from executor.collection import in_processes
    from executor.errors import InputError
    from executor.execution.evaluation.board_cases import board_cases, written_cases
    from executor.execution.evaluation.endurance import endure
    from executor.execution.evaluation.learned import DEMOS, from_collection, from_release, given
    from executor.execution.evaluation.release_cases import SplitRelease, release_cases
    from executor.execution.evaluation.suite_cases import SUITES, suite_cases
    from executor.execution.evaluation.verdict import Job, run_case
    from executor.files import existing

    out = Output(as_json)
    if robot not in ROBOTS:
        raise InputError(f"commands are evaluated with {', '.join(ROBOTS)}, not with {robot!r}")
    if robot != "three_dof" and train_robots is not None:
        raise InputError("--train-robots are commands for the board: use them with --robot three_dof")
    if sum(each is not None for each in (sentences, train_robots, suite, minutes)) > 1:
        raise InputError("give one of --sentences, --train-robots, --suite and --minutes")
    if robot != "three_dof":
        exam = TableExam(robot, language, seed)
        learned = exam.learned(out, knowledge, cache, demos, jobs)
        if minutes is not None:
            length = minutes
            _endure(out, minutes, seed, lambda advance: exam.endured(learned, length, advance))
            return
        named = next((each for each in SUITES if suite is not None and each == suite.value), None)
        told = exam.verdicts(out, learned, commands, sentences, named, on_ambiguous, clear, jobs)
        _tell(out, told, failures, seed, learned)
        return
    split = None if train_robots is None else SplitRelease.load(train_robots)
    if knowledge is not None:
        learned = given(existing(knowledge, "knowledge file"), "board")
    elif split is not None:
        out.note(f"learning from {len(split.learned)} scenes of the groups that are not asked (kept for the next time)")
        learned = from_release(split, cache, seed=0)
    else:
        with out.progress("showing and learning, once", demos or DEMOS) as advance:
            learned = from_collection(cache, demos or DEMOS, 0, jobs, advance)
    if minutes is not None:
        _endure(out, minutes, seed, lambda advance: endure(learned.path, minutes, seed, variety, advance))
        return
    if split is not None:
        cases = release_cases(split, commands or 200, seed)
    elif sentences is not None:
        cases = written_cases(existing(sentences, "file of sentences"))[:commands]
    elif suite is not None:
        cases = suite_cases(suite.value, commands or 50, seed, learned.heard)
    else:
        cases = board_cases(commands or 100, seed, variety, learned.heard)
    work = [Job(case, learned.path, seed, on_ambiguous.value, clear) for case in cases]
    with out.progress("commands", len(work)) as advance:
        done = sorted(in_processes(run_case, work, jobs, advance), key=lambda pair: pair[0])
    _tell(out, [verdict for _, verdict in done], failures, seed, learned)


def _endure(out: Output, minutes: float, seed: int, endured: "Callable[[Callable[[], None]], Endurance]") -> None:
    """Give commands without a pause, and tell how it went."""
    from learning.evaluation.machine import machine

    with out.progress("simulated minutes", round(minutes)) as advance:
        report = endured(advance)
    figures = report.figures()
    out.table("Commands without a pause", ("figure", "value"), [(name, _figure(v)) for name, v in figures.items()])
    for error in report.errors:
        out.say(f"error: {error}")
    for fault in report.faults:
        out.say(f"not right: {fault}")
    out.result(
        {
            "figures": figures,
            "baselines": {},
            "errors": report.errors,
            "faults": report.faults,
            "machine": machine(),
            "seed": seed,
        }
    )
    if report.errors:
        raise typer.Exit(FAILED)


def _tell(out: Output, verdicts: "list[Verdict]", failures: int, seed: int, learned: "Learned") -> None:
    """Print figures, causes of failures, and some of them."""
    from executor.execution.evaluation.figures import causes_of, figures_of, kinds_of
    from learning.evaluation.machine import machine

    figures = figures_of(verdicts)
    causes = causes_of(verdicts)
    wrong = [each for each in verdicts if each.right is False]
    unscored = [each for each in verdicts if each.right is None]
    out.table("Commands carried out", ("figure", "value"), [(name, _figure(v)) for name, v in figures.items()])
    out.table("By kind", ("kind", "commands", "right"), kinds_of(verdicts))
    if causes:
        out.table("Failures by cause", ("cause", "commands"), causes)
    if wrong[:failures]:
        rows = [(each.number, each.sentence, each.cause, each.fault, each.explanation) for each in wrong[:failures]]
        out.table(f"First {len(rows)} of {len(wrong)} failures", ("number", "sentence", "cause", "fault", "told"), rows)
    if unscored:
        out.table("Answers", ("sentence", "answer"), [(each.sentence, each.answer) for each in unscored])
    out.say(f"knowledge: {learned.path}; seed {seed}; machine: {machine()}")
    out.result(
        {
            "figures": figures,
            "baselines": {},
            "causes": dict(causes),
            "kinds": {kind: [right, total] for kind, total, right in kinds_of(verdicts)},
            "failures": [each.to_dict() for each in wrong],
            "answers": [each.to_dict() for each in unscored],
            "machine": machine(),
            "seed": seed,
        }
    )


def _figure(value: float | int | None) -> str:
    if value is None:
        return "-"
    return f"{value:.3f}" if isinstance(value, float) else str(value)


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(execution)
