"""Everything that the checks look at, gathered in one pass over a log."""

import zlib
from array import array
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.errors import LogError
from uvms_analysis.log import run_end
from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_core import topics
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message
from uvms_core.signals import NANOSECONDS
from uvms_core.topic import Topic

NOT_STAMPED = (topics.TF_STATIC, topics.ROBOT_DESCRIPTION, topics.DIAGNOSTICS)
"""Topics whose messages have no stamp of their own, or several signals in one message."""


@dataclass
class Topics:
    """The messages of one topic: log times in ns, checksums of their bytes, what is wrong."""

    type: str
    stamps: array = field(default_factory=lambda: array("q"))
    checksums: array = field(default_factory=lambda: array("L"))
    rejected: list[str] = field(default_factory=list)
    names: tuple[str, ...] | None = None  # of joints or thrusters, in the first message
    moved: int = 0  # messages whose own stamp is not the log time

    @cached_property
    def times(self) -> NDArray[np.int64]:
        """Log times in ns, in the order of the file."""
        return np.array(self.stamps, dtype=np.int64)


class Contents:
    """A log and what its messages are, topic by topic."""

    def __init__(self, log: RunLog) -> None:
        self.log = log
        self.unusable: dict[str, str] = {}
        self.topics = {name: Topics(type_name) for name, type_name in log.topics.items()}
        self._decoded: dict[str, Topic] = {}  # what the log holds as signals already
        self._ours = _topics_of(log)
        self._readers = {
            name: reader for name in self.topics if (reader := self._reader(name)) is not None
        }
        for name, stamps in log.known_stamps.items():
            self.topics[name].stamps.extend(stamps)
        for name, entry in log.entries():
            self._take(name, self.topics[name], entry.stamp, entry.data)
        for name, topic in self._decoded.items():
            self._compare(self.topics[name], topic)

    @cached_property
    def end(self) -> RunEnd | None:
        """What is known about the run's end; None where nobody recorded it, or not readably."""
        try:
            return self.log.end
        except LogError:
            return None

    @property
    def is_ours(self) -> bool:
        """Whether it is the log of a run of this project."""
        return bool(self.log.run) or run_end.NAME in self.log.metadata

    @property
    def is_lockstep(self) -> bool:
        """Whether the plant waited for every command."""
        return not self.log.run.get("pace", "lockstep").startswith("realtime")

    def of(self, topic: Topic) -> Topics | None:
        """The messages of a topic of ours."""
        return self.topics.get(self.log.full_name(topic))

    @cached_property
    def span(self) -> tuple[int, int] | None:
        """First and last stamp in ns: of the clock, or of all messages where there is none."""
        clock = self.of(topics.CLOCK)
        found = [clock] if clock is not None and clock.stamps else list(self.topics.values())
        times = [t.times for t in found if len(t.stamps)]
        if not times:
            return None
        return min(int(t.min()) for t in times), max(int(t.max()) for t in times)

    @property
    def reached_s(self) -> float:
        """Simulated time from the first to the last stamp, s."""
        return 0.0 if self.span is None else (self.span[1] - self.span[0]) / NANOSECONDS

    def _reader(self, name: str):
        """Topic and decoder of a full topic name that is one of ours, else None."""
        log = self.log
        short = name.removeprefix(f"/{log.namespace}/" if log.namespace else "/")
        topic = self._ours.get(name) or self._ours.get(short)
        if topic is None or topic.signal is None or topic is topics.TF:  # which is only written
            return None
        if log.is_loaded(topic) and topic is not topics.DIAGNOSTICS:
            self._decoded[name] = topic
        try:
            return topic, log.decoder(topic)
        except LogError as fault:
            self.unusable[name] = str(fault).removeprefix(f"log {log.path}: {name}").lstrip(": ")
            return None

    def _take(self, name: str, found: Topics, stamp: int, data: bytes) -> None:
        if name not in self.log.known_stamps:
            found.stamps.append(min(stamp, 2**63 - 1))
            found.checksums.append(zlib.crc32(data))
        if name not in self._readers or (found.names is not None and name in self._decoded):
            return  # of what is decoded already, the first message alone, for its names
        topic, decode = self._readers[name]
        try:
            message = decode(data)
            signal = from_message(topic, message)
        except UNDECODABLE as fault:
            if name in self._decoded:
                return
            found.rejected.append(f"{stamp / NANOSECONDS:.3f} s: {fault}")
            return
        if found.names is None:
            found.names = _names(message)
        if topic not in NOT_STAMPED and name not in self._decoded:
            own = signal if isinstance(signal, int) else signal.stamp
            found.moved += own != stamp

    def _compare(self, found: Topics, topic: Topic) -> None:
        """The same for a topic that the log has decoded already."""
        found.rejected = list(self.log.rejected.get(topic.name, ()))
        if topic in NOT_STAMPED or found.rejected:
            return
        own = np.array(self.log.own_stamps(topic), dtype=np.int64)
        found.moved = int(np.sum(own != found.times))


def _names(message: Any) -> tuple[str, ...]:
    """Of joints or thrusters, in a message that has them; else none."""
    for field_name in ("name", "joint_names", "thruster_names"):
        if hasattr(message, field_name):
            return tuple(map(str, getattr(message, field_name)))
    return ()


def _topics_of(log: RunLog) -> dict[str, Topic]:
    """Topics of a run by name; where its vehicle cannot be read, those of the built-in sensors."""
    try:
        return {topic.name: topic for topic in topics.of(log.vehicle)}
    except UvmsError:  # a finding of its own
        return topics.BY_NAME
