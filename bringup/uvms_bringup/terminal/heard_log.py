"""A log that somebody listens to while it is written."""

from collections.abc import Callable
from pathlib import Path

from uvms_analysis.log.writer import LogWriter

Hear = Callable[[str, int, bytes], None]


class HeardLog(LogWriter):
    """A `LogWriter` that hands every message on to `hear`: topic, stamp in ns, CDR bytes."""

    def __init__(self, path: str | Path, hear: Hear) -> None:
        super().__init__(path)
        self._hear = hear

    def write(
        self,
        topic: str,
        type_name: str,
        qos_yaml: str,
        stamp: int,
        data: bytes,
        publish_time: int | None = None,
    ) -> None:
        """As `LogWriter.write`."""
        super().write(topic, type_name, qos_yaml, stamp, data, publish_time)
        self._hear(topic, stamp, data)
