"""`showtell import`: turn a public data set into demos driven on the twin."""

from pathlib import Path
from typing import Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed, ShowtellGroup

ENOUGH = 0.97
"""Share of scenes that must end in their after-layout for exit code 0."""
LISTED = 50
"""Most failures shown as a table; JSON has all."""

app = typer.Typer(cls=ShowtellGroup, no_args_is_help=True, help="Turn a public data set into demos.")


@app.callback()
def _sources() -> None:
    """Turn a public data set into demos."""


@app.command("train-robots")
def train_robots(
    directory: Annotated[Path, typer.Argument(help="Directory with commands.txt and configuration.txt.")],
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the demos.")],
    only: Annotated[list[int] | None, typer.Option(help="A scene to drive (repeat for more); all by default.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    compare: Annotated[
        int, typer.Option(min=0, help="How many demos to hold against the key frames of their layouts afterwards.")
    ] = 50,
    extend: Annotated[
        bool, typer.Option("--extended", help="Drive the extended release: spheres, cylinders and black too.")
    ] = False,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Drive each scene of a Train-Robots release in which one block moves; an interrupted import goes on later.

    Example: showtell import train-robots train-robots/ -o demos/ --only 1 --only 2
    """
    import numpy as np

    from executor.compare_graphlets import compare_graphlets
    from executor.import_release import import_release, load_release
    from robots.workers import worker_count

    out = Output(as_json)
    report = import_release(
        directory,
        output,
        jobs=worker_count(jobs),
        only=only or None,
        seed=seed,
        progress=True,
        extend=extend,
    )
    total = len(report.outcomes)
    failures = [(each.scene, each.reason) for each in report.failures]
    if failures:
        title = f"Scenes that did not end in the after-layout (first {min(LISTED, len(failures))} of {len(failures)})"
        out.table(title, ("scene", "reason"), failures[:LISTED])
    out.say(f"{report.right} of {total} scenes ended in the given after-layout; demos are in {output}")
    kept = f", {report.kept} kept from an earlier run" if report.kept else ""
    speed = f"; one demo runs at {report.real_time_factor:.1f} x real time" if report.kept < total else ""
    out.say(f"{report.wall:.0f} s with {report.jobs} processes{kept}{speed}")
    pairs = []
    if compare:
        release = load_release(directory, extend, seed)
        pairs = compare_graphlets(release, output, compare, np.random.default_rng(seed))
    same = sum(pair.same for pair in pairs)
    if pairs:
        out.say(f"{same} of {len(pairs)} demos show the same action graphlet as the key frames of their layouts")
    for pair in pairs:
        if not pair.same:
            out.say(f"scene {pair.scene}: driven {pair.driven}, implied {pair.implied}")
    out.result(
        {
            "scenes": total,
            "graphlets_compared": len(pairs),
            "graphlets_same": same,
            "right": report.right,
            "kept": report.kept,
            "failures": [{"scene": scene, "reason": reason} for scene, reason in failures],
            "wall_seconds": report.wall,
            "real_time_factor": report.real_time_factor,
            "jobs": report.jobs,
            "demos": output,
            "extended": extend,
            "seed": seed,
        }
    )
    if total and report.right < ENOUGH * total:
        raise typer.Exit(FAILED)
