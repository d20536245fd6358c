"""Reading demos back, also those that end in the middle."""

import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray
from pydantic import ValidationError

from twin.scene_spec import SceneSpec

from .demo import CommandTrack, Demo, InputTrack, StateTrack
from .demo_events import Event, Outcome, Sentence, Trim
from .demo_file import SUFFIX, DemoRecords, Record, is_whole, read_records
from .demo_format import (
    ARMS,
    BASE,
    COMMAND,
    DRIVE,
    EVENT,
    FORMAT_VERSION,
    GAMEPAD,
    GRIPPER,
    HANDS,
    JOINTS,
    OBJECTS,
    OUTCOME,
    PRELUDE_DRIVE,
    PRELUDE_GAMEPAD,
    UTTERANCE,
)
from .drive_command import DriveCommand
from .drive_track import ArmsTrack, DriveTrack, HandsTrack, command_from_message
from .errors import DemoError
from .gamepad_mapping import GamepadMapping

__all__ = ["SUFFIX", "IncompleteDemoWarning", "is_whole", "load_demo", "load_demos"]

_SEVERAL = (UTTERANCE, EVENT, OUTCOME)
"""Topics that may say several things in one step."""

_Messages = dict[str, dict[int, dict[str, Any]]]


class IncompleteDemoWarning(UserWarning):
    """A demo ends early; what was recovered is used."""


def load_demo(path: str | Path) -> Demo:
    """Read a demo.

    A file that ends early is recovered up to its last whole chunk, with `complete` False and an
    `IncompleteDemoWarning`.

    Raises:
        DemoError: The file cannot be read, is not a demo, or ends before anything was recorded; names the file.
    """
    path = Path(path)
    found = read_records(path)
    try:
        demo = demo_of(path, found)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        if isinstance(error, DemoError):
            raise
        raise DemoError(f"{path}: not a demo that this version can read: {_one_line(error)}") from error
    if not demo.complete:
        warnings.warn(
            f"{path}: ends early; recovered {demo.duration:.1f} s up to its last whole chunk",
            IncompleteDemoWarning,
            stacklevel=2,
        )
    return demo


def load_demos(directory: str | Path) -> Iterator[Demo]:
    """Read all demos of a directory one after the other, in the order of their names.

    Raises:
        DemoError: The directory is missing or holds no demo, or a file is not a demo; names it.
    """
    folder = Path(directory)
    if not folder.is_dir():
        raise DemoError(f"{folder}: not a directory of demos")
    paths = sorted(folder.glob(f"*{SUFFIX}"))
    if not paths:
        raise DemoError(f"{folder}: holds no demo (*{SUFFIX})")
    return (load_demo(path) for path in paths)


