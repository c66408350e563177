"""Write a run to MCAP in the format of rosbag2, safe against being killed.

Records are encoded here (`mcap_format`): mcap_ros2's writer would encode each message anew, many
times slower than `uvms_core.cdr` does, and the mcap package's own grows with every chunk.
"""

import struct
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

from mcap.opcode import Opcode

from uvms_analysis.errors import LogError
from uvms_analysis.log import mcap_format as form
from uvms_analysis.log import schema, seal
from uvms_analysis.log.bag_metadata import Bag, BagTopic, write_bag_metadata
from uvms_analysis.log.chunk import OpenChunk
from uvms_analysis.log.file import LogFile
from uvms_analysis.log.index import ChunkNotes

CHUNK_SIZE = 32 * 1024
"""Bytes of messages in a chunk; a writer that is killed loses at most this much."""

LIBRARY = "uvms"


@dataclass
class _Channel:
    number: int
    type: str
    metadata: dict[str, str]
    count: int = 0


@dataclass
class _Summary:
    """What the end of the file says about the rest of it, kind by kind."""

    schemas: list[bytes] = field(default_factory=list)
    channels: list[bytes] = field(default_factory=list)
    attachments: list[bytes] = field(default_factory=list)
    metadata: list[bytes] = field(default_factory=list)
    chunks: ChunkNotes = field(default_factory=ChunkNotes)
    chunk_count: int = 0
    first: int | None = None
    last: int = 0


