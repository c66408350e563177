"""Ways to damage a log: bit flips in chosen records, cuts, and records moved about."""

import zlib
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from mcap.opcode import Opcode

from uvms_analysis.log import mcap_format as form


class Raw(NamedTuple):
    """A record by its place in the file: opcode, start of its head, end of its body."""

    code: int
    start: int
    end: int


def records_of(data: bytes) -> list[Raw]:
    """All records of an undamaged file."""
    found, position = [], len(form.MAGIC)
    while position < len(data) - len(form.MAGIC):
        code, length = form.HEAD.unpack_from(data, position)
        end = position + form.HEAD.size + length
        found.append(Raw(code, position, end))
        position = end
    return found


def flipped(data: bytes, rng: np.random.Generator, start: int = 0, end: int | None = None) -> bytes:
    """One bit between two places is another."""
    changed = bytearray(data)
    at = int(rng.integers(start, len(data) if end is None else end))
    changed[at] ^= 1 << int(rng.integers(8))
    return bytes(changed)


def flipped_in(data: bytes, code: int, rng: np.random.Generator) -> bytes:
    """One bit in some record of a kind, its head included, is another."""
    records = [record for record in records_of(data) if record.code == code]
    record = records[int(rng.integers(len(records)))]
    return flipped(data, rng, record.start, record.end)


def reassembled(data: bytes, change: Callable[[list[bytes]], Sequence[bytes]]) -> bytes:
    """The records of the data section, changed, with a right checksum and no index at the end."""
    records = records_of(data)
    end = next(k for k, record in enumerate(records) if record.code == Opcode.DATA_END)
    parts = change([data[record.start : record.end] for record in records[:end]])
    body = form.MAGIC + b"".join(parts)
    return body + form.data_end(zlib.crc32(body)) + form.footer(0, 0, 0) + form.MAGIC


def swapped_attachments(data: bytes) -> bytes:
    """The contents of two attachments are exchanged under their names, checksums made anew."""

    def change(parts: list[bytes]) -> list[bytes]:
        places = [k for k, part in enumerate(parts) if part[0] == Opcode.ATTACHMENT]
        first, second = places[:2]
        names = [_name_of(parts[k]) for k in (first, second)]
        contents = [_content_of(parts[k]) for k in (first, second)]
        parts[first] = form.attachment(names[0], "application/yaml", contents[1])
        parts[second] = form.attachment(names[1], "application/yaml", contents[0])
        return parts

    return reassembled(data, change)


def _name_of(part: bytes) -> str:
    body = part[form.HEAD.size + 16 :]
    return body[4 : 4 + int.from_bytes(body[:4], "little")].decode()


def _content_of(part: bytes) -> bytes:
    body = part[form.HEAD.size + 16 :]
    for _ in range(2):  # name and media type
        body = body[4 + int.from_bytes(body[:4], "little") :]
    return body[8 : 8 + int.from_bytes(body[:8], "little")]


def write(path: Path, data: bytes) -> Path:
    """The bytes as a file."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(data)
    return path
