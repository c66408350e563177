"""Reads a log topic by topic, as signals or as numpy arrays over time."""

from array import array
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from uvms_analysis.errors import LogError
from uvms_analysis.log import goal_file, run_end
from uvms_analysis.log.definition import UNDECODABLE, log_codec, same_definition
from uvms_analysis.log.records import Entry, Records, read_records
from uvms_analysis.log.run_end import RunEnd
from uvms_core import topics
from uvms_core.cdr import Codec
from uvms_core.diagnostics import Status
from uvms_core.errors import VehicleFileError
from uvms_core.messages import from_message
from uvms_core.signals import NANOSECONDS, Array, PathGoal
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.loader import vehicle_from_yaml
from uvms_core.yaml_text import parse_yaml

RUN = "uvms"
"""Name of the metadata record about the run."""

PLANT_VEHICLE = "plant_vehicle.yaml"
"""Attachment with the plant's own vehicle, where it is not the nominal one."""

_UNIQUE_NAMES = (topics.TRUE_ODOMETRY, topics.THRUSTER_COMMAND, topics.WRENCH_COMMAND, topics.IMU)
"""Topics that reveal the namespace: no other topic's name ends like theirs."""


class Series:
    """Signals of one topic over time: `stamps` (k,) in ns, `time` in s, an array per field.

    `name` says in messages what they are.
    """

    def __init__(
        self, stamps: np.ndarray, columns: dict[str, np.ndarray], name: str = "a series"
    ) -> None:
        self.name = name
        self.stamps = stamps
        self.time: Array = stamps / NANOSECONDS
        self._columns = columns

    def __getattr__(self, name: str) -> np.ndarray:
        try:
            return self.__dict__["_columns"][name]
        except KeyError:
            raise AttributeError(f"no field {name!r} in {', '.join(self._columns)}") from None

    def __len__(self) -> int:
        return len(self.time)

    def take(self, index: np.ndarray) -> "Series":
        """The series at these indices."""
        columns = {key: of[index] for key, of in self._columns.items()}
        return Series(self.stamps[index], columns, self.name)


