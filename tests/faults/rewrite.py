"""Write a log anew with something changed in it: every checksum is right, what it says is not."""

from collections.abc import Callable
from pathlib import Path

from uvms_analysis.log.records import Entry, read_records
from uvms_analysis.log.writer import LogWriter

Change = Callable[[list[tuple[str, Entry]]], list[tuple[str, Entry]]]


def rewrite(
    source: Path,
    target: Path,
    attachments: Callable[[dict[str, bytes]], dict[str, bytes]] = lambda same: same,
    metadata: Callable[[dict[str, dict]], dict[str, dict]] = lambda same: same,
    messages: Change = lambda same: same,
    schema: Callable[[str, bytes], tuple[str, bytes]] = lambda topic, text: (topic, text),
) -> Path:
    """Copy a log; each part goes through a function that may change it.

    `schema` is called with a topic and its definition, and gives the new name and definition.
    """
    records = read_records(source)
    channels = records.channels
    named = [(channels[entry.channel].topic, entry) for entry in records.messages()]
    types = {}
    with LogWriter(target) as log:
        for name, data in attachments(dict(records.attachments)).items():
            log.attach(name, data)
        for name, values in metadata(dict(records.metadata)).items():
            log.metadata(name, values)
        for channel in channels.values():
            own = records.schemas[channel.schema_id]
            topic, text = schema(channel.topic, own.data)
            log.copy_channel(topic, own.name, text, channel.metadata)
            types[channel.topic] = topic, own.name
        for topic, entry in messages(named):
            log.write(*types[topic], "", entry.stamp, entry.data, entry.published)
    return target
