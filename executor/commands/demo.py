"""`showtell demo`: the whole loop in about a minute."""

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from executor.showcase import Lessons
    from executor.trial import Verdict

DEMOS = 200
COMMANDS = 12
VARIETY = 0.25
ENOUGH = 0.9
"""Share of commands that must go right for exit code 0."""
VIEW_SIZE = (560, 420)
"""Width and height of a view [pixels]."""
FILM_SPEED = 2.0
"""How many times faster than it happened the film plays."""


def demo(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for what is made.")] = Path("demo-out"),
    demos: Annotated[int, typer.Option(min=1, help="How many demos to record.")] = DEMOS,
    commands: Annotated[int, typer.Option(min=1, help="How many new commands to try.")] = COMMANDS,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the board arm.")] = None,
    variety: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="How often the operator uses another word for the same thing.")
    ] = VARIETY,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Show, tell, do: a scripted operator records demos, they are learned from, and new commands are carried out.

    Example: showtell demo --seed 0
    """
    from executor.collection import BoardCollection
    from executor.commands.inspect import tell_words
    from executor.files import new_folder
    from executor.showcase import show_and_learn, try_commands
    from robots import load_robot

    out = Output(as_json)
    if robot is not None:
        load_robot(robot)  # complains before long work
    folder = new_folder(output)
    begun = perf_counter()
    with out.progress("showing, telling and learning", demos) as advance:
        collection = BoardCollection(folder / "demos", seed, robot, variety)
        lessons = show_and_learn(collection, demos, jobs, advance)
    knowledge = folder / "knowledge.json"
    lessons.knowledge.save(knowledge)
    _tell_lessons(out, lessons)
    tell_words(out, lessons.knowledge)
    trying = perf_counter()
    with out.progress("doing new commands", commands) as advance:
        verdicts = try_commands(knowledge, commands, seed, robot, variety, jobs, VIEW_SIZE, advance)
    tried = perf_counter() - trying
    right = sum(verdict.right for verdict in verdicts)
    _tell_verdicts(out, verdicts)
    picture, film = _pictures(folder, verdicts)
    out.say(f"{right} of {len(verdicts)} new commands were carried out rightly")
    out.say(f"shown, told and learned in {lessons.seconds:.0f} s, done in {tried:.0f} s")
    out.say(f"knowledge: {knowledge}; demos: {folder / 'demos'}")
    out.say(f"picture: {picture}" + (f"; film: {film}" if film else ""))
    out.result(
        {
            "demos": len(lessons.recorded),
            "sentences": lessons.sentences,
            "validated": lessons.validated,
            "commands": len(verdicts),
            "right": right,
            "verdicts": [
                {"right": each.right, "fault": each.fault, "kind": each.kind, **each.report.to_dict()}
                for each in verdicts
            ],
            "knowledge": knowledge,
            "picture": picture,
            "film": film,
            "seconds": perf_counter() - begun,
            "seed": seed,
        }
    )
    if right < ENOUGH * len(verdicts):
        raise typer.Exit(FAILED)


def _tell_lessons(out: Output, lessons: "Lessons") -> None:
    """Print what was shown."""
    simulated = sum(each.simulated for each in lessons.recorded)
    single = sum(each.wall for each in lessons.recorded)
    out.say(
        f"{len(lessons.recorded)} demos, {simulated:.0f} s of teleoperation; one demo is recorded at "
        f"{simulated / single:.1f} x real time"
    )
    out.say(
        f"{lessons.validated} of {lessons.sentences} sentences were read, when heard, in a way that does what was shown"
    )


def _tell_verdicts(out: Output, verdicts: "list[Verdict]") -> None:
    """Print how each command went."""
    rows = [
        (
            number,
            each.sentence,
            "right" if each.right else "wrong",
            "; ".join(part for part in (each.fault, each.report.explanation) if part),
        )
        for number, each in enumerate(verdicts, 1)
    ]
    out.table("New commands in new scenes", ("", "command", "went", "what happened"), rows)


def _pictures(folder: Path, verdicts: "list[Verdict]") -> tuple[Path, Path | None]:
    """Write a strip of a command before and after, and a film of the one that was filmed."""
    from executor.picture import save_film, save_strip
    from executor.trial import FRAME

    best = max(verdicts, key=lambda each: (each.right, len(each.views)))
    picture = folder / "command.png"
    caption = f"“{best.sentence}”: {'done' if best.right else best.fault}"
    save_strip(picture, (best.views[0], best.views[-1]), ("before", "after"), caption)
    if len(best.views) <= 2:
        return picture, None
    film = folder / "command.gif"
    save_film(film, best.views, f"“{best.sentence}”", FRAME / FILM_SPEED)
    return picture, film


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(demo)
