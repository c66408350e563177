"""Records of an MCAP file as bytes: what the writer puts down (https://mcap.dev/spec).

The mcap package's own writer keeps an object with a dictionary for every chunk until the end, which
is 43 MiB per simulated hour; `log.index` keeps the same in a few bytes.
"""

import struct
import zlib
from collections.abc import Mapping

from mcap.opcode import Opcode
from mcap.writer import MCAP0_MAGIC as MAGIC

MESSAGE = struct.Struct("<BQHIQQ")
"""Opcode, length, channel, sequence, log time, publish time; the data follow."""
MESSAGE_FIXED = 22
"""Bytes of a message's record besides its data."""
HEAD = struct.Struct("<BQ")
"""Opcode and length of every record."""
FOOTER = struct.Struct("<BQQQ")
"""Footer without its checksum, which covers the other fields."""
FOOTER_LENGTH = 20


def record(code: int, *parts: bytes) -> bytes:
    """One record: opcode, length and the parts of its body."""
    body = b"".join(parts)
    return HEAD.pack(code, len(body)) + body


def text(value: str) -> bytes:
    """A string with its length."""
    raw = value.encode()
    return struct.pack("<I", len(raw)) + raw


def block(data: bytes) -> bytes:
    """Bytes with their length in 64 bit."""
    return struct.pack("<Q", len(data)) + data


def table(values: Mapping[str, str]) -> bytes:
    """A map from string to string, with its length in bytes."""
    body = b"".join(text(key) + text(value) for key, value in values.items())
    return struct.pack("<I", len(body)) + body


def header(profile: str, library: str) -> bytes:
    """The first record of a file."""
    return record(Opcode.HEADER, text(profile), text(library))


def schema(number: int, name: str, encoding: str, data: bytes) -> bytes:
    """Definition of a type."""
    size = struct.pack("<I", len(data))
    return record(Opcode.SCHEMA, struct.pack("<H", number), text(name), text(encoding), size, data)


def channel(number: int, of: int, topic: str, encoding: str, metadata: Mapping[str, str]) -> bytes:
    """A topic with the number of its schema."""
    head = struct.pack("<HH", number, of)
    return record(Opcode.CHANNEL, head, text(topic), text(encoding), table(metadata))


def attachment(name: str, media_type: str, data: bytes) -> bytes:
    """A small file, with the checksum over all its fields."""
    body = b"".join((struct.pack("<QQ", 0, 0), text(name), text(media_type), block(data)))
    return record(Opcode.ATTACHMENT, body, struct.pack("<I", zlib.crc32(body)))


def attachment_index(offset: int, length: int, size: int, name: str, media_type: str) -> bytes:
    """Where an attachment is."""
    numbers = struct.pack("<QQQQQ", offset, length, 0, 0, size)
    return record(Opcode.ATTACHMENT_INDEX, numbers, text(name), text(media_type))


def metadata(name: str, values: Mapping[str, str]) -> bytes:
    """Names and values."""
    return record(Opcode.METADATA, text(name), table(values))


def metadata_index(offset: int, length: int, name: str) -> bytes:
    """Where a metadata record is."""
    return record(Opcode.METADATA_INDEX, struct.pack("<QQ", offset, length), text(name))


def data_end(checksum: int) -> bytes:
    """The end of the data, with the checksum over everything before it."""
    return record(Opcode.DATA_END, struct.pack("<I", checksum))


def summary_offset(code: int, start: int, length: int) -> bytes:
    """Where the summary has the records of one kind."""
    return record(Opcode.SUMMARY_OFFSET, struct.pack("<BQQ", code, start, length))


def footer(start: int, offsets: int, checksum_before: int) -> bytes:
    """The last record; its checksum continues that over the summary."""
    fixed = FOOTER.pack(Opcode.FOOTER, FOOTER_LENGTH, start, offsets)
    return fixed + struct.pack("<I", zlib.crc32(fixed, checksum_before))


__all__ = ["MAGIC", "Opcode"]
