"""The samples in a log, decoded and in the order in which they reach the filter."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import replace
from heapq import merge
from typing import Any, Literal, NamedTuple

import numpy as np

from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.read import RunLog
from uvms_bringup.navigate.arrivals import Arrivals
from uvms_bringup.navigate.bag import Bag, Raw
from uvms_bringup.navigate.clocks import check_one_clock, check_one_way
from uvms_bringup.navigate.topic_map import TopicMap
from uvms_core import topics
from uvms_core.checks import check
from uvms_core.errors import SignalError
from uvms_core.messages import from_message
from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.topic import WORLD_FRAME, Topic
from uvms_core.vehicle import Vehicle
from uvms_observer.arrivals import used_sensors

Stamps = Literal["header", "log"]
"""Which time of a message is that of its measurement."""
ASTRAY = to_nanoseconds(60.0)
"""A stamp that is farther from the time of recording than its topic's usually are is no stamp, ns:
no transport takes a minute."""
HEADER, LOG = "header", "log"


class Sample(NamedTuple):
    """A measurement and when it reaches the filter."""

    arrival: int  # ns
    topic: Topic
    signal: Any


class Feed:
    """Samples of a log by their arrival.

    Those of a log of this system arrive as they did in the run, of any other log at their stamps:
    how late a message was recorded says nothing about its measurement.

    Args:
        bag: the log.
        wanted: its topics.
        vehicle: that has the sensors.
        period: of the control loop of the recorded run, ns.
        stamps: which time of a message counts.
    """

    def __init__(
        self, bag: Bag, wanted: TopicMap, vehicle: Vehicle, period: int, stamps: Stamps
    ) -> None:
        self._stamps = stamps
        self.unreadable: Counter[str] = Counter()
        """Messages that are no valid samples, by topic."""
        self.first_fault: dict[str, str] = {}
        """What was wrong with the first one of each topic."""
        self._readers: dict[str, Callable[[bytes], Any]] = {}
        self._topics: dict[str, Topic] = {}
        self._of_world: set[str] = set()
        for sensor in used_sensors(vehicle):
            if (name := wanted.sensors.get(sensor.name)) is not None:
                self._topics[name], self._readers[name] = sensor.topic, bag.decoder(name)
                if sensor.type.frame == WORLD_FRAME:
                    self._of_world.add(name)
        arrivals = Arrivals(bag.run) if bag.run is not None and bag.is_ours else None
        self._raw = self._in_order(list(bag.messages(list(self._topics))), arrivals, period)
        self._thrusts = _thrusts(bag.run) if bag.run is not None and bag.is_ours else []

    def _in_order(
        self, messages: list[Raw], arrivals: Arrivals | None, period: int
    ) -> list[tuple[int, int, Raw]]:
        """Arrival, stamp and message."""
        stamped = [(self._stamp(one), one) for one in messages]
        for topic in self._topics:
            check_one_way(topic, [s for s, one in stamped if one.topic == topic and s is not None])
        good = self._of_one_clock([(s, one) for s, one in stamped if s is not None])
        found = []
        for stamp, one in good:
            tick = -(-stamp // period) * period
            arrival = stamp if arrivals is None else arrivals(one.topic, stamp, tick)
            found.append((arrival, stamp, one))
        return sorted(found, key=lambda each: each[0])

    def _stamp(self, one: Raw) -> int | None:
        stamp = one.logged if self._stamps == LOG else one.stamp
        if stamp is None:
            self._refuse(one.topic, "it has no valid stamp")
        return stamp

    def _of_one_clock(self, stamped: list[tuple[int, Raw]]) -> list[tuple[int, Raw]]:
        """Without stamps that are astray.

        Raises:
            ClockError: those of a whole topic are on another clock than those of the first, or go
                back and stay there.
        """
        delays: dict[str, list[int]] = {}
        for stamp, one in stamped:
            delays.setdefault(one.topic, []).append(one.logged - stamp)
        usual = {topic: int(np.median(each)) for topic, each in delays.items()}
        check_one_clock(usual, ASTRAY)
        good = []
        for stamp, one in stamped:
            if abs(one.logged - stamp - usual[one.topic]) > ASTRAY:
                self._refuse(one.topic, f"its stamp {to_seconds(stamp):.3f} s is astray")
            else:
                good.append((stamp, one))
        return good

    @property
    def span(self) -> tuple[int, int]:
        """First and last arrival, ns; zeros where there is no sample."""
        return (self._raw[0][0], self._raw[-1][0]) if self._raw else (0, 0)

    def samples(self) -> Iterator[Sample]:
        """All that are valid, in order, and the thrusts of a run of ours."""
        return merge(self._measured(), self._thrusts, key=lambda each: each.arrival)

    def _measured(self) -> Iterator[Sample]:
        for arrival, stamp, one in self._raw:
            topic = self._topics[one.topic]
            try:
                message = self._readers[one.topic](one.data)
                framed = topic if one.topic in self._of_world else _framed(topic, message)
                signal = from_message(framed, message)
                if self._stamps == LOG:
                    signal = replace(signal, stamp=stamp)
                    check(topic.name, signal)
            except UNDECODABLE as fault:
                self._refuse(one.topic, str(fault))
                continue
            yield Sample(arrival, topic, signal)

    def _refuse(self, topic: str, why: str) -> None:
        self.unreadable[topic] += 1
        self.first_fault.setdefault(topic, why)


def _thrusts(run: RunLog) -> list[Sample]:
    """What the allocator commanded in a run; another system's commands are not known."""
    if not run.has(topics.ALLOCATION):
        return []
    return [Sample(each.stamp, topics.ALLOCATION, each) for each in run.signals(topics.ALLOCATION)]


def _framed(topic: Topic, message: Any) -> Topic:
    """The topic of a mounted sensor with the message's own frame id.

    What is fed to the filter has been chosen by hand; the vehicle file says how it is mounted. A
    frame of the world says which axes its numbers have, and is checked.
    """
    try:
        return replace(topic, frame=message.header.frame_id)
    except AttributeError as fault:
        raise SignalError(f"{topic.name}: has no header") from fault
