"""`showtell demos`: list, check, trim, repair, describe and label recorded demos."""

from collections import Counter
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from executor.commands.output import FAILED, Json, Output, Seed

if TYPE_CHECKING:
    from collections.abc import Iterator

    from teleop import Demo


class Label(StrEnum):
    """How a demo ended."""

    SUCCESS = "success"
    FAILURE = "failure"
    UNKNOWN = "unknown"


def demos(
    directory: Annotated[Path, typer.Argument(help="Folder of demos, or one demo.")],
    check: Annotated[bool, typer.Option("--check", help="Simulate each demo's inputs afresh and compare.")] = False,
    repair: Annotated[
        bool, typer.Option("--repair", help="Rewrite demos that end early; the damaged files are kept beside them.")
    ] = False,
    trim: Annotated[str | None, typer.Option(help="Copy a piece of this demo of the folder; needs --output.")] = None,
    start: Annotated[float, typer.Option("--from", min=0.0, help="Where the piece starts [s].")] = 0.0,
    end: Annotated[float | None, typer.Option("--to", help="Where it ends [s]; the demo's end without it.")] = None,
    output: Annotated[Path | None, typer.Option("--output", "-o", help="The trimmed demo, a new file.")] = None,
    summary: Annotated[
        bool, typer.Option("--summary", help="Only count clips, frames, sentences, words and objects (table 6.1).")
    ] = False,
    language: Annotated[str | None, typer.Option(help="With --summary: sentences of this language only.")] = None,
    say: Annotated[list[str] | None, typer.Option(help="Add a sentence to the one demo; may be given again.")] = None,
    label: Annotated[Label | None, typer.Option(help="Say how the one demo ended.")] = None,
    note: Annotated[str, typer.Option(help="Why it ended so; with --label.")] = "",
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """List recorded demos: what was said, how they ended, what happened, which are broken.

    Example: showtell demos demos/ --check

    Example: showtell demos leeds/ --summary --language en

    Example: showtell demos demos/ --trim board_1_0000.mcap --from 1.2 --to 5 -o demos/piece.mcap
    """
    from executor.demo_files import demo_paths

    del seed  # a demo's own seed is in its file
    out = Output(as_json)
    if trim is not None or output is not None:
        _trim(out, directory, trim, start, end, output)
        return
    paths = demo_paths(directory)
    if summary:
        _summarise(out, paths, language)
        return
    if say or label is not None:
        _add(directory, say or [], label, note)
    repaired = _repair(out, paths) if repair else []
    rows: list[dict[str, Any]] = []
    with out.progress("checking" if check else "reading", len(paths)) as advance:
        for path in paths:
            rows.append(_row(path, check))
            advance()
    broken = [row for row in rows if row["problem"]]
    out.table(
        f"{len(rows)} demos",
        ("demo", "robot", "length [s]", "what was said", "outcome", "safety events", "state"),
        [_cells(row) for row in rows],
    )
    for row in rows:
        for warning in row.get("warnings", []):
            out.say(f"{row['demo']}: {warning}")
    if broken:
        out.say(f"{len(broken)} of {len(rows)} are broken; --repair makes those whole that end early")
    out.result({"demos": rows, "broken": len(broken), "repaired": repaired})
    if broken:
        raise typer.Exit(FAILED)


def _summarise(out: Output, paths: list[Path], language: str | None) -> None:
    """Count what the demos hold."""
    from dataclasses import asdict

    from executor.demo_files import read_demo
    from executor.demo_summary import summarise

    with out.progress("reading", len(paths)) as advance:

        def demos() -> "Iterator[Demo]":
            for path in paths:
                yield read_demo(path)
                advance()

        found = summarise(demos(), language)
    out.table(
        "What they amount to" + (f", in {language}" if language else ""),
        ("video clips", "frames at 10 Hz", "commands", "unique words", "objects (average)", "length [s]"),
        [
            (
                found.clips,
                found.frames,
                found.commands,
                found.words,
                f"{found.objects:.1f}",
                f"{found.seconds:.1f}",
            )
        ],
    )
    out.result({"summary": asdict(found), "language": language})


def _row(path: Path, check: bool) -> dict[str, Any]:
    """What is to be said of one demo."""
    from executor.demo_files import read_demo
    from robots import ShowtellError
    from teleop import check_replay

    row: dict[str, Any] = {"demo": path.name, "problem": None, "complete": None, "replayable": None}
    try:
        demo = read_demo(path)
        row |= _facts(demo)
        if not demo.complete:
            row["problem"] = "ends early"
        if check:
            report = check_replay(demo)
            row |= {"replayable": report.success, "max_error": report.max_error, "warnings": list(report.warnings)}
            if not report.success:
                row["problem"] = f"{report.worst} is off by {report.max_error:.2g} at {report.worst_time:.2f} s"
    except ShowtellError as error:
        row["problem"] = str(error)
    return row


def _facts(demo: "Demo") -> dict[str, Any]:
    kinds = Counter(event.kind for event in demo.events)
    return {
        "complete": demo.complete,
        "robot": demo.scene.robot,
        "seconds": demo.duration,
        "utterances": list(demo.utterances),
        "outcome": None if demo.outcome is None else demo.outcome.outcome,
        "note": "" if demo.outcome is None else demo.outcome.note,
        "events": dict(kinds),
        "safety_events": kinds["safety"] + kinds["stop"] + kinds["device"],
        "trimmed_from": None if demo.trim is None else demo.trim.origin,
        "repaired": demo.repaired,
    }


def _cells(row: dict[str, Any]) -> tuple[str, ...]:
    state = row["problem"] or ("good" if row["replayable"] is None else "good, replays")
    if row.get("trimmed_from"):
        state += f"; cut from {row['trimmed_from']}"
    if row.get("repaired"):
        state += "; repaired"
    outcome = row.get("outcome") or "-"
    return (
        row["demo"],
        row.get("robot", "-"),
        f"{row['seconds']:.1f}" if "seconds" in row else "-",
        "\n".join(row.get("utterances", [])) or "-",
        f"{outcome}: {row['note']}" if row.get("note") else outcome,
        str(row.get("safety_events", "-")),
        state,
    )


def _trim(out: Output, folder: Path, name: str | None, start: float, end: float | None, output: Path | None) -> None:
    """Copy a piece of a demo."""
    from executor.demo_files import read_demo
    from executor.errors import InputError
    from executor.files import check_place, existing
    from teleop.trim import trim_demo

    if output is None:
        raise InputError("--trim makes a copy: name the new demo with --output")
    if name is None and folder.is_dir():
        raise InputError(f"--output is for a trimmed demo: say which of {folder} with --trim")
    source = folder if name is None else folder / name if folder.is_dir() else Path(name)
    last = read_demo(existing(source, "demo")).times[-1]
    check_place(output)
    piece = trim_demo(source, start, float(last) if end is None else end, output)
    out.say(f"{output}: {piece.duration:.2f} s of {source.name}, which stays as it is")
    out.result({"demo": output, "origin": source, "seconds": piece.duration, **_facts(piece)})


def _add(demo: Path, texts: list[str], label: Label | None, note: str) -> None:
    """Add sentences and an outcome to a finished demo."""
    from executor.errors import InputError
    from teleop.repair import add_utterances, label_demo

    if demo.is_dir():
        raise InputError(f"--say and --label are for one demo, {demo} is a folder: name a demo in it")
    if texts:
        add_utterances(demo, texts)
    if label is not None:
        label_demo(demo, label.value, note)


def _repair(out: Output, paths: list[Path]) -> list[str]:
    """Make demos whole that end early; returns their names."""
    from robots import ShowtellError
    from teleop.repair import repair_demo

    done = []
    for path in paths:
        try:
            repair = repair_demo(path)
        except ShowtellError as error:
            out.say(f"{path.name} cannot be repaired: {error}")
            continue
        if repair.kept is not None:
            out.say(f"{path.name} is whole up to {repair.seconds:.1f} s; as it was: {repair.kept.name}")
            done.append(path.name)
    return done


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(demos)