class LogWriter:
    """Messages in CDR to an MCAP file that rosbag2, Foxglove and PlotJuggler open.

    Log time is the stamp in simulation time, publish time that on the wall. Attachments and
    metadata go to the file at once, messages with every full chunk. A context manager; `close`
    writes the index, and `metadata.yaml` beside the log, with which its folder is a bag of rosbag2.

    Args:
        path: of the file; its folder is made.
        chunk_size: bytes of messages in a chunk.
        overwrite: whether a file of that name may be replaced.

    Raises:
        LogError: the file exists, or it cannot be written. Once a write has failed every further
            one fails with the same reason, and `close` leaves the log as a killed writer would.
    """

    def __init__(
        self, path: str | Path, chunk_size: int = CHUNK_SIZE, overwrite: bool = False
    ) -> None:
        self.path = Path(path)
        self._file = LogFile(self.path, overwrite)
        self._chunk_size = chunk_size
        self._chunk = OpenChunk()
        self._summary = _Summary()
        self._digests: dict[str, str] = {}
        self._sealed = 0
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, _Channel] = {}
        self._fault: LogError | None = None
        self._open = True
        self.message_count = 0
        self._put(form.MAGIC + form.header(schema.PROFILE, LIBRARY))

    @property
    def counts(self) -> dict[str, int]:
        """Number of messages so far by full topic name."""
        return {topic: channel.count for topic, channel in self._channels.items()}

    def attach(self, name: str, data: str | bytes, media_type: str = "text/plain") -> None:
        """Put a small file into the log."""
        raw = data.encode() if isinstance(data, str) else data
        record = form.attachment(name, media_type, raw)
        place = self._file.position, len(record)
        self._put(record)
        self._digests[name] = seal.digest(raw)
        index = form.attachment_index(*place, len(raw), name, media_type)
        self._summary.attachments.append(index)

    def metadata(self, name: str, values: Mapping[str, object]) -> None:
        """Put a record of names and values into the log, with a checksum of its own."""
        texts = seal.sealed({key: str(value) for key, value in values.items()})
        record = form.metadata(name, texts)
        place = self._file.position, len(record)
        self._put(record)
        self._summary.metadata.append(form.metadata_index(*place, name))

    def write(
        self,
        topic: str,
        type_name: str,
        qos_yaml: str,
        stamp: int,
        data: bytes,
        publish_time: int | None = None,
    ) -> None:
        """One message: CDR bytes as received, at a stamp in nanoseconds.

        Args:
            publish_time: ns since the epoch; None: now, by the clock on the wall.
        """
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._register(topic, type_name, qos_yaml)
        elif channel.type != type_name:
            raise LogError(f"log {self.path}: {topic} is {channel.type}, not {type_name}")
        if not 0 <= stamp < _TOO_LATE:
            raise LogError(f"log {self.path}: {topic}: the stamp {stamp} ns cannot be recorded")
        wall = time.time_ns() if publish_time is None else publish_time
        self._chunk.add(channel.number, channel.count & _SEQUENCE, (stamp, wall), data)
        channel.count += 1
        self.message_count += 1
        self._note_time(stamp)
        if len(self._chunk) > self._chunk_size:
            self._end_chunk()

    def _note_time(self, stamp: int) -> None:
        summary = self._summary
        if summary.first is None or stamp < summary.first:
            summary.first = stamp
        if stamp > summary.last:
            summary.last = stamp

    def _register(self, topic: str, type_name: str, qos: str) -> _Channel:
        self._add_schema(type_name, lambda: schema.schema_text(type_name).encode())
        return self._add_channel(topic, type_name, schema.channel_metadata(type_name, qos))

    def _add_schema(self, type_name: str, text: Callable[[], bytes]) -> None:
        if type_name not in self._schemas:
            number = self._schemas[type_name] = len(self._schemas) + 1
            record = form.schema(number, type_name, schema.ENCODING, text())
            self._summary.schemas.append(record)
            self._chunk.describe(record)

    def _add_channel(self, topic: str, type_name: str, metadata: Mapping[str, str]) -> _Channel:
        channel = _Channel(len(self._channels) + 1, type_name, dict(metadata))
        number = channel.number, self._schemas[type_name]
        record = form.channel(*number, topic, schema.MESSAGE_ENCODING, metadata)
        self._summary.channels.append(record)
        self._chunk.describe(record)
        self._channels[topic] = channel
        return channel

    def copy_channel(
        self, topic: str, type_name: str, text: bytes, metadata: Mapping[str, str]
    ) -> None:
        """Register a channel as another log describes it; its type need not be installed."""
        if topic not in self._channels:
            self._add_schema(type_name, lambda: text)
            self._add_channel(topic, type_name, metadata)

    def _put(self, data: bytes) -> None:
        if self._fault is not None:
            raise LogError(str(self._fault))
        try:
            self._file.write(data)
        except LogError as fault:
            self._fault = fault
            raise

    def _end_chunk(self) -> None:
        self._seal_attachments()
        self._put(self._chunk.take(self._file.position, self._summary.chunks))
        self._summary.chunk_count += 1

    def _seal_attachments(self) -> None:
        """Say which attachments there are, so that none can be taken away or swapped unseen."""
        if len(self._digests) > self._sealed:
            self._sealed = len(self._digests)
            self.metadata(seal.ATTACHMENTS, self._digests)

    def close(self) -> None:
        """Write the last chunk, the index and the folder's `metadata.yaml`, and close the file.

        Raises:
            LogError: one of them cannot be written; the file is closed in any case.
        """
        if not self._open:
            return
        self._open = False
        try:
            if self._fault is None:
                self._finish()
        finally:
            self._file.close()
        if self._fault is None:
            write_bag_metadata(self.path, self._bag())

    def _finish(self) -> None:
        if self._chunk:
            self._end_chunk()
        self._seal_attachments()
        self._put(form.data_end(self._file.checksum))
        start = self._file.position
        self._file.checksum = 0  # from here on: of the summary
        offsets = [
            self._group(Opcode.SCHEMA, self._summary.schemas),
            self._group(Opcode.CHANNEL, self._summary.channels),
            self._group(Opcode.STATISTICS, [self._statistics()]),
            self._group(Opcode.CHUNK_INDEX, self._summary.chunks.records()),
            self._group(Opcode.ATTACHMENT_INDEX, self._summary.attachments),
            self._group(Opcode.METADATA_INDEX, self._summary.metadata),
        ]
        place = self._file.position
        self._put(b"".join(offsets))
        self._put(form.footer(start, place, self._file.checksum) + form.MAGIC)

    def _group(self, code: int, records: Iterable[bytes]) -> bytes:
        """Write the summary's records of one kind; returns where they are."""
        start = self._file.position
        for data in records:
            self._put(data)
        length = self._file.position - start
        return form.summary_offset(code, start, length) if length else b""

    def _statistics(self) -> bytes:
        summary = self._summary
        counts = b"".join(struct.pack("<HQ", c.number, c.count) for c in self._channels.values())
        numbers = struct.pack(
            "<QHIIIIQQI",
            self.message_count,
            len(summary.schemas),
            len(summary.channels),
            len(summary.attachments),
            len(summary.metadata),
            summary.chunk_count,
            summary.first or 0,
            summary.last,
            len(counts),
        )
        return form.record(Opcode.STATISTICS, numbers, counts)

    def _bag(self) -> Bag:
        first = self._summary.first or 0
        topics = [BagTopic(name, c.type, c.count, c.metadata) for name, c in self._channels.items()]
        return Bag(first, max(self._summary.last - first, 0), topics)

    def __enter__(self) -> "LogWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            self.close()
        except LogError:
            if kind is None:  # else the first error is the one to tell
                raise


_TOO_LATE = 2**63
"""A time in ns beyond what rosbag2 can hold."""
_SEQUENCE = 2**32 - 1
