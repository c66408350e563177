"""The content of a chunk: its data, and the records in them."""

from collections.abc import Iterator
from io import BytesIO

from mcap.data_stream import ReadDataStream
from mcap.records import Chunk
from mcap.stream_reader import get_chunk_data_stream

from uvms_analysis.log import mcap_format as form


def stream_of(body: bytes) -> ReadDataStream:
    """The body of a record, for the readers of the mcap package."""
    return ReadDataStream(BytesIO(body))


def unpacked(chunk: Chunk) -> bytes:
    """The records in a chunk.

    Raises:
        ValueError, McapError, ZstdError, ...: it is damaged.
    """
    stream, length = get_chunk_data_stream(chunk, validate_crc=True)
    if length != chunk.uncompressed_size:
        raise ValueError(f"a chunk of {chunk.uncompressed_size} bytes has {length}")
    return stream.read(length)


def walk(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Opcode, start and end of every record in an unpacked chunk.

    Raises:
        ValueError, struct.error: a record reaches beyond the end.
    """
    position, end = 0, len(data)
    while position < end:
        code, length = form.HEAD.unpack_from(data, position)
        start = position + form.HEAD.size
        position = start + length
        if position > end:
            raise ValueError(f"a record of {length} bytes reaches beyond its chunk")
        yield code, start, position
