"""Putting right and adding to finished files: always written anew and moved into place, never edited."""

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import time_ns
from typing import Any

from .demo_events import OutcomeKind
from .demo_file import DemoRecords, Record, read_records, write_records
from .demo_format import OUTCOME, OUTCOMES, UTTERANCE, log_time
from .demo_reader import demo_of
from .errors import DemoError

KEPT_SUFFIX = ".truncated"
"""Added to the name of a file that was repaired: it is kept as it was."""


@dataclass(frozen=True, slots=True)
class Repair:
    """What a repair did.

    Attributes:
        path: The demo.
        needed: Whether it ended early; nothing was done otherwise.
        seconds: Length of the demo as it is now [s].
        kept: The file as it was before; None where nothing was done.
    """

    path: Path
    needed: bool
    seconds: float
    kept: Path | None = None


def repair_demo(path: str | Path) -> Repair:
    """Rewrite a demo that ends early up to its last whole chunk, with an index; the damaged file is kept beside it.

    Raises:
        DemoError: Nothing can be recovered, or the file cannot be written; names it. The file is then as it was.
    """
    path = Path(path)
    found = read_records(path)
    demo = demo_of(path, found)
    if found.complete:
        return Repair(path, False, demo.duration)
    kept = path.with_name(path.name + KEPT_SUFFIX)
    metadata = dict(found.metadata or {})
    metadata["repaired"] = json.dumps({"seconds": demo.duration, "steps": len(demo.inputs)})
    try:
        if kept.exists():
            raise DemoError(f"{kept}: is there already, so {path.name} was not repaired; move it away")
        os.link(path, kept)
    except OSError as error:
        raise DemoError(f"{kept}: cannot be written: {error.strerror or error}") from error
    try:
        write_records(path, metadata, found.records, replace=True)
    except DemoError:
        kept.unlink()
        raise
    return Repair(path, True, demo.duration, kept)


def add_utterances(path: str | Path, texts: Sequence[str]) -> None:
    """Add sentences that were said after a demo had ended.

    Raises:
        DemoError: The file cannot be read or written, or ends early: repair it first.
    """
    _add(Path(path), UTTERANCE, [{"text": text, "when": "after"} for text in texts])


def label_demo(path: str | Path, outcome: OutcomeKind, note: str = "") -> None:
    """Say how a finished demo ended; the last word counts.

    Raises:
        DemoError: There is no such outcome, the file cannot be read or written, or ends early.
    """
    if outcome not in OUTCOMES:
        raise DemoError(f"an outcome cannot be {outcome!r}: use one of {', '.join(OUTCOMES)}")
    _add(Path(path), OUTCOME, [{"outcome": outcome, "note": note}])


def _add(path: Path, topic: str, contents: list[dict[str, Any]]) -> None:
    """Copy a demo with messages added at its last step, and put the copy in its place."""
    found = read_records(path)
    if not found.complete:
        raise DemoError(f"{path}: ends early; repair it first (showtell demos {path} --repair)")
    metadata = found.metadata or {}
    step, at, now = _last_step(found), 0, time_ns()
    at = log_time(step, int(metadata["rate"]))
    added = [Record(topic, step, at, now, {"step": step, **content}) for content in contents]
    write_records(path, metadata, [*found.records, *added], replace=True)


def _last_step(found: DemoRecords) -> int:
    return max((each.step for each in found.records if not each.topic.startswith("/prelude")), default=0)
