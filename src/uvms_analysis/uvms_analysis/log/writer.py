"""Write a run to MCAP in the format of rosbag2, safe against being killed.

The writer is the mcap package's; mcap_ros2's would encode each message anew, many times slower than
`uvms_core.cdr` does, and both lose what they have buffered when the process is killed.
"""

import os
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType

from mcap.writer import CompressionType, Writer

from uvms_analysis.errors import LogError
from uvms_analysis.log import schema

CHUNK_SIZE = 32 * 1024
"""Bytes of messages in a chunk; a writer that is killed loses at most this much."""

LIBRARY = "uvms"


class _Unbuffered:
    """A file that passes every write to the system at once, so that a killed process loses none."""

    def __init__(self, path: Path) -> None:
        self._descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o644)
        self._position = 0

    def write(self, data: bytes) -> int:
        view = memoryview(data)
        while len(view):
            view = view[os.write(self._descriptor, view) :]
        self._position += len(data)
        return len(data)

    def tell(self) -> int:
        return self._position

    def close(self) -> None:
        os.close(self._descriptor)


class LogWriter:
    """Messages in CDR to an MCAP file that rosbag2, Foxglove and PlotJuggler open.

    Log time and publish time are both the stamp in simulation time. Attachments and metadata go to
    the file at once, messages with every full chunk. A context manager; `close` writes the index.

    Raises:
        LogError: the file cannot be made.
    """

    def __init__(self, path: str | Path, chunk_size: int = CHUNK_SIZE) -> None:
        self.path = Path(path)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = _Unbuffered(self.path)
        except OSError as fault:
            raise LogError(f"log {path}: cannot be written: {fault.strerror}") from fault
        self._writer = Writer(
            self._file,  # type: ignore[arg-type]
            chunk_size=chunk_size,
            compression=CompressionType.ZSTD,
        )
        self._writer.start(profile=schema.PROFILE, library=LIBRARY)
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, tuple[int, str]] = {}
        self._open = True
        self.message_count = 0

    def attach(self, name: str, data: str | bytes, media_type: str = "text/plain") -> None:
        """Put a small file into the log."""
        raw = data.encode() if isinstance(data, str) else data
        self._writer.add_attachment(0, 0, name, media_type, raw)

    def metadata(self, name: str, values: Mapping[str, object]) -> None:
        """Put a record of names and values into the log."""
        self._writer.add_metadata(name, {key: str(value) for key, value in values.items()})

    def write(self, topic: str, type_name: str, qos_yaml: str, stamp: int, data: bytes) -> None:
        """One message: CDR bytes as received, at a stamp in nanoseconds."""
        channel = self._channels.get(topic)
        if channel is None:
            channel = self._register(topic, type_name, qos_yaml)
        elif channel[1] != type_name:
            raise LogError(f"log {self.path}: {topic} is {channel[1]}, not {type_name}")
        self._writer.add_message(channel[0], stamp, data, stamp)
        self.message_count += 1

    def _register(self, topic: str, type_name: str, qos: str) -> tuple[int, str]:
        self._copy_schema(type_name, lambda: schema.schema_text(type_name).encode())
        metadata = schema.channel_metadata(type_name, qos)
        return self._add_channel(topic, type_name, metadata)

    def _copy_schema(self, type_name: str, text) -> None:
        if type_name not in self._schemas:
            self._schemas[type_name] = self._writer.register_schema(
                type_name, schema.ENCODING, text()
            )

    def _add_channel(
        self, topic: str, type_name: str, metadata: Mapping[str, str]
    ) -> tuple[int, str]:
        number = self._writer.register_channel(
            topic, schema.MESSAGE_ENCODING, self._schemas[type_name], dict(metadata)
        )
        self._channels[topic] = (number, type_name)
        return self._channels[topic]

    def copy_channel(
        self, topic: str, type_name: str, text: bytes, metadata: Mapping[str, str]
    ) -> None:
        """Register a channel as another log describes it; its type need not be installed."""
        if topic not in self._channels:
            self._copy_schema(type_name, lambda: text)
            self._add_channel(topic, type_name, metadata)

    def close(self) -> None:
        """Write the last chunk and the index, and close the file."""
        if self._open:
            self._open = False
            self._writer.finish()
            self._file.close()

    def __enter__(self) -> "LogWriter":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