class RunLog:
    """A log in memory, unpacked and decoded on demand.

    `fault` is empty, or says why the log is incomplete; everything before the break can be read.
    Messages that are not valid signals (such as a NaN in a command) are left out and counted in
    `rejected`; topics that are not what their name says are left out, too: `unusable` says why.
    """

    def __init__(self, records: Records) -> None:
        self._records = records
        self.path = records.path
        self.faults = tuple(records.faults)
        self.fault = records.fault
        self.finished = records.finished
        self.attachments = records.attachments
        self.metadata = records.metadata
        self.rejected: dict[str, list[str]] = {}
        self.unusable: dict[str, str] = {}
        self._numbers: dict[str, list[int]] = {}
        for number, channel in records.channels.items():
            self._numbers.setdefault(channel.topic, []).append(number)
        self._signals: dict[str, list[Any]] = {}
        self._series: dict[str, Series] = {}
        self._read: dict[str, Any] = {}
        self.known_stamps: dict[str, array] = {}
        """Log times by full topic name where they are known beforehand: of these topics `entries`
        need not have every message."""
        self.namespace = self._find_namespace()

    @classmethod
    def open(cls, path: str | Path) -> "RunLog":
        """The log in a file.

        Raises:
            LogError: there is no such file, it cannot be read, or it is not an MCAP file.
        """
        return cls(read_records(path))

    @property
    def records(self) -> Records:
        """The records of the file, for those who look up single instants."""
        return self._records

    @property
    def run(self) -> dict[str, str]:
        """Metadata of the run: scenario, seed, git revision, version, pace, command."""
        return self.metadata.get(RUN, {})

    @property
    def topics(self) -> dict[str, str]:
        """Full names of the topics and their types."""
        return {name: self.channel(name)[0] for name in self._numbers}

    @property
    def counts(self) -> dict[str, int]:
        """Number of messages by full topic name."""
        counts = self._records.counts
        return {name: sum(counts[n] for n in own) for name, own in self._numbers.items()}

    @property
    def end(self) -> RunEnd | None:
        """What is known about the run's end; None where nobody recorded it.

        Raises:
            LogError: the record is damaged.
        """
        record = self.metadata.get(run_end.NAME)
        return None if record is None else RunEnd.from_metadata(record)

    def text(self, name: str) -> str:
        """An attachment as text.

        Raises:
            LogError: the log has none of that name, or it is damaged.
        """
        if name in self._records.left_out and name not in self.attachments:
            raise LogError(f"log {self.path}: its attachment {name!r} is damaged and left out")
        if name not in self.attachments:
            known = ", ".join(self.attachments) or "none"
            raise LogError(f"log {self.path}: has no attachment {name!r}; it has {known}")
        try:
            return self.attachments[name].decode()
        except UnicodeDecodeError as fault:
            raise LogError(
                f"log {self.path}: its attachment {name!r} is damaged: {fault}"
            ) from fault

    def configuration(self) -> dict[str, Any]:
        """The complete configuration of the run.

        Raises:
            LogError: the log has none, or it is damaged.
        """
        return self._once("config.yaml", self._read_configuration)

    @property
    def vehicle(self) -> Vehicle:
        """The vehicle of the run.

        Raises:
            LogError: the log has none, or it is damaged.
        """
        return self._once("vehicle.yaml", lambda: self._read_vehicle("vehicle.yaml"))

    @property
    def plant_vehicle(self) -> Vehicle:
        """The plant's own vehicle, which need not be the one of the nodes; raises as `vehicle`."""
        known = self.attachments.keys() | self._read.keys() | set(self._records.left_out)
        if PLANT_VEHICLE not in known:
            return self.vehicle
        return self._once(PLANT_VEHICLE, lambda: self._read_vehicle(PLANT_VEHICLE))

    @property
    def path_goal(self) -> PathGoal | None:
        """The path that the planner was asked for, None without one.

        Raises:
            LogError: it is damaged.
        """
        name = goal_file.NAME
        if name not in self.attachments and name not in self._records.left_out:
            return None
        return self._once(name, lambda: goal_file.path_from_json(self.text(name)))

    def _once(self, name: str, read: Callable[[], Any]) -> Any:
        """What an attachment says; it is read once, even where that fails, which takes long."""
        if name not in self._read:
            try:
                self._read[name] = read()
            except LogError as fault:
                self._read[name] = fault
        if isinstance(self._read[name], LogError):
            raise LogError(str(self._read[name]))
        return self._read[name]

    def _read_configuration(self) -> dict[str, Any]:
        what = f"log {self.path}: its attachment 'config.yaml'"
        values = parse_yaml(self.text("config.yaml"), what, LogError)
        if not isinstance(values, dict):
            raise LogError(f"{what} is not a mapping of names to values")
        return values

    def _read_vehicle(self, name: str) -> Vehicle:
        what = f"log {self.path}: its attachment {name!r}"
        try:
            return vehicle_from_yaml(self.text(name), what)
        except VehicleFileError as fault:
            raise LogError(str(fault)) from fault

    def has(self, topic: Topic) -> bool:
        """Whether there is a channel of the topic."""
        return self.full_name(topic) in self._numbers

    def full_name(self, topic: Topic) -> str:
        """The topic's name in this log."""
        return topic.resolve(self.namespace)

    def raw(self, names: Sequence[str] | None = None) -> Iterator[tuple[str, int, bytes]]:
        """Full topic name, stamp and CDR bytes of messages in the order of the file."""
        for name, entry in self.entries(names):
            yield name, entry.stamp, entry.data

    def entries(self, names: Sequence[str] | None = None) -> Iterator[tuple[str, Entry]]:
        """Full topic name and message, with both of its times, in the order of the file."""
        wanted = None if names is None else {n for name in names for n in self._known(name)}
        channels = self._records.channels
        for entry in self._records.messages(wanted):
            yield channels[entry.channel].topic, entry

    def channel(self, name: str) -> tuple[str, bytes, dict[str, str]]:
        """Type, schema text and metadata of the channel of a full topic name."""
        channel = self._records.channels[self._known(name)[0]]
        schema = self._records.schemas.get(channel.schema_id)
        if schema is None:  # MCAP allows channels without one
            return "", b"", dict(channel.metadata)
        return schema.name, schema.data, dict(channel.metadata)

    def codec(self, name: str) -> Codec:
        """The codec of a full topic name, from the log's own definition.

        Raises:
            LogError: the log has no such topic, or its definition cannot be read.
        """
        type_name, text, _ = self.channel(name)
        return log_codec(f"log {self.path}: {name}", type_name, text)

    def signals(self, topic: Topic) -> list[Any]:
        """All signals of a topic, in order.

        Raises:
            LogError: the log has no such topic, or what it has under that name is something else.
        """
        if topic.name not in self._signals:
            self._known(self.full_name(topic))
            self.load([topic])
        if topic.name in self.unusable:
            raise LogError(self.unusable[topic.name])
        return self._signals[topic.name]

    def load(self, wanted: Sequence[Topic]) -> None:
        """Decode several topics in one pass; those that cannot be go to `unusable`."""
        readers = {}
        for topic in wanted:
            if topic.name in self._signals or topic.name in self.unusable:
                continue
            try:
                readers[self.full_name(topic)] = topic, self.decoder(topic)
                self._signals[topic.name] = []
            except LogError as fault:
                self.unusable[topic.name] = str(fault)
        for name, stamp, data in self.raw(list(readers)) if readers else ():
            topic, decode = readers[name]
            try:
                self._signals[topic.name].append(from_message(topic, decode(data)))
            except UNDECODABLE as fault:
                what = f"{stamp / NANOSECONDS:.3f} s: {fault}"
                self.rejected.setdefault(topic.name, []).append(what)

    def is_loaded(self, topic: Topic) -> bool:
        """Whether the topic's signals are decoded already."""
        return topic.name in self._signals

    def own_stamps(self, topic: Topic) -> Sequence[int]:
        """The stamps that the signals of a topic carry, ns."""
        return [one if isinstance(one, int) else one.stamp for one in self.signals(topic)]

    def series(self, topic: Topic) -> Series:
        """A topic over time, each field of its signal in one array.

        Raises:
            LogError: the log has no such topic, or no valid message of it.
        """
        if topic.name not in self._series:
            self._series[topic.name] = self._make_series(topic)
        return self._series[topic.name]

    def _make_series(self, topic: Topic) -> Series:
        signals = self.signals(topic)
        if signals and isinstance(signals[0], int):  # a clock
            return Series(np.array(signals, dtype=np.int64), {}, topic.name)
        if not signals or not is_dataclass(signals[0]):
            raise LogError(f"log {self.path}: has no valid message of {topic.name}")
        names = [field.name for field in fields(signals[0]) if field.name != "stamp"]
        try:
            columns = {name: np.array([getattr(one, name) for one in signals]) for name in names}
        except ValueError as fault:
            raise LogError(
                f"log {self.path}: the messages of {topic.name} differ in size"
            ) from fault
        stamps = np.array([one.stamp for one in signals], dtype=np.int64)
        return Series(stamps, columns, topic.name)

    def statuses(self, node: str) -> list[Status]:
        """Diagnostics of one node; names may have a namespace, or a title after a colon."""
        everything = self.signals(topics.DIAGNOSTICS) if self.has(topics.DIAGNOSTICS) else []
        return [one for one in everything if _node_of(one.name) == node]

    def decoder(self, topic: Topic) -> Any:
        """How to decode the bytes of a topic's messages.

        Raises:
            LogError: the log has no such topic, or what it has under that name is something else.
        """
        name = self.full_name(topic)
        codec, (type_name, text, _) = self.codec(name), self.channel(name)
        if type_name != topic.type:
            raise LogError(f"log {self.path}: {name} is {type_name}, not {topic.type}")
        channels = [self._records.channels[number] for number in self._numbers[name]]
        if len({channel.schema_id for channel in channels}) > 1:
            raise LogError(f"log {self.path}: {name} has messages of more than one type")
        if not same_definition(type_name, text.decode()):
            raise LogError(f"log {self.path}: {name}: its {type_name} is not the one known here")
        return codec.decode

    def _known(self, name: str) -> list[int]:
        if name not in self._numbers:
            known = ", ".join(sorted(self._numbers)) or "nothing"
            raise LogError(f"log {self.path}: has no topic {name}; it has {known}")
        return self._numbers[name]

    def _find_namespace(self) -> str:
        for topic in _UNIQUE_NAMES:
            for name in self._numbers:
                if name.endswith("/" + topic.name):
                    return name.removesuffix(topic.name).strip("/")
        return ""


def _node_of(name: str) -> str:
    return name.split(":")[0].strip().rsplit("/", 1)[-1]
