"""The records of an MCAP file, complete or not.

A file is read from the start, chunk by chunk, so that the log of a killed run loses only what came
after its last whole chunk. Every checksum that MCAP has is compared; what is damaged is left out,
and `Records.faults` says so.
"""

import os
import struct
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import BinaryIO, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    Channel,
    Chunk,
    DataEnd,
    Footer,
    Header,
    Metadata,
    Schema,
    Statistics,
)
from zstandard import ZstdError

from uvms_analysis.errors import LogError
from uvms_analysis.log import mcap_format as form
from uvms_analysis.log import seal
from uvms_analysis.log.unpack import stream_of, unpacked, walk

_MESSAGE = struct.Struct("<HIQQ")
_SPAN = struct.Struct("<QQ")
"""What a chunk begins with: log times of its first and last message."""
_CHECKSUM = struct.Struct("<I")

UNFINISHED = "the writer was stopped early, or the end of the file is damaged"
DATA_CHECKSUM = "its data do not match their checksum"
INDEX_CHECKSUM = "its index at the end does not match its checksum"

DAMAGE = (McapError, ZstdError, ValueError, KeyError, RuntimeError, MemoryError, struct.error)
"""Raised by the readers on bytes that are not records."""


class Entry(NamedTuple):
    """One message: channel number, log and publish time in ns, data."""

    channel: int
    stamp: int
    published: int
    data: bytes


class _Block(NamedTuple):
    """A chunk, or a message outside chunks, by the place of its record's body in the file."""

    code: int
    start: int
    length: int
    channels: frozenset[int]  # of its messages


@dataclass
class Records:
    """The content of a file; `faults` say why it is incomplete, and are empty otherwise."""

    path: Path
    library: str = ""
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    attachments: dict[str, bytes] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    counts: Counter[int] = field(default_factory=Counter)  # messages by channel number
    faults: list[str] = field(default_factory=list)
    finished: bool = False
    left_out: set[str] = field(default_factory=set)  # names of damaged attachments
    lost_bytes: int = 0  # in damaged records, and after the last whole one
    blocks: list[_Block] = field(default_factory=list)

    @property
    def fault(self) -> str:
        """All faults in one line."""
        return "; ".join(self.faults)

    def add_fault(self, text: str) -> None:
        """Note what is wrong with the file, once."""
        if text not in self.faults:
            self.faults.append(text)

    def spans(self) -> list[tuple[int, int]]:
        """First and last log time of each block in ns, read from their heads alone.

        Raises:
            LogError: the file is gone.
        """
        found = []
        with self._open() as file:
            for block in self.blocks:
                file.seek(block.start)
                if block.code == Opcode.CHUNK:
                    found.append(_SPAN.unpack(file.read(_SPAN.size)))
                else:
                    stamp = _MESSAGE.unpack(file.read(_MESSAGE.size))[2]
                    found.append((stamp, stamp))
        return found

    def block(self, number: int, channels: set[int]) -> list[Entry]:
        """Messages of these channels in one block, in the order of the file.

        Raises:
            LogError: the file has changed since it was opened, or is gone.
        """
        block = self.blocks[number]
        if block.channels.isdisjoint(channels):
            return []
        try:
            with self._open() as file:
                file.seek(block.start)
                return list(_entries(block.code, file.read(block.length), channels))
        except DAMAGE as fault:
            raise LogError(f"log {self.path}: was changed while it was read") from fault

    def _open(self) -> BinaryIO:
        try:
            return self.path.open("rb")
        except OSError as fault:
            raise LogError(f"log {self.path}: cannot be read: {fault.strerror}") from fault

    def messages(self, channels: set[int] | None = None) -> Iterator[Entry]:
        """Messages of these channels, or of all, in the order of the file.

        Raises:
            LogError: the file has changed since it was opened, or is gone.
        """
        known = set(self.channels)
        wanted = known if channels is None else known & channels
        try:
            with self.path.open("rb") as file:
                for block in self.blocks:
                    if block.channels.isdisjoint(wanted):
                        continue
                    file.seek(block.start)
                    yield from _entries(block.code, file.read(block.length), wanted)
        except OSError as fault:
            raise LogError(f"log {self.path}: cannot be read: {fault.strerror}") from fault
        except DAMAGE as fault:
            raise LogError(f"log {self.path}: was changed while it was read") from fault


def read_records(path: str | Path) -> Records:
    """All records of a file up to its end, or up to where it breaks off.

    Raises:
        LogError: there is no such file, it cannot be read, or it is not an MCAP file.
    """
    records = Records(Path(path))
    try:
        with open(path, "rb") as file:
            _Reader(records, file, os.fstat(file.fileno()).st_size).read()
    except OSError as fault:
        raise LogError(f"log {path}: cannot be read: {fault.strerror}") from fault
    return records


