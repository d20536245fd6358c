"""`showtell record --collection leeds / ordering / counter`: a whole collection, or as many of its demos as wanted."""

from collections import Counter
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

import typer

from executor.commands.output import FAILED, Output
from executor.errors import InputError

if TYPE_CHECKING:
    from executor.collections import Made, ScriptedCollection


def record_whole(
    out: Output,
    name: str,
    folder: Path,
    count: int | None,
    languages: str,
    robot: str | None,
    jobs: int,
    seed: int,
) -> None:
    """Record demos of a collection; good ones that are there are kept, so that it can be called again to go on.

    Raises:
        InputError: The collection has not so many demos, nobody speaks a language, or another robot is asked for.
        Exit: A demo could not be made.
    """
    from executor.collections import make_collection

    collection, whole = _collection(name, folder, languages, robot, seed)
    count = whole if count is None else count
    if count > whole:
        raise InputError(f"{name} has {whole} demos, got --count {count}")
    begun = perf_counter()
    with out.progress("recording", count) as advance:
        made = make_collection(collection, range(count), jobs=jobs, on_demo=advance)
    wall = perf_counter() - begun
    _report(out, name, folder, made, wall, seed)
    if not all(each.done for each in made):
        raise typer.Exit(FAILED)


def _collection(
    name: str, folder: Path, languages: str, robot: str | None, seed: int
) -> tuple["ScriptedCollection", int]:
    """The collection, and how many demos it has."""
    from executor.collections import (
        COUNTER_COUNT,
        LEEDS_COUNT,
        ORDERING_COUNT,
        CounterCollection,
        LeedsCollection,
        OrderingCollection,
    )
    from teleop.annotators import LANGUAGES

    if robot is not None:
        raise InputError(f"{name} is recorded with its own robot: leave out --robot {robot}")
    tags = tuple(dict.fromkeys(each.strip() for each in languages.split(",") if each.strip()))
    unknown = [each for each in tags if each not in LANGUAGES]
    if unknown or not tags:
        raise InputError(f"--languages {languages!r}: give one or several of {', '.join(LANGUAGES)}, as in en,ar")
    if name == "leeds":
        return LeedsCollection(folder, seed, tags), LEEDS_COUNT
    if name == "counter":
        return CounterCollection(folder, seed), COUNTER_COUNT
    return OrderingCollection(folder, seed, tags), ORDERING_COUNT


def _report(out: Output, name: str, folder: Path, made: "list[Made]", wall: float, seed: int) -> None:
    """Say what was made, how often the operator had to try, and what is missing."""
    new = [each for each in made if not each.kept]
    there = [each for each in new if each.done]
    failures = Counter(reason for each in new for reason in each.failures)
    tries = len(there) + sum(failures.values())
    success = len(there) / tries if tries else None
    kinds = Counter(each.kind for each in there)
    kept = len(made) - len(new)
    said = ", ".join(f"{number} {kind}" for kind, number in sorted(kinds.items()))
    out.say(
        f"{len(there)} demos in {folder}" + (f": {said}" if said else "") + (f"; {kept} were there" if kept else "")
    )
    if success is not None:
        simulated = sum(each.simulated for each in new)
        out.say(
            f"{100 * success:.0f}% of {tries} tries showed what they should; {simulated:.0f} s of teleoperation in "
            f"{wall:.1f} s ({simulated / wall:.1f} x real time)"
        )
    missing = [each for each in made if not each.done]
    for each in missing:
        out.say(f"{each.path.name}: {each.kind} could not be shown: {'; '.join(each.failures[-3:]) or 'out of reach'}")
    out.result(
        {
            "device": "scripted",
            "collection": name,
            "demos": [str(each.path) for each in made if each.done],
            "kept": kept,
            "missing": [each.path.name for each in missing],
            "tries": tries,
            "success_of_tries": success,
            "failures": dict(failures),
            "scenes_drawn": sum(each.drawn for each in new),
            "simulated_seconds": sum(each.simulated for each in new),
            "wall_seconds": wall,
            "seed": seed,
        }
    )
