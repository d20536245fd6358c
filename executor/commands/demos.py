"""`showtell demos`: list and check recorded demos."""

from pathlib import Path
from typing import Annotated, Any

import typer

from executor.commands.output import FAILED, Json, Output, Seed


def demos(
    directory: Annotated[Path, typer.Argument(help="Folder of demos, or one demo.")],
    check: Annotated[bool, typer.Option("--check", help="Simulate each demo's inputs afresh and compare.")] = False,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """List recorded demos, what was said with them, and which are broken.

    Example: showtell demos demos/ --check
    """
    from executor.demo_files import demo_paths, read_demo
    from robots import ShowtellError
    from teleop import check_replay

    del seed  # a demo's own seed is in its file
    out = Output(as_json)
    rows: list[dict[str, Any]] = []
    paths = demo_paths(directory)
    with out.progress("checking" if check else "reading", len(paths)) as advance:
        for path in paths:
            row: dict[str, Any] = {"demo": path.name, "problem": None}
            try:
                demo = read_demo(path)
                row |= {"robot": demo.scene.robot, "seconds": demo.duration, "utterances": list(demo.utterances)}
                if not demo.complete:
                    row["problem"] = "ends early"
                elif check:
                    report = check_replay(demo)
                    if not report.success:
                        row["problem"] = f"{report.worst} is off by {report.max_error:.2g} at {report.worst_time:.2f} s"
            except ShowtellError as error:
                row["problem"] = str(error)
            rows.append(row)
            advance()
    broken = [row for row in rows if row["problem"]]
    cells = [
        (
            row["demo"],
            row.get("robot", "-"),
            f"{row['seconds']:.1f}" if "seconds" in row else "-",
            "\n".join(row.get("utterances", [])) or "-",
            row["problem"] or "good",
        )
        for row in rows
    ]
    out.table(f"{len(rows)} demos", ("demo", "robot", "length [s]", "what was said", "state"), cells)
    if broken:
        out.say(f"{len(broken)} of {len(rows)} are broken")
    out.result({"demos": rows, "broken": len(broken)})
    if broken:
        raise typer.Exit(FAILED)


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(demos)
