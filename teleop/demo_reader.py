"""Reading demos back, also those that end in the middle."""

import json
import os
import struct
import warnings
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path

import numpy as np
import orjson
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Metadata
from mcap.stream_reader import MAGIC_SIZE, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC
from numpy.typing import DTypeLike, NDArray
from pydantic import ValidationError

from twin.scene_spec import SceneSpec

from .demo import CommandTrack, Demo, InputTrack, StateTrack
from .demo_format import COMMAND, FORMAT_VERSION, GAMEPAD, GRIPPER, JOINTS, METADATA, OBJECTS, UTTERANCE
from .errors import DemoError
from .gamepad_mapping import GamepadMapping

SUFFIX = ".mcap"
_FRAME = struct.Struct("<BQ")
"""Before every record: opcode and length of what follows."""
_MESSAGE = struct.Struct("<HIQQ")
"""At the start of a message: channel, sequence (our control step), log and publish time."""
_BROKEN = (McapError, ValueError, struct.error, zstandard.ZstdError, OverflowError, MemoryError)
"""What parsing a damaged record can raise; ValueError covers CRC, UTF-8 and JSON."""

_Messages = dict[str, dict[int, dict[str, object]]]


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
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DemoError(f"{path}: cannot be read: {error.strerror}") from error
    if not data.startswith(MCAP0_MAGIC):
        what = "empty" if not data else "not an MCAP file"
        raise DemoError(f"{path}: not a demo: it is {what}")
    reading = _Reading(data)
    messages: _Messages = {}
    for topic, step, message in reading.messages():
        messages.setdefault(topic, {})[step] = message
    if reading.metadata is None:
        why = "an MCAP file that Showtell did not record" if reading.complete else "it ends before its metadata"
        raise DemoError(f"{path}: not a demo: {why}")
    try:
        demo = _demo(path, reading.metadata, messages, reading.utterances, reading.complete)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
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


def is_whole(path: str | Path) -> bool:
    """Whether a file has both ends of a whole demo; much quicker than reading it, and false if it cannot be read."""
    try:
        with Path(path).open("rb") as file:
            start = file.read(MAGIC_SIZE)
            file.seek(-MAGIC_SIZE, os.SEEK_END)
            return start == MCAP0_MAGIC == file.read()
    except OSError:
        return False


class _Reading:
    """One pass over a file's records; remembers metadata and whether the end was reached."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._topics: dict[int, str] = {}
        self.metadata: dict[str, str] | None = None
        self.utterances: list[str] = []
        self.complete = False

    def messages(self) -> Iterator[tuple[str, int, dict[str, object]]]:
        """Topic, step and content of all messages in whole, sound chunks."""
        for opcode, body in _records(self._data, MAGIC_SIZE):
            try:
                if opcode == Opcode.METADATA:
                    metadata = Metadata.read(ReadDataStream(BytesIO(body)))
                    if metadata.name == METADATA:
                        self.metadata = dict(metadata.metadata)
                elif opcode == Opcode.CHUNK:
                    chunk = Chunk.read(ReadDataStream(BytesIO(body)))
                    stream, size = get_chunk_data_stream(chunk, validate_crc=True)
                    yield from self._chunk(stream.read(size))
                elif opcode == Opcode.FOOTER:
                    self.complete = self._data.endswith(MCAP0_MAGIC)
                    return
            except _BROKEN:
                return

    def _chunk(self, data: bytes) -> list[tuple[str, int, dict[str, object]]]:
        """Decode a chunk's messages: all of them or, when one is broken, none."""
        found = []
        utterances = []
        for opcode, body in _records(data, 0):
            if opcode == Opcode.CHANNEL:
                channel = Channel.read(ReadDataStream(BytesIO(body)))
                self._topics[channel.id] = channel.topic
            elif opcode == Opcode.MESSAGE:
                number, step, *_ = _MESSAGE.unpack_from(body)
                topic, message = self._topics.get(number, ""), orjson.loads(body[_MESSAGE.size :])
                if topic == UTTERANCE:
                    utterances.append(str(message["text"]))
                elif topic:
                    found.append((topic, step, message))
        self.utterances += utterances
        return found


