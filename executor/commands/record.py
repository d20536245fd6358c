"""`showtell record`: teleoperate and record demos with what was said."""

from collections import Counter
from enum import StrEnum
from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from executor.commands.output import Json, Output, Seed


class Device(StrEnum):
    """What the operator holds."""

    SCRIPTED = "scripted"
    GAMEPAD = "gamepad"
    KEYBOARD = "keyboard"


class Collection(StrEnum):
    """Which scenes and tasks are recorded."""

    BOARD = "board"
    LEEDS = "leeds"
    ORDERING = "ordering"
    COUNTER = "counter"


def record(
    output: Annotated[Path, typer.Option("--output", "-o", help="Folder for the demos.")],
    device: Annotated[
        Device, typer.Option(help="Who drives: a scripted operator, or you with a gamepad or this terminal's keys.")
    ] = Device.SCRIPTED,
    count: Annotated[
        int | None, typer.Option("--count", "-n", min=1, help="How many demos: 1 of board, all of another collection.")
    ] = None,
    collection: Annotated[
        Collection,
        typer.Option(
            help="Which scenes and tasks: board; leeds (Baxter, 204 demos); ordering (Mico, 1,120 demos); counter (a "
            "Mico picks up, puts down and moves, 96 demos without sentences, for actions)."
        ),
    ] = Collection.BOARD,
    languages: Annotated[
        str, typer.Option(help="Languages of the sentences of leeds and ordering: en, ar, or en,ar.")
    ] = "en",
    sentences: Annotated[int, typer.Option(min=1, help="At most so many sentences with each demo.")] = 3,
    robot: Annotated[str | None, typer.Option(help="Robot to use instead of the scene's own.")] = None,
    scene: Annotated[
        str, typer.Option(help="Your scene: board, board-all, tabletop, ordering, or a TOML file.")
    ] = "board",
    say: Annotated[list[str] | None, typer.Option(help="Sentence for your next demo; may be given again.")] = None,
    pad: Annotated[str | None, typer.Option(help="Which gamepad: its number, or part of its name.")] = None,
    mapping: Annotated[Path | None, typer.Option(help="File of sticks, buttons and keys.")] = None,
    window: Annotated[bool, typer.Option("--window", help="Show your scene in a window, where there is a display.")] = (
        False
    ),
    seconds: Annotated[float | None, typer.Option(min=0.1, help="End your session after so long; else Ctrl-C.")] = None,
    jobs: Annotated[int, typer.Option(min=0, help="Processes; 0 takes one a core.")] = 0,
    seed: Seed = 0,
    as_json: Json = False,
) -> None:
    """Record demos: a scripted operator with a gamepad and a sentence for each, or you at your own pace.

    Example: showtell record --device scripted --count 20 --collection board -o demos/ --seed 1

    Example: showtell record --collection leeds --languages en,ar -o leeds/

    Example: showtell record --device keyboard --scene tabletop --say "move the apple" --window -o demos/
    """
    from executor.collection import BoardCollection, record_collection
    from executor.files import new_folder
    from robots import load_robot

    out = Output(as_json)
    if robot is not None:
        load_robot(robot)  # complains before long work
    folder = new_folder(output)
    if device is not Device.SCRIPTED:
        from executor.hand_recording import HandSettings, record_by_hand

        settings = HandSettings(
            device.value, scene, robot, seed, folder, tuple(say or ()), pad, mapping, window, seconds
        )
        demos = record_by_hand(settings, out)
        out.say(f"{len(demos)} demos in {folder}: {', '.join(path.name for path in demos) or 'none was kept'}")
        out.result({"device": device.value, "scene": scene, "demos": [str(path) for path in demos], "seed": seed})
        return
    if collection is not Collection.BOARD:
        from executor.commands.record_collection import record_whole

        record_whole(out, collection.value, folder, count, languages, robot, jobs, seed)
        return
    count = count or 1
    begun = perf_counter()
    with out.progress("recording", count) as advance:
        board = BoardCollection(folder, seed, robot, sentences=sentences)
        recorded = record_collection(board, count, jobs=jobs, on_demo=advance)
    wall = perf_counter() - begun
    simulated = sum(each.simulated for each in recorded)
    single = sum(each.wall for each in recorded)
    kinds = Counter(each.kind for each in recorded)
    out.say(f"{count} demos in {folder}: " + ", ".join(f"{number} {kind}" for kind, number in sorted(kinds.items())))
    out.say(
        f"{simulated:.0f} s of teleoperation recorded in {wall:.1f} s; one demo runs at "
        f"{simulated / single:.1f} x real time, all together at {simulated / wall:.1f} x"
    )
    out.result(
        {
            "device": device.value,
            "collection": collection.value,
            "demos": [str(each.path) for each in recorded],
            "sentences": [each.sentence for each in recorded],
            "simulated_seconds": simulated,
            "wall_seconds": wall,
            "real_time_factor": simulated / single,
            "real_time_factor_in_all": simulated / wall,
            "seed": seed,
        }
    )


def add_to(app: typer.Typer) -> None:
    """Add the command to an app."""
    app.command()(record)
