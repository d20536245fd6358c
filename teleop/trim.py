"""Cutting a piece out of a demo: always a copy, with all that a replay needs."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from .demo import Demo
from .demo_file import Record, read_records, write_records
from .demo_format import (
    ARMS,
    BASE,
    COMMAND,
    DRIVE,
    EVENT,
    GAMEPAD,
    GRIPPER,
    HANDS,
    JOINTS,
    OBJECTS,
    OUTCOME,
    PRELUDE_DRIVE,
    PRELUDE_GAMEPAD,
    UTTERANCE,
    log_time,
)
from .demo_reader import demo_of, load_demo
from .errors import DemoError

_STATES = (JOINTS, GRIPPER, OBJECTS, HANDS, BASE)
_CONTROLS = (COMMAND, ARMS)
_PRELUDES = {GAMEPAD: PRELUDE_GAMEPAD, DRIVE: PRELUDE_DRIVE}


def trim_demo(source: str | Path, start: float, end: float, output: str | Path) -> Demo:
    """Copy the piece of a demo between two times, shifted so that it begins at step 0 and time 0.

    Both ends move to the nearest recorded states. The inputs before the piece come along as a prelude: a robot in the
    middle of a motion cannot be put there, only brought there, so a replay plays them first and compares from the
    piece's start. Sentences and the outcome are kept, events where they happened in the piece. The original is not
    touched.

    Args:
        source: The demo; one that was trimmed already can be trimmed again.
        start: Where the piece starts, from the demo's start [s].
        end: Where it ends [s].
        output: The new demo.

    Returns:
        The new demo, read back.

    Raises:
        DemoError: The demo cannot be read, the times are not in it, or the new one is there already.
    """
    source, output = Path(source), Path(output)
    found = read_records(source)
    demo = demo_of(source, found)
    first, last = _piece(demo, start, end)
    before = 0 if demo.prelude is None else len(demo.prelude)
    origin = demo.trim.origin if demo.trim else source.name
    offset = demo.trim.first if demo.trim else 0
    metadata = dict(found.metadata or {})
    metadata["trim"] = json.dumps({"origin": origin, "first": offset + first, "last": offset + last})
    records = [_moved(each, demo.rate, first, last, before) for each in found.records]
    kept = [each for each in records if each is not None]
    write_records(output, metadata, sorted(kept, key=_place))
    return load_demo(output)


def _place(record: Record) -> tuple[bool, int]:
    """The prelude comes first; otherwise as recorded."""
    return record.topic not in _PRELUDES.values(), record.step


def _piece(demo: Demo, start: float, end: float) -> tuple[int, int]:
    """The recorded states nearest to both times, as control steps.

    Raises:
        DemoError: The times are not in the demo, or leave nothing.
    """
    times, steps = demo.states.times, demo.states.steps
    longest = max(float(times[-1]), len(demo.inputs) / demo.rate) + 0.5 / demo.rate
    if not times[0] <= start < end <= longest:
        raise DemoError(
            f"{demo.path}: cannot keep {start:g} s to {end:g} s: the demo goes from {times[0]:g} s to "
            f"{longest:.3f} s, and the first must be before the second"
        )
    first, last = (int(steps[np.argmin(np.abs(times - moment))]) for moment in (start, end))
    if first >= last:
        raise DemoError(f"{demo.path}: {start:g} s to {end:g} s holds no two recorded states; keep more")
    return first, last


def _moved(record: Record, rate: int, first: int, last: int, before: int) -> Record | None:
    """A record as it is in the trimmed copy; None where it is cut away."""
    topic, step = record.topic, record.step
    if topic in (UTTERANCE, OUTCOME):
        step = min(max(step, first), last)
    if topic in _PRELUDES.values():
        return record
    if topic in _PRELUDES and step < first:
        return _at(replace(record, topic=_PRELUDES[topic]), before + step, rate)
    inside = first <= step <= last if topic in (*_STATES, UTTERANCE, OUTCOME, EVENT) else first <= step < last
    if not inside or topic not in (*_STATES, *_CONTROLS, *_PRELUDES, UTTERANCE, OUTCOME, EVENT):
        return None
    moved = _at(record, step - first, rate)
    if topic == JOINTS:
        content = {**moved.content, "time": moved.content["time"] - first / rate}
        return replace(moved, content=content)
    return moved


def _at(record: Record, step: int, rate: int) -> Record:
    """The same record at another step; the wall clock stays, where there is one."""
    at = log_time(step, rate)
    wall = at if record.publish_time == record.log_time else record.publish_time
    content = {**record.content, "step": step}
    return replace(record, step=step, log_time=at, publish_time=wall, content=content)
