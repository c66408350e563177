"""A run's log in memory: its signals as they were made, read as those of a file are.

Nothing is encoded but what has to be: of each topic the first message, for its names, and all
diagnostics, whose values become texts in a message. Summary and outcome come out the same as from a
file, which a test holds.
"""

from array import array
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from mcap.records import Channel, Schema

from uvms_analysis.errors import LogError
from uvms_analysis.log import run_end, schema
from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.goal_file import NAME as PATH_FILE
from uvms_analysis.log.read import PLANT_VEHICLE, RunLog
from uvms_analysis.log.records import Entry, Records
from uvms_analysis.log.run_end import RunEnd
from uvms_core import topics
from uvms_core.cdr import Codec, codec
from uvms_core.checks import check
from uvms_core.errors import SignalError
from uvms_core.messages import from_message, to_message
from uvms_core.signals import BY_THRUSTER, NANOSECONDS, PathGoal
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle

NAME = Path("run.mcap")
"""What messages call a log that is no file."""


class _Kept:
    """What is kept of one topic."""

    def __init__(self, topic: Topic, keep: bool) -> None:
        self.topic = topic
        self.codec: Codec = codec(topic.type)
        self.signals: list[Any] | None = [] if keep else None
        self.stamps = array("q")
        self.entries: list[tuple[int, bytes]] = []
        self.rejected: list[str] = []
        self.is_plain = False  # whether all that follow are kept as they are


class MemoryWriter:
    """Takes signals as `SignalWriter` does.

    Args:
        vehicle: its joints and thrusters give the names in messages.
        keep: topics whose signals are wanted afterwards; of others only the stamps stay.
    """

    def __init__(self, vehicle: Vehicle, keep: Sequence[Topic]) -> None:
        self._vehicle = vehicle
        self._keep = {topic.name for topic in keep}
        self._topics: dict[str, _Kept] = {}

    @property
    def counts(self) -> dict[str, int]:
        """Number of messages so far by full topic name."""
        return {kept.topic.resolve(""): len(kept.stamps) for kept in self._topics.values()}

    def write(self, topic: Topic, signal: Any, stamp: int | None = None) -> None:
        """One signal at its own stamp, or at the one given."""
        kept = self._topics.get(topic.name)
        if kept is None or not kept.is_plain:
            self._write_in_full(topic, signal, stamp)
            return
        stamp = signal.stamp if stamp is None else stamp
        kept.stamps.append(stamp)
        try:
            check(topic.name, signal)  # costs nothing where a part has checked it
        except SignalError:
            self._encode(kept, signal, stamp)
            return
        if kept.signals is not None:
            kept.signals.append(signal)

    def _write_in_full(self, topic: Topic, signal: Any, stamp: int | None) -> None:
        """The first signal of a topic, and every one where a message holds more."""
        if stamp is None:
            stamp = signal if topic is topics.CLOCK else signal.stamp
        kept = self._of(topic)
        kept.stamps.append(stamp)
        if topic is not topics.CLOCK or not kept.entries:
            self._encode(kept, signal, stamp)
        kept.is_plain = topic is not topics.CLOCK and topic is not topics.DIAGNOSTICS

    def write_plain(self, topic: Topic, message: dict[str, Any], stamp: int) -> None:
        """One message given as a nested dict: it is counted."""
        self.write_made(topic, stamp, lambda: message)

    def write_made(self, topic: Topic, stamp: int, make: Callable[..., Any], *values: Any) -> None:
        """One message that `make` would make of the values: it is counted."""
        kept = self._topics.get(topic.name) or self._of(topic)
        kept.stamps.append(stamp)
        if not kept.entries:
            kept.entries.append((stamp, kept.codec.encode(make(*values))))

    def _of(self, topic: Topic) -> _Kept:
        kept = self._topics.get(topic.name)
        if kept is None:
            kept = self._topics[topic.name] = _Kept(topic, topic.name in self._keep)
        return kept

    def _encode(self, kept: _Kept, signal: Any, stamp: int) -> None:
        """Through the message, as a log's reader would get it, or refuse it."""
        data = kept.codec.encode(to_message(kept.topic, signal, self._names(signal)))
        kept.entries.append((stamp, data))
        try:
            read = from_message(kept.topic, kept.codec.decode(data))
        except UNDECODABLE as fault:
            kept.rejected.append(f"{stamp / NANOSECONDS:.3f} s: {fault}")
            return
        if kept.signals is not None:
            kept.signals.append(read)

    def _names(self, signal: Any) -> tuple[str, ...]:
        thrusters = isinstance(signal, BY_THRUSTER)
        return self._vehicle.thruster_names if thrusters else self._vehicle.joint_names

    def log(
        self,
        described: Mapping[str, Mapping[str, str]],
        configuration: dict[str, Any],
        goal: Any,
        end: RunEnd,
        plant: Vehicle | None = None,
    ) -> "MemoryLog":
        """The log of what was written.

        Args:
            described: metadata records of the run by name, as a log has them.
            configuration: the scenario as plain data.
            goal: what the planner was asked for.
            end: how the run ended.
            plant: its own vehicle; None where it is the nominal one.
        """
        records = _records(list(self._topics.values()))
        records.metadata |= {name: dict(record) for name, record in described.items()}
        records.metadata[run_end.NAME] = end.to_metadata()
        read = {"config.yaml": configuration, "vehicle.yaml": self._vehicle}
        if isinstance(goal, PathGoal):
            read[PATH_FILE] = goal
        if plant is not None:
            read[PLANT_VEHICLE] = plant
        records.attachments.update(dict.fromkeys(read, b""))
        return MemoryLog(records, list(self._topics.values()), read)


