"""`showtell do`: execute a command on the twin."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from executor.picture import Picture

PICTURE_SIZE = (480, 360)
"""Width and height of a view [pixels]."""


def do(
    knowledge: Annotated[Path, typer.Argument(help="Knowledge file that `showtell learn` wrote.")],
    command: Annotated[str, typer.Argument(help="What to do, in the words of the demos.")],
    scene: Annotated[
        str, typer.Option(help="`board` for a random board from the seed, or a scene's TOML file.")
    ] = "board",
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    plan_only: Annotated[bool, typer.Option("--plan-only", help="Stop after the plan; nothing moves.")] = False,
    picture: Annotated[Path | None, typer.Option(help="Write a picture of before and after.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Execute a command on the twin.

    Example: showtell do knowledge.json "put the red cube on the blue cube" --seed 7 --picture done.png
    """
    import numpy as np

    from executor.errors import InputError
    from executor.executor import Executor
    from executor.files import check_place, existing
    from executor.picture import check_suffix, save_strip
    from learning import Knowledge
    from twin import World

    out = Output(as_json)
    if not command.split():
        raise InputError('the command is empty; say what to do, for example "put the red cube on the blue cube"')
    learned = Knowledge.load(existing(knowledge, "knowledge file"))
    if picture is not None:
        check_place(check_suffix(picture))
    with World.from_scene(scene, robot=robot, seed=seed) as world:
        views: list[Picture] = [world.render(*PICTURE_SIZE)] if picture else []
        report = Executor(world, learned, np.random.default_rng(seed)).execute(command, plan_only=plan_only)
        if picture is not None:
            views.append(world.render(*PICTURE_SIZE))
            save_strip(picture, views, ("before", "after"), f"{command}: {report.explanation}")
    if plan_only and report.plan is not None:
        for number, line in enumerate(report.plan.lines(), 1):
            out.say(f"{number:3d}. {line}")
    out.say(report.explanation)
    verdict = "refused" if report.refused else "planned" if plan_only else "done" if report.success else "failed"
    times = ", ".join(f"{part} {1000 * seconds:.0f} ms" for part, seconds in report.durations.items())
    out.say(f"{verdict} ({times})" if times else verdict)
    if picture is not None:
        out.say(f"picture: {picture}")
    out.result({**report.to_dict(), "seed": seed, "scene": scene, "picture": picture})
    if not report.success:
        raise typer.Exit(FAILED)


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(do)