def demo_of(path: Path, found: DemoRecords) -> Demo:
    """Build a demo from its records.

    Raises:
        DemoError: It was written in another format, or nothing was recorded.
    """
    metadata = found.metadata or {}
    if metadata.get("format") != FORMAT_VERSION:
        raise DemoError(
            f"{path}: recorded in demo format {metadata.get('format')!r}, this version reads {FORMAT_VERSION!r}"
        )
    try:
        scene = SceneSpec.model_validate_json(metadata["scene"])
    except ValidationError as error:
        raise DemoError(f"{path}: metadata scene: {_one_line(error)}") from error
    messages: _Messages = {}
    for each in found.records:
        if each.topic not in _SEVERAL:
            messages.setdefault(each.topic, {})[each.step] = each.content
    moments = sorted(set.intersection(*(set(messages.get(topic, ())) for topic in (JOINTS, GRIPPER, OBJECTS))))
    if not moments:
        raise DemoError(f"{path}: not a usable demo: it ends before the first whole chunk, nothing can be recovered")
    controls = sorted(set(messages.get(GAMEPAD, ())) & set(messages.get(COMMAND, ())))
    joints = [messages[JOINTS][step] for step in moments]
    sentences = tuple(_sentence(each) for each in found.records if each.topic == UTTERANCE)
    outcomes = [each.content for each in found.records if each.topic == OUTCOME]
    return Demo(
        path=path,
        scene=scene,
        mapping=GamepadMapping(**json.loads(metadata["mapping"])),
        rate=int(metadata["rate"]),
        utterances=tuple(each.text for each in sentences),
        states=_states(moments, joints, messages),
        inputs=_inputs(messages, GAMEPAD, controls),
        commands=CommandTrack(
            asked=_column(messages, COMMAND, controls, "asked", (6,)),
            executed=_column(messages, COMMAND, controls, "executed", (6,)),
            joint_velocity=_column(messages, COMMAND, controls, "joint_velocity", (len(joints[0]["q"]),)),
            gripper_opening=_column(messages, COMMAND, controls, "gripper_opening"),
            reasons=tuple(str(messages[COMMAND][step]["reason"]) for step in controls),
        ),
        versions=json.loads(metadata["versions"]),
        complete=found.complete,
        sentences=sentences,
        events=tuple(_event(each) for each in found.records if each.topic == EVENT),
        outcome=Outcome(outcomes[-1]["outcome"], str(outcomes[-1]["note"])) if outcomes else None,
        wall_ns=_wall(found.records, controls),
        drive=_drive(messages, DRIVE, controls),
        arm_commands=_arm_commands(messages, controls),
        hands=_hands(messages, moments),
        base=_poses(messages, BASE, moments) if _covers(messages, BASE, moments) else None,
        prelude=_prelude(messages),
        trim=Trim(**json.loads(metadata["trim"])) if "trim" in metadata else None,
        repaired="repaired" in metadata,
        code=metadata.get("code", ""),
        metadata=metadata,
    )


def _states(moments: list[int], joints: list[dict[str, Any]], messages: _Messages) -> StateTrack:
    ids = messages[OBJECTS][moments[0]]["ids"]
    held = [messages[GRIPPER][step]["held"] for step in moments]
    count = len(ids)
    return StateTrack(
        steps=_frozen(moments, np.int64),
        times=_frozen([each["time"] for each in joints]),
        q=_frozen([each["q"] for each in joints]),
        dq=_frozen([each["dq"] for each in joints]),
        tool=_poses(messages, GRIPPER, moments),
        gripper_opening=_column(messages, GRIPPER, moments, "opening"),
        gripper_closed=_frozen([messages[GRIPPER][step]["closed"] for step in moments], np.bool_),
        held=_frozen([-1 if each is None else each for each in held], np.int64),
        object_ids=_frozen(ids, np.int64),
        object_positions=_column(messages, OBJECTS, moments, "positions", (count, 3)),
        object_orientations=_column(messages, OBJECTS, moments, "orientations_xyzw", (count, 4)),
    )


def _inputs(messages: _Messages, topic: str, steps: list[int]) -> InputTrack:
    kept = bool(steps) and all("arrived" in messages[topic][step] for step in steps)
    return InputTrack(
        axes=_column(messages, topic, steps, "axes", (4,)),
        buttons=_column(messages, topic, steps, "buttons", (17,)),
        arrived=_frozen([messages[topic][step]["arrived"] for step in steps], np.bool_) if kept else None,
    )


def _drive(messages: _Messages, topic: str, steps: list[int]) -> DriveTrack | None:
    """What was wanted of the whole robot. Devices report less often than the arm is controlled, so most repeat."""
    if topic not in messages:
        return None
    commands: list[DriveCommand] = []
    last: dict[str, Any] | None = None
    for step in steps:
        message = {key: value for key, value in messages[topic][step].items() if key != "step"}
        commands.append(commands[-1] if message == last else command_from_message(message))
        last = message
    return DriveTrack(tuple(commands))


