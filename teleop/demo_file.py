"""The records of a demo file, whole or cut short, and writing them anew."""

import os
import struct
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import orjson
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Metadata, Schema
from mcap.stream_reader import MAGIC_SIZE, get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC, CompressionType, Writer

from .code_version import version_of
from .demo_format import METADATA, SCHEMAS
from .errors import DemoError

SUFFIX = ".mcap"
_FRAME = struct.Struct("<BQ")
"""Before every record: opcode and length of what follows."""
_MESSAGE = struct.Struct("<HIQQ")
"""At the start of a message: channel, sequence (our control step), log and publish time."""
_BROKEN = (McapError, ValueError, struct.error, zstandard.ZstdError, OverflowError, MemoryError)
"""What parsing a damaged record can raise; ValueError covers CRC, UTF-8 and JSON."""
_CHUNK_BYTES = 1 << 17
"""A rewritten file's chunks: about a second each."""


@dataclass(frozen=True, slots=True)
class Record:
    """One message.

    Attributes:
        topic: Its topic.
        step: Control step.
        log_time: Simulated time since the start [ns].
        publish_time: Wall-clock time since 1970 [ns]; equal to `log_time` in files that did not keep it.
        content: What it says.
    """

    topic: str
    step: int
    log_time: int
    publish_time: int
    content: dict[str, Any]


@dataclass(slots=True)
class DemoRecords:
    """All that could be read of a file.

    Attributes:
        metadata: Of the demo; None where the file has none.
        records: Messages of whole, sound chunks, in the file's order.
        complete: Whether the file reaches its end.
    """

    metadata: dict[str, str] | None = None
    records: list[Record] = field(default_factory=list)
    complete: bool = False


def read_records(path: Path) -> DemoRecords:
    """Read a file up to its end or its last whole, sound chunk. Messages that are not JSON are left out.

    Raises:
        DemoError: The file cannot be read, or is no MCAP file or not one of ours; names it.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DemoError(f"{path}: cannot be read: {error.strerror}") from error
    if not data.startswith(MCAP0_MAGIC):
        what = "empty" if not data else "not an MCAP file"
        raise DemoError(f"{path}: not a demo: it is {what}")
    found = DemoRecords()
    _read(data, found)
    if found.metadata is None:
        why = "an MCAP file that Showtell did not record" if found.complete else "it ends before its metadata"
        raise DemoError(f"{path}: not a demo: {why}")
    return found


def is_whole(path: str | Path) -> bool:
    """Whether a file has both ends of a whole demo; much quicker than reading it, and false if it cannot be read."""
    try:
        with Path(path).open("rb") as file:
            start = file.read(MAGIC_SIZE)
            file.seek(-MAGIC_SIZE, os.SEEK_END)
            return start == MCAP0_MAGIC == file.read()
    except OSError:
        return False


def write_records(path: Path, metadata: Mapping[str, str], records: Iterable[Record], *, replace: bool = False) -> None:
    """Write a whole demo file: beside its place under another name, then moved into it.

    Args:
        path: The file.
        metadata: Of the demo.
        records: Messages, in order.
        replace: Whether a file that is there is replaced.

    Raises:
        DemoError: The file is there already, or cannot be written.
    """
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        with temporary.open("wb") as file:
            writer, channels = start_file(file, metadata, _CHUNK_BYTES)
            for each in records:
                if each.topic in channels:
                    data = orjson.dumps(each.content)
                    writer.add_message(channels[each.topic], each.log_time, data, each.publish_time, each.step)
            writer.finish()
            file.flush()
            os.fsync(file.fileno())
        if replace:
            os.replace(temporary, path)
        else:
            _move_without_replacing(temporary, path)
        _sync_folder(path.parent)
    except FileExistsError as error:
        raise DemoError(f"{path}: is there already; choose another name") from error
    except OSError as error:
        raise DemoError(f"{path}: cannot be written: {error.strerror or error}") from error
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def start_file(output: Any, metadata: Mapping[str, str], chunk_size: int) -> tuple[Any, dict[str, int]]:
    """Begin a demo file; returns the MCAP writer and its channels by topic.

    Args:
        output: What to write to; has `write`, `tell` and `flush`.
        metadata: Of the demo.
        chunk_size: A chunk is closed when it is larger [bytes].
    """
    writer: Any = Writer(output, chunk_size=chunk_size, compression=CompressionType.ZSTD)
    writer.start(profile="showtell", library=f"showtell {version_of('showtell')}")
    writer.add_metadata(METADATA, dict(metadata))
    channels = {
        topic: writer.register_channel(topic, "json", writer.register_schema(name, "jsonschema", schema))
        for topic, (name, schema) in SCHEMAS.items()
    }
    return writer, channels


def _read(data: bytes, found: DemoRecords) -> None:
    """Collect metadata and messages until the end or the first broken record."""
    topics: dict[int, str] = {}
    for opcode, body in _framed(data, MAGIC_SIZE):
        try:
            if opcode == Opcode.METADATA:
                metadata = Metadata.read(ReadDataStream(BytesIO(body)))
                if metadata.name == METADATA:
                    found.metadata = dict(metadata.metadata)
            elif opcode == Opcode.CHUNK:
                chunk = Chunk.read(ReadDataStream(BytesIO(body)))
                stream, size = get_chunk_data_stream(chunk, validate_crc=True)
                found.records += _chunk(stream.read(size), topics)
            elif opcode == Opcode.FOOTER:
                found.complete = data.endswith(MCAP0_MAGIC)
                return
        except _BROKEN:
            return


def _chunk(data: bytes, topics: dict[int, str]) -> list[Record]:
    """Decode a chunk's messages: all of them or, when one is broken, none."""
    records = []
    for opcode, body in _framed(data, 0):
        if opcode == Opcode.CHANNEL:
            channel = Channel.read(ReadDataStream(BytesIO(body)))
            if channel.message_encoding == "json":
                topics[channel.id] = channel.topic
        elif opcode == Opcode.MESSAGE:
            number, step, log_time, publish_time = _MESSAGE.unpack_from(body)
            if number in topics:
                content = orjson.loads(body[_MESSAGE.size :])
                records.append(Record(topics[number], step, log_time, publish_time, content))
        elif opcode == Opcode.SCHEMA:
            Schema.read(ReadDataStream(BytesIO(body)))  # only whether it is sound
    return records


def _framed(data: bytes, position: int) -> Iterator[tuple[int, bytes]]:
    """Opcode and content of every whole record; a chunk's inside is framed like the file itself."""
    size = len(data)
    while position + _FRAME.size <= size:
        opcode, length = _FRAME.unpack_from(data, position)
        position += _FRAME.size
        if position + length > size:
            return
        yield opcode, data[position : position + length]
        position += length


def _move_without_replacing(temporary: Path, path: Path) -> None:
    """Move a file; a link, unlike a rename, refuses to overwrite.

    Raises:
        FileExistsError: There is a file.
    """
    try:
        os.link(temporary, path)
    except FileExistsError:
        raise
    except OSError:  # some file systems have no links
        if path.exists():
            raise FileExistsError(str(path)) from None
        os.replace(temporary, path)


def _sync_folder(folder: Path) -> None:
    """Make a new name survive a loss of power."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