def _records(data: bytes, position: int) -> Iterator[tuple[int, bytes]]:
    """Opcode and content of every whole record; a chunk's inside is framed like the file itself."""
    size = len(data)
    while position + _FRAME.size <= size:
        opcode, length = _FRAME.unpack_from(data, position)
        position += _FRAME.size
        if position + length > size:
            return
        yield opcode, data[position : position + length]
        position += length


def _demo(path: Path, metadata: dict[str, str], messages: _Messages, utterances: list[str], complete: bool) -> Demo:
    """Build a demo from its records.

    Raises:
        DemoError: It was written in another format, or nothing was recorded.
    """
    if metadata.get("format") != FORMAT_VERSION:
        raise DemoError(
            f"{path}: recorded in demo format {metadata.get('format')!r}, this version reads {FORMAT_VERSION!r}"
        )
    try:
        scene = SceneSpec.model_validate_json(metadata["scene"])
    except ValidationError as error:
        raise DemoError(f"{path}: metadata scene: {_one_line(error)}") from error
    moments = sorted(set.intersection(*(set(messages.get(topic, ())) for topic in (JOINTS, GRIPPER, OBJECTS))))
    if not moments:
        raise DemoError(f"{path}: not a usable demo: it ends before the first whole chunk, nothing can be recovered")
    controls = sorted(set(messages.get(GAMEPAD, ())) & set(messages.get(COMMAND, ())))
    joints = [messages[JOINTS][step] for step in moments]
    return Demo(
        path=path,
        scene=scene,
        mapping=GamepadMapping(**json.loads(metadata["mapping"])),
        rate=int(metadata["rate"]),
        utterances=tuple(utterances),
        states=_states(moments, joints, messages),
        inputs=InputTrack(
            axes=_column(messages, GAMEPAD, controls, "axes", (4,)),
            buttons=_column(messages, GAMEPAD, controls, "buttons", (17,)),
        ),
        commands=CommandTrack(
            asked=_column(messages, COMMAND, controls, "asked", (6,)),
            executed=_column(messages, COMMAND, controls, "executed", (6,)),
            joint_velocity=_column(messages, COMMAND, controls, "joint_velocity", (len(joints[0]["q"]),)),  # type: ignore[arg-type]
            gripper_opening=_column(messages, COMMAND, controls, "gripper_opening"),
            reasons=tuple(str(messages[COMMAND][step]["reason"]) for step in controls),
        ),
        versions=json.loads(metadata["versions"]),
        complete=complete,
    )


def _states(moments: list[int], joints: list[dict[str, object]], messages: _Messages) -> StateTrack:
    ids = messages[OBJECTS][moments[0]]["ids"]
    held = [messages[GRIPPER][step]["held"] for step in moments]
    count = len(ids)  # type: ignore[arg-type]
    return StateTrack(
        steps=_frozen(moments, np.int64),
        times=_frozen([each["time"] for each in joints]),
        q=_frozen([each["q"] for each in joints]),
        dq=_frozen([each["dq"] for each in joints]),
        tool=_frozen(
            np.hstack(
                [
                    _column(messages, GRIPPER, moments, "position"),
                    _column(messages, GRIPPER, moments, "orientation_xyzw"),
                ]
            )
        ),
        gripper_opening=_column(messages, GRIPPER, moments, "opening"),
        gripper_closed=_frozen([messages[GRIPPER][step]["closed"] for step in moments], np.bool_),
        held=_frozen([-1 if each is None else each for each in held], np.int64),
        object_ids=_frozen(ids, np.int64),
        object_positions=_column(messages, OBJECTS, moments, "positions", (count, 3)),
        object_orientations=_column(messages, OBJECTS, moments, "orientations_xyzw", (count, 4)),
    )


def _column(
    messages: _Messages, topic: str, steps: list[int], field: str, shape: tuple[int, ...] | None = None
) -> NDArray[np.float64]:
    """One field of a topic over steps, (K, ...); null becomes NaN. `shape` is that of one value, for empty tracks."""
    values = np.array([messages[topic][step][field] for step in steps], dtype=np.float64)
    if shape is not None:
        values = values.reshape(len(steps), *shape)
    values.setflags(write=False)
    return values


def _frozen(values: object, dtype: DTypeLike = np.float64) -> NDArray:  # type: ignore[type-arg]
    array = np.array(values, dtype=dtype)
    array.setflags(write=False)
    return array


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())
