"""The records of an MCAP file, complete or not.

A file without its index is read from the start, chunk by chunk, up to the last complete chunk, so
that the log of a killed run loses only what came after it; `Records.fault` says so.
"""

import os
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any, BinaryIO

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, Message, Metadata, Schema
from mcap.stream_reader import get_chunk_data_stream
from mcap.writer import MCAP0_MAGIC
from zstandard import ZstdError

from uvms_analysis.errors import LogError

_READERS: dict[int, Callable[[bytes], Any]] = {
    Opcode.CHUNK: lambda body: Chunk.read(_stream(body)),
    Opcode.SCHEMA: lambda body: Schema.read(_stream(body)),
    Opcode.CHANNEL: lambda body: Channel.read(_stream(body)),
    Opcode.MESSAGE: lambda body: Message.read(_stream(body), len(body)),
    Opcode.ATTACHMENT: lambda body: Attachment.read(_stream(body)),
    Opcode.METADATA: lambda body: Metadata.read(_stream(body)),
}
_RECORD = struct.Struct("<BQ")
_MESSAGE = struct.Struct("<HIQQ")

UNFINISHED = "the writer was stopped early, or the end of the file is damaged"

_DAMAGE = (McapError, ZstdError, ValueError, KeyError, RuntimeError, MemoryError, struct.error)
"""Raised by the readers on bytes that are not records."""

Raw = tuple[int, int, bytes]
"""Channel number, log time in nanoseconds, data."""


@dataclass
class Records:
    """The content of a file; `fault` says why it is incomplete, and is empty otherwise."""

    path: Path
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    blocks: list[Chunk | Message] = field(default_factory=list)
    fault: str = ""

    def messages(self, channels: set[int] | None = None) -> Iterator[Raw]:
        """Messages of these channels, or of all, in the order of the file."""
        for block in self.blocks:
            if isinstance(block, Message):
                if channels is None or block.channel_id in channels:
                    yield block.channel_id, block.log_time, block.data
            else:
                yield from _messages(_unpacked(block), channels)


def read_records(path: str | Path) -> Records:
    """All records of a file up to its end, or up to where it breaks off.

    Raises:
        LogError: there is no such file, it cannot be read, or it is not an MCAP file.
    """
    records = Records(Path(path))
    try:
        with open(path, "rb") as file:
            _read(records, file, os.fstat(file.fileno()).st_size)
    except OSError as fault:
        raise LogError(f"log {path}: cannot be read: {fault.strerror}") from fault
    return records


def _read(records: Records, file: BinaryIO, size: int) -> None:
    if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
        raise LogError(f"log {records.path}: is not an MCAP file")
    damaged, code = 0, 0
    while code != Opcode.FOOTER:
        head = file.read(_RECORD.size)
        code, length = _RECORD.unpack(head) if len(head) == _RECORD.size else (0, size)
        if length > size - file.tell():
            records.fault = UNFINISHED
            return
        # Indexes are skipped: everything is read in order anyway.
        if code in _READERS:
            damaged += not _stored(records, code, file.read(length))
        else:
            file.seek(length, os.SEEK_CUR)
    if file.read(len(MCAP0_MAGIC)) != MCAP0_MAGIC:
        records.fault = UNFINISHED
    elif damaged:
        records.fault = f"{damaged} of its chunks are damaged and left out"


def _stored(records: Records, code: int, body: bytes) -> bool:
    """Whether the record is complete; if so, it is kept."""
    try:
        _store(records, code, body)
    except _DAMAGE:
        return False
    return True


def _store(records: Records, code: int, body: bytes) -> None:
    record = _READERS[code](body)
    if isinstance(record, Chunk):
        data = _unpacked(record)
        for inner, start, end in _walk(data):
            if inner in (Opcode.SCHEMA, Opcode.CHANNEL):
                _store(records, inner, data[start:end])
        records.blocks.append(record)
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


def _stream(body: bytes) -> ReadDataStream:
    return ReadDataStream(BytesIO(body))


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
