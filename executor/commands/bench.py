"""`showtell bench`: us beside what a user would pick instead, same work, same run."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from executor.commands.output import FAILED, Json, Output, Seed, ShowtellGroup

if TYPE_CHECKING:
    from executor.bench.report import BenchReport

app = typer.Typer(
    cls=ShowtellGroup,
    no_args_is_help=True,
    help="Measure a part beside the alternatives. Ratios are theirs over ours for a cost, so above 1 is ours better.",
)

ROBOTS = ("three_dof", "baxter", "mico_segway")


@app.callback()
def _parts() -> None:
    """Measure a part beside the alternatives."""


@app.command()
def kinematics(
    targets: Annotated[int, typer.Option(min=1, help="Random reachable targets an arm.")] = 2000,
    robot: Annotated[list[str] | None, typer.Option(help="Robot; may be given again. All without it.")] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Inverse kinematics: ours, PyBullet's and pink's on the same targets, with the same restarts.

    Example: showtell bench kinematics --targets 200 --robot baxter
    """
    from executor.bench import kinematics as part

    out = Output(as_json)
    robots = robot or list(ROBOTS)
    with out.progress("solving", len(robots) + robots.count("baxter")) as advance:
        report = part.run(seed, targets, robots, advance)
    _tell(out, "Inverse kinematics", report, seed)


@app.command()
def physics(
    seconds: Annotated[float, typer.Option(min=2.0, help="Simulated time a robot [s].")] = 20.0,
    robosuite: Annotated[
        bool, typer.Option(help="Install robosuite in an environment of its own and time it too.")
    ] = True,
    log: Annotated[Path, typer.Option(help="Where robosuite's output is kept.")] = Path("build/robosuite.log"),
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Steps a second and real-time factor of every robot, beside robosuite's Baxter.

    Example: showtell bench physics --no-robosuite
    """
    from executor.bench import physics as part

    out = Output(as_json)
    with out.progress("stepping", 5) as advance:
        report = part.run(seed, seconds, log if robosuite else None, advance)
    _tell(out, "Physics", report, seed)


@app.command()
def grasp(
    picks: Annotated[int, typer.Option(min=1, help="Random picks a robot.")] = 200,
    robot: Annotated[list[str] | None, typer.Option(help="Robot; may be given again. All without it.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Random picks, lifts, carries of 0.3 m and places by friction alone, over all objects of a robot.

    Example: showtell bench grasp --robot baxter --picks 20
    """
    from executor.bench import grasp as part

    out = Output(as_json)
    robots = robot or list(ROBOTS)
    with out.progress("picking", picks * len(robots)) as advance:
        report = part.run(seed, picks, robots, jobs, advance)
    _tell(out, "Grasping", report, seed)


@app.command()
def camera(
    frames: Annotated[int, typer.Option(min=3, help="Frames a renderer.")] = 40,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Milliseconds a frame of colour, depth and mask, for each renderer.

    Example: showtell bench camera --frames 10
    """
    from executor.bench import camera as part
    from executor.quiet import words_to_stderr

    out = Output(as_json)
    with words_to_stderr():  # PyBullet's plug-in prints what it finds
        report = part.run(seed, frames)
    _tell(out, "Camera", report, seed)


@app.command()
def moves(
    count: Annotated[int, typer.Option(min=1, help="Random moves a robot.")] = 1000,
    robot: Annotated[list[str] | None, typer.Option(help="Robot; may be given again. All without it.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Random moves in physics: does any leave a limit or touch anything? Exit code 1 if one does.

    Example: showtell bench moves --robot three_dof --count 50
    """
    from executor.bench import moves as part

    out = Output(as_json)
    robots = robot or list(ROBOTS)
    with out.progress("moving", count * len(robots)) as advance:
        report = part.run(seed, count, robots, jobs, advance)
    _tell(out, "Random moves", report, seed)
    if any(report.figures[f"{each}.violations"] or report.figures[f"{each}.touches"] for each in robots):
        raise typer.Exit(FAILED)


@app.command()
def servo(
    steps: Annotated[int, typer.Option(min=1, help="Control steps a robot.")] = 1_000_000,
    robot: Annotated[list[str] | None, typer.Option(help="Robot; may be given again. All without it.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Random, adversarial and human-like input: is any limit or distance broken, does the arm ever stick? 1 if so.

    Example: showtell bench servo --robot three_dof --steps 20000
    """
    from executor.bench import servo as part

    out = Output(as_json)
    robots = robot or list(ROBOTS)
    with out.progress("driving", part.chunks(steps) * len(robots)) as advance:
        report = part.run(seed, steps, robots, jobs, advance)
    _tell(out, "Servo", report, seed)
    if any(report.figures[f"{each}.violations"] or report.figures[f"{each}.stuck"] for each in robots):
        raise typer.Exit(FAILED)


@app.command()
def parse(
    count: Annotated[int, typer.Option("--sentences", min=1, help="Sentences to parse.")] = 100,
    knowledge: Annotated[
        Path | None, typer.Option(help="Knowledge whose grammar is used; learned here without it.")
    ] = None,
    train_robots: Annotated[
        Path | None, typer.Option(help="Release whose commands are parsed, and learned from without --knowledge.")
    ] = None,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Our Viterbi CKY and NLTK's, with the same learned grammar and sentences. Exit code 1 if a probability differs.

    Example: showtell bench parse --knowledge knowledge.json --train-robots train-robots/
    """
    from executor.bench import parse as part

    out = Output(as_json)
    with out.progress("parsing", count) as advance:
        report = part.run(seed, count, knowledge, train_robots, advance)
    _tell(out, "Parsing", report, seed)
    if report.figures["same_probability"] != 1.0:
        raise typer.Exit(FAILED)


@app.command()
def recorder(
    kills: Annotated[int, typer.Option(min=1, help="Recordings that are killed at random moments.")] = 50,
    demos: Annotated[int, typer.Option(min=1, help="Scripted demos that are replayed.")] = 100,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Kill recordings, fill the disk, replay demos, and measure what recording costs the control loop.

    Example: showtell bench recorder --kills 5 --demos 6
    """
    from executor.bench import recorder as part

    out = Output(as_json)
    with out.progress("recording", kills + demos) as advance:
        report = part.run(seed, kills, demos, jobs=jobs, on_done=advance)
    _tell(out, "Recorder", report, seed)


def _tell(out: Output, title: str, report: "BenchReport", seed: int) -> None:
    """Print figures beside baselines."""
    rows = [(name, _figure(value)) for name, value in report.figures.items()]
    rows += [(f"baseline {name}", _figure(value)) for name, value in report.baselines.items()]
    out.table(title, ("figure", "value"), rows)
    for name, text in report.settings.items():
        out.say(f"{name}: {text}")
    for note in report.notes:
        out.say(f"note: {note}")
    values = report.to_json(seed)
    out.say(f"seed {seed}; machine: {values['machine']}")
    out.result(values)


def _figure(value: float | None) -> str:
    if value is None:
        return "-"
    return f"{value:.0f}" if abs(value) >= 1000 or float(value).is_integer() else f"{value:.4g}"