class _Reader:
    """Reads a file from its first to its last byte, with the checksums of its two sections."""

    def __init__(self, records: Records, file: BinaryIO, size: int) -> None:
        self._records, self._file, self._size = records, file, size
        self._checksum = 0
        self._in_data = True
        self._damaged: Counter[str] = Counter()
        self._loose_schemas: dict[int, Schema] = {}
        self._loose_channels: dict[int, Channel] = {}
        self._statistics: Statistics | None = None
        self._sets: dict[frozenset[int], frozenset[int]] = {}

    def read(self) -> None:
        """Fill the records."""
        if self._take(len(form.MAGIC)) != form.MAGIC:
            raise LogError(f"log {self._records.path}: is not an MCAP file")
        self._records.finished = self._read_records() and self._file.read(9) == form.MAGIC
        if not self._records.finished:
            self._records.add_fault(UNFINISHED)
        for what, count in self._damaged.items():
            self._records.add_fault(f"{count} of its {what} are damaged and left out")
        self._settle_loose()
        self._check_channels()
        self._check_counts()
        _check_attachments(self._records)

    def _take(self, length: int) -> bytes:
        data = self._file.read(length)
        self._checksum = zlib.crc32(data, self._checksum)
        return data

    def _read_records(self) -> bool:
        """Whether the file has its end; every record goes to the method of its kind."""
        while True:
            before = self._checksum
            head = self._take(form.HEAD.size)
            code, length = form.HEAD.unpack(head) if len(head) == form.HEAD.size else (0, 0)
            start = self._file.tell()
            if not code or length > self._size - start:
                self._records.lost_bytes += self._size - start + len(head)
                return False
            body = self._take(length)
            if code == Opcode.FOOTER:
                self._end_index(head, body, before)
                return not self._in_data
            if code == Opcode.DATA_END and self._in_data:
                self._end_data(body, before)
            else:
                self._keep(code, start, body)

    def _keep(self, code: int, start: int, body: bytes) -> None:
        kind = _KINDS.get(code, "")
        try:
            if not self._in_data:
                if code == Opcode.STATISTICS:
                    self._statistics = Statistics.read(stream_of(body))
            elif code in _DESCRIPTIONS:
                self._loose(code, body)
            elif code in _METHODS:
                _METHODS[code](self, start, body)
        except DAMAGE:
            self._damaged[kind] += 1
            self._records.lost_bytes += len(body)

    def _end_data(self, body: bytes, checksum: int) -> None:
        self._in_data, self._checksum = False, 0
        try:
            expected = DataEnd.read(stream_of(body)).data_section_crc
        except DAMAGE:
            expected = ~checksum
        if expected not in (0, checksum):
            self._records.add_fault(DATA_CHECKSUM)

    def _end_index(self, head: bytes, body: bytes, before: int) -> None:
        try:
            expected = Footer.read(stream_of(body)).summary_crc
        except DAMAGE:
            expected = -1
        covered = zlib.crc32(head + body[: -_CHECKSUM.size], before)
        if expected not in (0, covered):
            self._records.add_fault(INDEX_CHECKSUM)

    def _header(self, _: int, body: bytes) -> None:
        self._records.library = Header.read(stream_of(body)).library

    def _chunk(self, start: int, body: bytes) -> None:
        data = unpacked(Chunk.read(stream_of(body)))
        found, counts = [], Counter[int]()
        for code, begin, end in walk(data):
            if code == Opcode.MESSAGE:
                counts[_MESSAGE.unpack_from(data, begin)[0]] += 1
            elif code in _DESCRIPTIONS:
                found.append(_DESCRIPTIONS[code](stream_of(data[begin:end])))
        for one in found:
            self._describe(one, self._records.schemas, self._records.channels)
        self._records.counts += counts
        block = _Block(Opcode.CHUNK, start, len(body), self._same(frozenset(counts)))
        self._records.blocks.append(block)

    def _message(self, start: int, body: bytes) -> None:
        channel = _MESSAGE.unpack_from(body)[0]
        self._records.counts[channel] += 1
        block = _Block(Opcode.MESSAGE, start, len(body), self._same(frozenset((channel,))))
        self._records.blocks.append(block)

    def _same(self, channels: frozenset[int]) -> frozenset[int]:
        """One object for all blocks of the same channels."""
        return self._sets.setdefault(channels, channels)

    def _loose(self, code: int, body: bytes) -> None:
        one = _DESCRIPTIONS[code](stream_of(body))
        self._describe(one, self._loose_schemas, self._loose_channels)

    def _describe(
        self, one: Schema | Channel, schemas: dict[int, Schema], channels: dict[int, Channel]
    ) -> None:
        """Keep a schema or a channel; the first description of a number counts."""
        known: dict = schemas if isinstance(one, Schema) else channels
        if known.setdefault(one.id, one) != one:
            kind = "schema" if isinstance(one, Schema) else "channel"
            self._records.add_fault(f"its {kind} number {one.id} is described in two ways")

    def _attachment(self, _: int, body: bytes) -> None:
        found = Attachment.read(stream_of(body))
        (checksum,) = _CHECKSUM.unpack(body[-_CHECKSUM.size :])
        if checksum not in (0, zlib.crc32(body[: -_CHECKSUM.size])):
            self._records.left_out.add(found.name)
            raise ValueError
        if self._records.attachments.setdefault(found.name, found.data) != found.data:
            self._records.add_fault(f"it has two attachments {found.name!r}")

    def _metadata(self, _: int, body: bytes) -> None:
        found = Metadata.read(stream_of(body))
        values = seal.unsealed(found.metadata)
        if values is None:
            raise ValueError
        if found.name == seal.ATTACHMENTS:  # the last one has them all
            self._records.metadata[found.name] = values
        elif self._records.metadata.setdefault(found.name, values) != values:
            self._records.add_fault(f"it has two metadata records {found.name!r}")

    def _settle_loose(self) -> None:
        """Take what stands outside chunks, unless it may be part of something damaged."""
        records = self._records
        chunked = any(block.code == Opcode.CHUNK for block in records.blocks)
        if chunked and DATA_CHECKSUM in records.faults:
            kept = [block for block in records.blocks if block.code == Opcode.CHUNK]
            records.blocks = kept
            return
        loose: list[Schema | Channel] = [*self._loose_schemas.values()]
        loose += self._loose_channels.values()
        for one in loose:
            self._describe(one, records.schemas, records.channels)

    def _check_channels(self) -> None:
        records = self._records
        for number, channel in list(records.channels.items()):
            if channel.schema_id and channel.schema_id not in records.schemas:
                records.add_fault(f"its topic {channel.topic} has no definition and is left out")
                del records.channels[number]
        lost = sum(n for number, n in records.counts.items() if number not in records.channels)
        if lost:
            records.add_fault(f"{lost} messages belong to no topic and are left out")

    def _check_counts(self) -> None:
        """Compare the messages with what the index says, where there is an index."""
        if self._statistics is None or INDEX_CHECKSUM in self._records.faults:
            return
        stated = Counter(self._statistics.channel_message_counts)
        if stated and stated != +self._records.counts:
            told, there = self._statistics.message_count, self._records.counts.total()
            self._records.add_fault(f"its index counts {told} messages, and {there} are there")


