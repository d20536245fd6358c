"""`showtell evaluate tracking`: how well does the camera follow the objects of recorded demos?"""

from pathlib import Path
from typing import Annotated

import typer

from executor.commands.output import Json, Output, Seed


def tracking(
    demos: Annotated[Path, typer.Argument(help="Folder of demos at a table, or one demo.")],
    cache: Annotated[
        Path | None, typer.Option(help="Folder that keeps observations; `observations` beside the demos by default.")
    ] = None,
    count: Annotated[int | None, typer.Option(min=1, help="So many demos only, spread over the folder.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Perceive demos and compare the tracks with the recorded states: position error and identity switches.

    Example: showtell evaluate tracking demos/leeds --count 50
    """
    import numpy as np

    from executor.commands.perceive import CACHE
    from executor.demo_files import demo_paths, read_demo
    from learning.evaluation.tracking import TrackingReport, score_tracking
    from learning.perception.stage import perceive_demos

    out = Output(as_json)
    paths = demo_paths(demos)
    if count is not None and count < len(paths):
        paths = [paths[int(number)] for number in np.linspace(0, len(paths) - 1, count).round()]
    where = cache or (demos if demos.is_dir() else demos.parent) / CACHE
    with out.progress("perceiving", len(paths)) as advance:
        done = perceive_demos(paths, where, seed=seed, jobs=jobs, on_done=lambda outcome: advance())
    scores, rows, failures = [], [], []
    for each in done:
        if each.error:
            failures.append((each.demo.name, each.error))
            continue
        demo = read_demo(each.demo)
        score = score_tracking(each.observation().observation, demo.times, demo.states.object_positions)
        scores.append(score)
        if score.switches or score.extra or score.found < score.objects:
            rows.append((each.demo.name, score.switches, f"{score.found} of {score.objects}", score.extra))
    report = TrackingReport(scores, failures, seed)
    if rows:
        out.table("Demos with something amiss", ("demo", "switches", "objects found", "extra tracks"), rows)
    figures = report.figures()
    out.table("Tracking", ("figure", "value"), [(name, _figure(value)) for name, value in figures.items()])
    fresh = [each for each in done if each.frames]
    if fresh:
        frames, seconds = sum(each.frames for each in fresh), sum(each.seconds for each in fresh)
        out.say(f"{frames / seconds:.1f} frames a second per core, rendering included")
    for name, reason in failures:
        out.note(f"passed over: {name}: {reason}")
    out.result(report.to_json())


def _figure(value: float | None) -> str:
    if value is None:
        return "-"
    return str(int(value)) if float(value).is_integer() and value != 1.0 else f"{value:.3f}"


def add_to(app: typer.Typer) -> None:
    """Add the experiment to `showtell evaluate`."""
    app.command("tracking")(tracking)
