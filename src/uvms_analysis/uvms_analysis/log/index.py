"""The index of a log while it is written: chunk by chunk, in a few bytes a chunk.

The index of a chunk has one offset for each of its channels. Kept as the lengths of its message
indexes, and compressed in blocks, it takes some 30 bytes: half a MiB per simulated hour.
"""

import struct
from collections.abc import Iterator, Mapping
from typing import NamedTuple

import zstandard
from mcap.opcode import Opcode

from uvms_analysis.log import mcap_format as form

BLOCK_SIZE = 64 * 1024
"""Bytes of notes that are compressed together."""

_FIXED = struct.Struct("<QQQQQQH")
_CHANNEL = struct.Struct("<HI")
_INDEX_HEAD = 15
"""Bytes of a message index besides its entries: opcode, length, channel, length of entries."""


class ChunkPlace(NamedTuple):
    """Where a chunk is: log times in ns, offset and length of its record, sizes of its data."""

    first: int
    last: int
    offset: int
    length: int
    packed_size: int
    size: int


def message_indexes(entries: Mapping[int, bytearray]) -> bytes:
    """The message indexes of a chunk: by channel, log times and offsets, a pair in 16 bytes."""
    return b"".join(
        form.record(Opcode.MESSAGE_INDEX, _CHANNEL.pack(number, len(pairs)), bytes(pairs))
        for number, pairs in entries.items()
    )


class ChunkNotes:
    """What is needed to write the index of every chunk at the end."""

    def __init__(self) -> None:
        self._packed: list[bytes] = []
        self._open = bytearray()
        self._compress = zstandard.ZstdCompressor().compress

    def add(self, place: ChunkPlace, entries: Mapping[int, bytearray]) -> None:
        """One more chunk, with the entries of its message indexes."""
        self._open += _FIXED.pack(*place, len(entries))
        for number, pairs in entries.items():
            self._open += _CHANNEL.pack(number, len(pairs))
        if len(self._open) > BLOCK_SIZE:
            self._packed.append(self._compress(bytes(self._open)))
            self._open.clear()

    def records(self) -> Iterator[bytes]:
        """The indexes of all chunks."""
        expand = zstandard.ZstdDecompressor().decompress
        for block in self._packed:
            yield from _records(expand(block))
        yield from _records(bytes(self._open))


def _records(notes: bytes) -> Iterator[bytes]:
    position = 0
    while position < len(notes):
        *place, count = _FIXED.unpack_from(notes, position)
        position += _FIXED.size
        end = position + count * _CHANNEL.size
        yield _record(ChunkPlace(*place), notes[position:end])
        position = end


def _record(place: ChunkPlace, channels: bytes) -> bytes:
    """The index of a chunk; its message indexes follow it in the order of the channels."""
    after = start = place.offset + place.length
    offsets = bytearray()
    for number, length in _CHANNEL.iter_unpack(channels):
        offsets += struct.pack("<HQ", number, after)
        after += _INDEX_HEAD + length
    return form.record(
        Opcode.CHUNK_INDEX,
        struct.pack("<QQQQI", *place[:4], len(offsets)),
        bytes(offsets),
        struct.pack("<Q", after - start),
        form.text("zstd"),
        struct.pack("<QQ", place.packed_size, place.size),
    )
