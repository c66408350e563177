"""The chunk that is being filled: messages as MCAP records, with their index."""

import struct
import zlib

import zstandard
from mcap.opcode import Opcode

from uvms_analysis.log import mcap_format as form
from uvms_analysis.log.index import ChunkNotes, ChunkPlace, message_indexes

_PAIR = struct.Struct("<QQ")


class OpenChunk:
    """Records up to the next write to the file."""

    def __init__(self) -> None:
        self._compress = zstandard.ZstdCompressor().compress
        self._data = bytearray()
        self._entries: dict[int, bytearray] = {}
        self._first, self._last = 0, 0

    def __len__(self) -> int:
        return len(self._data)

    def __bool__(self) -> bool:
        return bool(self._data)

    def describe(self, record: bytes) -> None:
        """Add a schema or a channel."""
        self._data += record

    def add(self, channel: int, sequence: int, times: tuple[int, int], data: bytes) -> None:
        """Add a message with its log and publish time, ns."""
        stamp = times[0]
        if not self._entries:
            self._first = self._last = stamp
        elif stamp < self._first:
            self._first = stamp
        elif stamp > self._last:
            self._last = stamp
        entry = self._entries.get(channel)
        if entry is None:
            entry = self._entries[channel] = bytearray()
        entry += _PAIR.pack(stamp, len(self._data))
        length = form.MESSAGE_FIXED + len(data)
        self._data += form.MESSAGE.pack(Opcode.MESSAGE, length, channel, sequence, *times)
        self._data += data

    def take(self, offset: int, notes: ChunkNotes) -> bytes:
        """The chunk with its message indexes, as bytes for the file at `offset`; it is noted.

        The chunk is empty afterwards.
        """
        data, entries = bytes(self._data), self._entries
        packed, times = self._compress(data), (self._first, self._last)
        record = form.record(
            Opcode.CHUNK,
            struct.pack("<QQQI", *times, len(data), zlib.crc32(data)),
            form.text("zstd"),
            form.block(packed),
        )
        notes.add(ChunkPlace(*times, offset, len(record), len(packed), len(data)), entries)
        record += message_indexes(entries)
        self._data.clear()
        self._entries = {}
        return record
