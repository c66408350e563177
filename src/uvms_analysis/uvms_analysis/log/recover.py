"""Make a complete, indexed log from one whose writer was stopped."""

from dataclasses import dataclass
from pathlib import Path

from uvms_analysis.errors import LogError
from uvms_analysis.log.records import read_records
from uvms_analysis.log.writer import LogWriter


@dataclass(frozen=True)
class Recovery:
    """Number of messages copied, and what was wrong with the source."""

    message_count: int
    fault: str


def recover(source: str | Path, target: str | Path) -> Recovery:
    """Copy all complete chunks, attachments and metadata of a log into a new file.

    Raises:
        LogError: the source cannot be read or is the target itself.
    """
    if Path(source).resolve() == Path(target).resolve():
        raise LogError(f"log {source}: cannot be recovered into itself; name another file")
    records = read_records(source)
    with LogWriter(target) as log:
        for name, data in records.attachments.items():
            log.attach(name, data)
        for name, values in records.metadata.items():
            log.metadata(name, values)
        types = {}
        for number, channel in records.channels.items():
            schema = records.schemas[channel.schema_id]
            log.copy_channel(channel.topic, schema.name, schema.data, channel.metadata)
            types[number] = channel.topic, schema.name
        for number, stamp, data in records.messages():
            topic, type_name = types[number]
            log.write(topic, type_name, "", stamp, data)
        return Recovery(log.message_count, records.fault)