_DESCRIPTIONS: dict[int, Callable[[ReadDataStream], Schema | Channel]] = {
    Opcode.SCHEMA: Schema.read,
    Opcode.CHANNEL: Channel.read,
}
_METHODS: dict[int, Callable[[_Reader, int, bytes], None]] = {
    Opcode.HEADER: _Reader._header,
    Opcode.CHUNK: _Reader._chunk,
    Opcode.MESSAGE: _Reader._message,
    Opcode.ATTACHMENT: _Reader._attachment,
    Opcode.METADATA: _Reader._metadata,
}
_KINDS: dict[int, str] = {
    Opcode.HEADER: "headers",
    Opcode.CHUNK: "chunks",
    Opcode.MESSAGE: "messages",
    Opcode.SCHEMA: "schemas",
    Opcode.CHANNEL: "channels",
    Opcode.ATTACHMENT: "attachments",
    Opcode.METADATA: "metadata records",
    Opcode.STATISTICS: "statistics",
}


def _check_attachments(records: Records) -> None:
    """Compare the attachments with the list of those that were written, where there is one."""
    for name, digest in records.metadata.pop(seal.ATTACHMENTS, {}).items():
        if name not in records.attachments:
            if name not in records.left_out:
                records.add_fault(f"its attachment {name!r} is missing")
        elif seal.digest(records.attachments[name]) != digest:
            records.add_fault(f"its attachment {name!r} is not the one that was recorded")
            records.left_out.add(name)
            del records.attachments[name]


def _entries(code: int, body: bytes, wanted: set[int]) -> Iterator[Entry]:
    if code == Opcode.MESSAGE:
        channel, _, stamp, published = _MESSAGE.unpack_from(body)
        if channel in wanted:
            yield Entry(channel, stamp, published, body[_MESSAGE.size :])
        return
    data = unpacked(Chunk.read(stream_of(body)))
    for inner, start, end in walk(data):
        if inner == Opcode.MESSAGE:
            channel, _, stamp, published = _MESSAGE.unpack_from(data, start)
            if channel in wanted:
                yield Entry(channel, stamp, published, data[start + _MESSAGE.size : end])
