"""Make a complete, indexed log from one whose writer was stopped."""

from dataclasses import dataclass
from pathlib import Path

from uvms_analysis.errors import LogError
from uvms_analysis.log.records import Records, read_records
from uvms_analysis.log.writer import LogWriter


@dataclass(frozen=True)
class Recovery:
    """Numbers of what was copied, and what was wrong with the source."""

    message_count: int
    attachments: tuple[str, ...]
    metadata: tuple[str, ...]
    last_stamp: int  # log time of the last message, ns
    kept_bytes: int  # of the source, in whole records
    lost_bytes: int
    fault: str

    def __str__(self) -> str:
        fault = self.fault or "nothing was wrong with it"
        attached = ", ".join(self.attachments) or "none"
        described = ", ".join(self.metadata) or "none"
        return (
            f"source: {fault}\n"
            f"kept: {self.message_count} messages up to {self.last_stamp / 1e9:.3f} s,"
            f" {self.kept_bytes} bytes\n"
            f"attachments: {attached}; metadata: {described}\n"
            f"lost: {self.lost_bytes} bytes"
        )


def recover(source: str | Path, target: str | Path) -> Recovery:
    """Copy all complete chunks, attachments and metadata of a log into a new file.

    Both times of every message are kept. Nothing is made up: a log that says nothing about the
    run's end still says nothing about it.

    Raises:
        LogError: the source cannot be read or is the target itself, or the target exists already.
    """
    if Path(source).resolve() == Path(target).resolve():
        raise LogError(f"log {source}: cannot be recovered into itself; name another file")
    records = read_records(source)
    last = 0
    with LogWriter(target) as log:
        for name, data in records.attachments.items():
            log.attach(name, data)
        for name, values in records.metadata.items():
            log.metadata(name, values)
        types = {number: _copy_channel(log, records, number) for number in records.channels}
        for number, stamp, published, data in records.messages():
            log.write(*types[number], "", stamp, data, published)
            last = stamp
        size = records.path.stat().st_size
        return Recovery(
            log.message_count,
            tuple(records.attachments),
            tuple(records.metadata),
            last,
            size - records.lost_bytes,
            records.lost_bytes,
            records.fault,
        )


def _copy_channel(log: LogWriter, records: Records, number: int) -> tuple[str, str]:
    """Topic and type of a channel, which the new log has from now on, too."""
    channel = records.channels[number]
    schema = records.schemas.get(channel.schema_id)
    name, text = (schema.name, schema.data) if schema else ("", b"")
    log.copy_channel(channel.topic, name, text, channel.metadata)
    return channel.topic, name
