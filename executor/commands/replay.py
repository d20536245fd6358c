"""`showtell replay`: play a demo again."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from teleop import Demo


def replay(
    demo: Annotated[Path, typer.Argument(help="The demo (.mcap).")],
    check: Annotated[
        bool, typer.Option("--check", help="Fail unless the inputs, simulated afresh, lead to every recorded state.")
    ] = False,
    picture: Annotated[Path | None, typer.Option(help="Write a film (.gif) of the demo, or its last view.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Play a demo again: its recorded inputs are simulated afresh in a new world.

    Example: showtell replay demos/board_00000.mcap --check
    """
    from executor.demo_files import read_demo
    from executor.errors import InputError
    from executor.files import check_place, existing
    from executor.picture import check_suffix
    from teleop import check_replay

    del seed  # the demo's own seed is in its file
    out = Output(as_json)
    if picture is not None:
        check_place(check_suffix(picture))
    recorded = read_demo(existing(demo, "demo"))
    report = check_replay(recorded)
    if check and not report.complete:
        raise InputError(f"{demo}: the demo ends early; only the {report.states} states before that could be compared")
    factor = f"{report.simulated:.1f} s simulated in {report.wall:.1f} s, {report.real_time_factor:.1f} x real time"
    out.say(f"{demo.name}: " + " / ".join(recorded.utterances or ("nothing was said",)))
    out.say(f"{len(recorded.inputs)} inputs played; {factor}")
    if recorded.trim is not None:
        out.say(
            f"cut from {recorded.trim.origin}: it starts in the middle of a motion, so the {report.prelude:.2f} s "
            "before it were played first, from the scene's start"
        )
    worst = f"largest difference {report.max_error:.3g} ({report.worst} at {report.worst_time:.2f} s)"
    reached = (
        f"all {report.states} recorded states reached" if report.success else "the recorded states are not reached"
    )
    out.say(f"{reached}: {worst}")
    for warning in report.warnings:
        out.note(f"note: {warning}")
    if picture is not None:
        _film(picture, recorded)
        out.say(f"picture: {picture}")
    out.result(
        {
            "demo": demo,
            "success": report.success,
            "complete": report.complete,
            "states": report.states,
            "max_error": report.max_error,
            "worst": report.worst,
            "worst_time": report.worst_time,
            "prelude_seconds": report.prelude,
            "warnings": list(report.warnings),
            "simulated_seconds": report.simulated,
            "real_time_factor": report.real_time_factor,
            "picture": picture,
        }
    )
    if check and not report.success:
        raise typer.Exit(FAILED)


def _film(path: Path, demo: "Demo") -> None:
    """Write a film of a demo: its inputs played once more, a view every fifth of a second."""
    from executor.picture import save_film, save_strip
    from teleop.replay import DemoPlayer

    views = []
    every = max(1, demo.rate // 5)
    with DemoPlayer(demo) as player:
        for step in range(len(demo.inputs)):
            if step % every == 0 and path.suffix.lower() == ".gif":
                views.append(player.world.render(320, 240))
            player.step()
        views.append(player.world.render(320, 240))
    caption = " / ".join(demo.utterances)
    if path.suffix.lower() == ".gif":
        save_film(path, views, caption, 0.1)
    else:
        save_strip(path, views, ("at the end",), caption)


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(replay)
