"""The records of an MCAP file, whether or not its writer came to its end.

A file without its index is read from the start, chunk by chunk, to the last chunk that is whole;
so a log of a run that was killed is as good as its last chunk, and says so.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

from mcap.data_stream import ReadDataStream
from mcap.exceptions import InvalidMagic, McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    McapRecord,
    Message,
    Metadata,
    Schema,
)
from mcap.stream_reader import StreamReader, get_chunk_data_stream
from zstandard import ZstdError

from uvms_bringup.errors import LogError

_RECORD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")

UNFINISHED = "its writer did not come to its end, or its end is damaged"

_DAMAGE = (McapError, ZstdError, ValueError, KeyError, RuntimeError, MemoryError, struct.error)
"""What the readers raise on bytes that are no records."""

Raw = tuple[int, int, bytes]
"""Channel number, log time in nanoseconds, data."""


@dataclass
class Records:
    """What a file holds; `fault` says why it is not complete, and is empty if it is."""

    path: Path
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    blocks: list[Chunk | Message] = field(default_factory=list)
    fault: str = ""

    def messages(self, channels: set[int] | None = None) -> Iterator[Raw]:
        """Messages of these channels, or of all, as they lie in the file."""
        for block in self.blocks:
            if isinstance(block, Message):
                if channels is None or block.channel_id in channels:
                    yield block.channel_id, block.log_time, block.data
            else:
                yield from _messages(_unpacked(block), channels)


def read_records(path: str | Path) -> Records:
    """All records of a file up to its end, or to where it breaks off.

    Raises:
        LogError: there is no such file, it cannot be read, or it is no MCAP file.
    """
    records = Records(Path(path))
    try:
        with open(path, "rb") as file:
            _read(records, StreamReader(file, emit_chunks=True))
    except OSError as fault:
        raise LogError(f"log {path}: cannot be read: {fault.strerror}") from fault
    return records


def _read(records: Records, reader: StreamReader) -> None:
    damaged = 0
    last: McapRecord | None = None
    try:
        for last in reader.records:
            damaged += not _stored(records, last)
    except InvalidMagic as fault:
        if last is None:
            raise LogError(f"log {records.path}: is not an MCAP file") from fault
        records.fault = UNFINISHED
    except _DAMAGE:
        if last is None:
            raise LogError(f"log {records.path}: is not an MCAP file, or an empty one") from None
        records.fault = UNFINISHED
    if not records.fault and damaged:
        records.fault = f"{damaged} of its chunks are damaged and left out"


def _stored(records: Records, record: McapRecord) -> bool:
    """Whether the record is whole; if so, it is kept."""
    try:
        _store(records, record)
    except _DAMAGE:
        return False
    return True


def _store(records: Records, record: McapRecord) -> None:
    if isinstance(record, Chunk):
        _register(records, record)
    elif isinstance(record, Message):
        records.blocks.append(record)
    elif isinstance(record, Schema):
        records.schemas[record.id] = record
    elif isinstance(record, Channel):
        records.channels[record.id] = record
    elif isinstance(record, Attachment):
        records.attachments[record.name] = record.data
    elif isinstance(record, Metadata):
        records.metadata[record.name] = dict(record.metadata)


def _register(records: Records, chunk: Chunk) -> None:
    """Keep a chunk, and what it says of schemas and channels."""
    data = _unpacked(chunk)
    for code, start, end in _walk(data):
        if code in (Opcode.SCHEMA, Opcode.CHANNEL):
            _store(records, _parse(code, data[start:end]))
    records.blocks.append(chunk)


def _parse(code: int, body: bytes) -> Schema | Channel:
    stream = ReadDataStream(BytesIO(body))
    return Schema.read(stream) if code == Opcode.SCHEMA else Channel.read(stream)


def _unpacked(chunk: Chunk) -> bytes:
    stream, length = get_chunk_data_stream(chunk, validate_crc=True)
    return stream.read(length)


def _walk(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, start and end of every record in an unpacked chunk."""
    position, end = 0, len(data)
    while position < end:
        code, length = _RECORD.unpack_from(data, position)
        start = position + _RECORD.size
        position = start + length
        yield code, start, position


def _messages(data: bytes, channels: set[int] | None) -> Iterator[Raw]:
    for code, start, end in _walk(data):
        if code == Opcode.MESSAGE:
            channel, _, stamp, _ = _MESSAGE.unpack_from(data, start)
            if channels is None or channel in channels:
                yield channel, stamp, data[start + _MESSAGE.size : end]
