"""Everything that the checks look at, gathered in one pass over a log."""

import zlib
from array import array
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.errors import LogError
from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_core import topics
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
        self._readers = {
            name: reader for name in self.topics if (reader := self._reader(name)) is not None
        }
        for name, entry in log.entries():
            self._take(name, self.topics[name], entry.stamp, entry.data)

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
        return bool(self.log.run)

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
        topic = topics.BY_NAME.get(name) or topics.BY_NAME.get(short)
        if topic is None or topic.signal is None or topic is topics.TF:  # which is only written
            return None
        try:
            return topic, log.decoder(topic)
        except LogError as fault:
            self.unusable[name] = str(fault).removeprefix(f"log {log.path}: {name}").lstrip(": ")
            return None

    def _take(self, name: str, found: Topics, stamp: int, data: bytes) -> None:
        found.stamps.append(min(stamp, 2**63 - 1))
        found.checksums.append(zlib.crc32(data))
        if name not in self._readers:
            return
        topic, decode = self._readers[name]
        try:
            signal = from_message(topic, decode(data))
        except UNDECODABLE as fault:
            found.rejected.append(f"{stamp / NANOSECONDS:.3f} s: {fault}")
            return
        if topic not in NOT_STAMPED:
            own = signal if isinstance(signal, int) else signal.stamp
            found.moved += own != stamp