def _records(kept: Sequence[_Kept]) -> Records:
    records = Records(NAME, "uvms", finished=True)
    for number, one in enumerate(kept, start=1):
        kind = one.topic.type
        text = schema.schema_text(kind).encode()
        records.schemas[number] = Schema(id=number, data=text, encoding=schema.ENCODING, name=kind)
        records.channels[number] = Channel(
            id=number,
            topic=one.topic.resolve(""),
            message_encoding=schema.MESSAGE_ENCODING,
            metadata={},
            schema_id=number,
        )
        records.counts[number] = len(one.stamps)
    return records


class MemoryLog(RunLog):
    """A log that was never a file; only the topics that were kept can be read from it."""

    def __init__(self, records: Records, kept: Sequence[_Kept], read: dict[str, Any]) -> None:
        super().__init__(records)
        self._kept = kept
        self._by_name = {one.topic.name: one for one in kept}
        self._read = read
        self._signals = {one.topic.name: one.signals for one in kept if one.signals is not None}
        self.rejected = {one.topic.name: one.rejected for one in kept if one.rejected}
        self.known_stamps = {
            one.topic.resolve(""): one.stamps for one in kept if one.topic is not topics.DIAGNOSTICS
        }

    def entries(self, names: Sequence[str] | None = None) -> Any:
        """Of most topics the first message alone."""
        for number, one in enumerate(self._kept, start=1):
            name = one.topic.resolve("")
            if names is None or name in names:
                for stamp, data in one.entries:
                    yield name, Entry(number, stamp, stamp, data)

    def load(self, wanted: Sequence[Topic]) -> None:
        """Nothing is left to be decoded.

        Raises:
            LogError: a topic was not kept.
        """
        for topic in wanted:
            if topic.name not in self._signals:
                raise LogError(f"log {self.path}: its {topic.name} was not kept")

    def is_loaded(self, topic: Topic) -> bool:
        """Every signal has been checked when it was written."""
        return topic.name in self._by_name

    def own_stamps(self, topic: Topic) -> Any:
        """Signals are kept at their own stamps."""
        return self._by_name[topic.name].stamps