def _arm_commands(messages: _Messages, steps: list[int]) -> ArmsTrack | None:
    if not steps or not _covers(messages, ARMS, steps):
        return None
    names = tuple(messages[ARMS][steps[0]]["names"])
    rows = [messages[ARMS][step] for step in steps]
    return ArmsTrack(
        names=names,
        asked=_column(messages, ARMS, steps, "asked", (len(names), 6)),
        executed=_column(messages, ARMS, steps, "executed", (len(names), 6)),
        openings=_column(messages, ARMS, steps, "openings", (len(names),)),
        reasons=tuple(tuple(map(str, row["reasons"])) for row in rows),
        details=tuple(tuple(map(str, row["details"])) for row in rows),
        base_asked=_column(messages, ARMS, steps, "base_asked", (2,)),
        base_executed=_column(messages, ARMS, steps, "base_executed", (2,)),
        states=tuple(str(row["state"]) for row in rows),
        state_reasons=tuple(str(row["reason"]) for row in rows),
    )


def _hands(messages: _Messages, steps: list[int]) -> HandsTrack | None:
    if not _covers(messages, HANDS, steps):
        return None
    names = tuple(messages[HANDS][steps[0]]["names"])
    count = len(names)
    rows = [messages[HANDS][step] for step in steps]
    tools = [
        _column(messages, HANDS, steps, "positions", (count, 3)),
        _column(messages, HANDS, steps, "orientations_xyzw", (count, 4)),
    ]
    return HandsTrack(
        names=names,
        tools=_frozen(np.concatenate(tools, axis=2)),
        openings=_column(messages, HANDS, steps, "openings", (count,)),
        closed=_frozen([row["closed"] for row in rows], np.bool_),
        held=_frozen([[-1 if each is None else each for each in row["held"]] for row in rows], np.int64),
        wrist_wrenches=_column(messages, HANDS, steps, "wrist_wrenches", (count, 6)),
        finger_efforts=_column(messages, HANDS, steps, "finger_efforts", (count, 2)),
    )


def _prelude(messages: _Messages) -> InputTrack | DriveTrack | None:
    if PRELUDE_DRIVE in messages:
        return _drive(messages, PRELUDE_DRIVE, sorted(messages[PRELUDE_DRIVE]))
    if PRELUDE_GAMEPAD in messages:
        return _inputs(messages, PRELUDE_GAMEPAD, sorted(messages[PRELUDE_GAMEPAD]))
    return None


def _sentence(record: Record) -> Sentence:
    content = record.content
    said = content.get("when", "before")
    return Sentence(str(content["text"]), record.step, said, str(content.get("language", "")))


def _event(record: Record) -> Event:
    content = record.content
    wall = record.publish_time if record.publish_time != record.log_time else 0
    return Event(record.step, content["kind"], str(content["text"]), str(content["arm"]), wall)


def _wall(records: list[Record], steps: list[int]) -> NDArray[np.int64] | None:
    """Wall-clock times of the control steps, unless only simulated time was kept."""
    times = {each.step: (each.publish_time, each.log_time) for each in records if each.topic == GAMEPAD}
    if not steps or all(wall == simulated for wall, simulated in times.values()):
        return None
    return _frozen([times[step][0] for step in steps], np.int64)


def _covers(messages: _Messages, topic: str, steps: list[int]) -> bool:
    return topic in messages and all(step in messages[topic] for step in steps)


def _poses(messages: _Messages, topic: str, steps: list[int]) -> NDArray[np.float64]:
    """Positions and quaternions xyzw side by side, (T, 7)."""
    sides = [_column(messages, topic, steps, key) for key in ("position", "orientation_xyzw")]
    return _frozen(np.hstack(sides))


def _column(
    messages: _Messages, topic: str, steps: list[int], field: str, shape: tuple[int, ...] | None = None
) -> NDArray[np.float64]:
    """One field of a topic over steps, (K, ...); null becomes NaN. `shape` is that of one value, for empty tracks."""
    values = np.array([messages[topic][step][field] for step in steps], dtype=np.float64)
    if shape is not None:
        values = values.reshape(len(steps), *shape)
    values.setflags(write=False)
    return values


def _frozen(values: object, dtype: DTypeLike = np.float64) -> NDArray[Any]:
    array = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())
