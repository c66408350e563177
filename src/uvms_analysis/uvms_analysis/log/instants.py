"""A log by instants: what was said last at a time, looked up in the file.

Nothing but the times of the blocks is kept, and a few unpacked blocks, so that the first and the
last second of a day are equally near, and a log need not fit into memory.
"""

from bisect import bisect_right
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate
from typing import Any

from uvms_analysis.errors import LogError
from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.records import Entry
from uvms_core.messages import from_message
from uvms_core.signals import NANOSECONDS
from uvms_core.topics import Topic

KEPT = 32
"""Unpacked blocks that are kept: a second of most runs, which playing forward stays within."""


class Instants:
    """The newest signals of some topics at any time of a log.

    Args:
        log: of the run.
        wanted: topics, each with the age in s beyond which a signal of it counts no more. Those
            that the log does not have are left out.

    Raises:
        LogError: the log has no message.
    """

    def __init__(self, log: RunLog, wanted: Mapping[Topic, float]) -> None:
        self._records = log.records
        self._topics: dict[int, tuple[Topic, Callable[[bytes], Any]]] = {}
        self._ages = {topic.name: round(age * NANOSECONDS) for topic, age in wanted.items()}
        for topic in wanted:
            for number in _channels(log, topic):
                self._topics[number] = topic, log.decoder(topic)
        self.names = {topic.name for topic, _ in self._topics.values()}
        spans = self._records.spans()
        if not spans:
            raise LogError(f"log {log.path}: has no message")
        self.first, self.last = spans[0][0], max(last for _, last in spans)
        self._starts = _least_from(spans)
        self._ends = [last for _, last in spans]
        self._blocks: OrderedDict[int, list[Entry]] = OrderedDict()

    def at(self, stamp: int) -> dict[str, Any]:
        """By topic name, the newest signal at or before a log time in ns, where there is one."""
        found: dict[str, Any] = {}
        missing = set(self.names)
        oldest = stamp - max(self._ages.values(), default=0)
        for number in range(bisect_right(self._starts, stamp) - 1, -1, -1):
            if not missing or self._ends[number] < oldest:
                break
            self._search(number, stamp, missing, found)
        return found

    def _search(self, number: int, stamp: int, missing: set[str], found: dict[str, Any]) -> None:
        for entry in reversed(self._block(number)):
            topic, decode = self._topics[entry.channel]
            if entry.stamp > stamp or topic.name not in missing:
                continue
            if entry.stamp < stamp - self._ages[topic.name]:
                missing.discard(topic.name)
                continue
            try:
                found[topic.name] = from_message(topic, decode(entry.data))
            except UNDECODABLE:
                continue  # `uvms check` reports it; here an older one has to do
            missing.discard(topic.name)

    def _block(self, number: int) -> list[Entry]:
        if number in self._blocks:
            self._blocks.move_to_end(number)
            return self._blocks[number]
        entries = self._records.block(number, set(self._topics))
        self._blocks[number] = entries
        if len(self._blocks) > KEPT:
            self._blocks.popitem(last=False)
        return entries


def _least_from(spans: Sequence[tuple[int, int]]) -> list[int]:
    """The earliest time in each block or a later one: increasing, so that it can be searched."""
    firsts = [first for first, _ in reversed(spans)]
    return list(accumulate(firsts, min))[::-1]


def _channels(log: RunLog, topic: Topic) -> list[int]:
    name = log.full_name(topic)
    channels = log.records.channels
    return [number for number, channel in channels.items() if channel.topic == name]
