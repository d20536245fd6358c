"""`showtell do`: execute commands on the twin."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed
from executor.execution.answer import OnAmbiguous

if TYPE_CHECKING:
    from executor.executor import Executor
    from executor.picture import Picture
    from executor.report import ExecutionReport

PICTURE_SIZE = (480, 360)
"""Width and height of a view [pixels]."""


def do(
    knowledge: Annotated[Path, typer.Argument(help="Knowledge file that `showtell learn` wrote.")],
    command: Annotated[
        str | None, typer.Argument(help="What to do, in the words of the demos; without it, a dialogue.")
    ] = None,
    then: Annotated[list[str] | None, typer.Option(help="What to do next; `undo` undoes. May be given again.")] = None,
    scene: Annotated[
        str | None,
        typer.Option(
            help="`board`, `board-all`, `tabletop`, `ordering` or a scene's TOML file; what the knowledge was learned "
            "on if left out."
        ),
    ] = None,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    plan_only: Annotated[bool, typer.Option("--plan-only", help="Stop after the plan; nothing moves.")] = False,
    on_ambiguous: Annotated[
        OnAmbiguous, typer.Option(help="Where several things fit: ask which, or take the best.")
    ] = OnAmbiguous.ASK,
    clear: Annotated[bool, typer.Option("--clear", help="Put aside what is in the way.")] = False,
    picture: Annotated[Path | None, typer.Option(help="Write a picture of before and after.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Execute a command on the twin, or several in a row; without a command, hold a dialogue about one scene.

    In a dialogue, every line is a command; `undo` puts the world back to before the last one, `wrong` marks it as not
    what was said, a number answers a question.

    Example: showtell do knowledge.json "put the red cube on the blue cube" --seed 7 --picture done.png

    Example: showtell do knowledge.json --seed 7
    """
    import numpy as np

    from executor.errors import InputError
    from executor.execution.readiness import get_ready
    from executor.executor import Executor
    from executor.files import check_place, existing
    from executor.knowledge_fit import check_fit, usual_scene
    from executor.picture import check_suffix, save_strip
    from learning import Knowledge
    from twin import World

    out = Output(as_json)
    if command is not None and not command.split():
        raise InputError('the command is empty; say what to do, for example "put the red cube on the blue cube"')
    if command is None and then:
        raise InputError("--then says what to do after a command; give the command first")
    learned = Knowledge.load(existing(knowledge, "knowledge file"))
    if picture is not None:
        check_place(check_suffix(picture))
    scene = scene or usual_scene(learned)
    with World.from_scene(scene, robot=robot, seed=seed) as world:
        check_fit(learned, world.spec.kind, knowledge)
        views: list[Picture] = [world.render(*PICTURE_SIZE)] if picture else []
        executor = Executor(world, learned, np.random.default_rng(seed), on_ambiguous=on_ambiguous.value, clear=clear)
        get_ready(executor)
        if command is None:
            reports = _dialogue(out, executor, knowledge)
        else:
            reports = _in_a_row(out, executor, [command, *(then or [])], plan_only)
        if picture is not None:
            views.append(world.render(*PICTURE_SIZE))
            said = "; ".join(f"{each.sentence}: {each.explanation}" for each in reports)
            save_strip(picture, views, ("before", "after"), said)
            out.say(f"picture: {picture}")
    rows = [report.to_dict() for report in reports]
    shown = rows[0] if len(rows) == 1 else {"success": all(each.success for each in reports), "reports": rows}
    out.result({**shown, "seed": seed, "scene": scene, "picture": picture})
    if command is not None and not all(each.success for each in reports):
        raise typer.Exit(FAILED)


def _in_a_row(out: Output, executor: "Executor", commands: list[str], plan_only: bool) -> "list[ExecutionReport]":
    """Execute commands, until one cannot be done."""
    from executor.execution.session import UNDO

    reports: list[ExecutionReport] = []
    for command in commands:
        if command.strip().lower() == UNDO:
            undone = executor.undo()
            out.say("there is nothing to undo" if undone is None else f"undone: {undone}")
            continue
        report = executor.execute(command, plan_only=plan_only)
        reports.append(report)
        out.say(report.text())
        times = ", ".join(f"{part} {1000 * seconds:.0f} ms" for part, seconds in report.durations.items())
        out.say(f"({times})")
        if not report.success:
            break
    return reports


def _dialogue(out: Output, executor: "Executor", knowledge: Path) -> "list[ExecutionReport]":
    """Answer the lines of standard input until it ends."""
    from executor.execution.session import HELP_TEXT, Session

    reports: list[ExecutionReport] = []
    session = Session(executor, knowledge, reports.append)
    talking = sys.stdin.isatty()
    if talking:
        out.note(HELP_TEXT)
    while True:
        if talking:
            sys.stderr.write("> ")
            sys.stderr.flush()
        line = sys.stdin.readline()
        if not line:
            break
        answer = session.answer(line)
        if answer is None:
            break
        if answer:
            out.say(answer)
    return reports


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(do)
