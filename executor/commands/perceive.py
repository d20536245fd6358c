"""`showtell perceive`: look at demos once, and keep what was seen."""

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from learning.perception.stage import PerceivedDemo

CACHE = "observations"
"""Folder beside the demos that keeps observations where no other is named."""


def perceive(
    demos: Annotated[Path, typer.Argument(help="Folder of demos, or one demo.")],
    cache: Annotated[
        Path | None, typer.Option(help=f"Folder that keeps the observations; `{CACHE}` beside the demos by default.")
    ] = None,
    camera: Annotated[str | None, typer.Option(help="Camera of the robot; its first by default.")] = None,
    width: Annotated[int, typer.Option(min=32, help="Columns of a picture.")] = 320,
    height: Annotated[int, typer.Option(min=24, help="Rows of a picture.")] = 240,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    cluster: Annotated[
        str | None, typer.Option(help="Address of a Dask scheduler that does the work, such as tcp://host:8786.")
    ] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Perceive demos through the robot's camera; an interrupted pass goes on later.

    Example: showtell perceive demos/leeds
    """
    from executor.demo_files import demo_paths
    from learning.perception.observe_camera import Eyesight
    from learning.perception.stage import perceive_demos

    out = Output(as_json)
    paths = demo_paths(demos)
    where = cache or (demos if demos.is_dir() else demos.parent) / CACHE
    begun = perf_counter()
    with out.progress("perceiving", len(paths)) as advance:
        done = perceive_demos(
            paths,
            where,
            seed=seed,
            eyesight=Eyesight(camera, width, height),
            jobs=jobs,
            cluster=cluster,
            on_done=lambda outcome: advance(),
        )
    _tell(out, done, where, perf_counter() - begun, seed)


def _tell(out: Output, done: "list[PerceivedDemo]", where: Path, wall: float, seed: int) -> None:
    """Print what came of it."""
    failed = [each for each in done if each.error]
    fresh = [each for each in done if each.frames]
    frames = sum(each.frames for each in fresh)
    seconds = sum(each.seconds for each in fresh)
    speed = frames / seconds if seconds else None
    for each in done:
        for note in each.notes:
            out.note(f"{each.demo.name}: {note}")
    for each in failed:
        out.note(f"passed over: {each.demo.name}: {each.error}")
    out.say(f"{len(done) - len(failed)} of {len(done)} demos perceived, {len(done) - len(failed) - len(fresh)} before")
    if speed is not None:
        out.say(f"{speed:.1f} frames a second per core, rendering included: {frames} frames in {wall:.1f} s")
    out.say(f"observations: {where}")
    out.result(
        {
            "demos": len(done),
            "perceived": len(fresh),
            "cached": len(done) - len(failed) - len(fresh),
            "failed": [{"demo": each.demo, "error": each.error} for each in failed],
            "frames": frames,
            "frames_per_second_per_core": speed,
            "wall_seconds": wall,
            "cache": where,
            "seed": seed,
        }
    )
    if len(failed) == len(done):
        raise typer.Exit(FAILED)


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(perceive)
