"""What comes into a node, from checked messages to ticks: stamps, plausibility, the gate.

Free of ROS. Whatever cannot be used is left out, counted and said; the tick it belongs to goes on
with the last good value, as long as that is not too old (`uvms_core.tick_gate.KEEP`).
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from uvms_core.errors import ImplausibleError, StampError, UvmsError
from uvms_core.plausibility import Plausibility
from uvms_core.tick_gate import KEEP, Tick, TickGate
from uvms_core.timeline import Item, Judged, Jump, Timeline
from uvms_core.topic import Topic
from uvms_core.topics import SENSOR_GAPS

UNREADABLE, IMPLAUSIBLE, JUMPS, RESETS = "unreadable", "implausible", "jumps_taken", "resets"


class Intake:
    """Judges a node's inputs one by one.

    Args:
        gate: that they go to.
        timeline: of the node.
        plausibility: of the vehicle.
        on_time_jump: called when time has jumped so far that the part must be restarted.
        sampled: topics of the sensors' samples by the sensor's name.
    """

    def __init__(
        self,
        gate: TickGate,
        timeline: Timeline,
        plausibility: Plausibility,
        on_time_jump: Callable[[Jump], None],
        sampled: Mapping[str, Topic],
    ) -> None:
        self.gate, self.timeline = gate, timeline
        self._plausibility, self._on_time_jump = plausibility, on_time_jump
        self._sampled = sampled
        self._topics: dict[str, Topic] = {}
        self._counts: Counter[str] = Counter({UNREADABLE: 0, IMPLAUSIBLE: 0, JUMPS: 0, RESETS: 0})
        self.faults: list[UvmsError] = []
        """What was refused since this was last emptied."""
        self.news: list[str] = []
        """What was taken, but must be known, since this was last emptied."""

    @property
    def counts(self) -> dict[str, int]:
        """How many inputs were not used as they came, by cause."""
        gate, stamps = self.gate, self.timeline.counts
        return {
            **self._counts,
            "ahead": stamps["ahead"],
            "back": stamps["back"] + stamps["negative"],
            "duplicates": stamps["duplicates"] + gate.duplicates,
            "late": gate.late,
            "held": gate.held,
            "abandoned_ticks": gate.abandoned,
        }

    def take(self, topic: Topic, signal: Any, wall: float) -> Iterator[Tick]:
        """The ticks that a signal completes; `wall` is monotonic time in s."""
        self._topics[topic.name] = topic
        return self._pass_on(self.timeline.judge(Item(topic.name, signal.stamp, signal), wall))

    def take_unreadable(self, topic: Topic, stamp: int | None) -> Iterator[Tick]:
        """The ticks that go on without a message that cannot be read; None: no stamp either."""
        self._counts[UNREADABLE] += 1
        if stamp is not None and self.timeline.may_be(stamp, topic.name):
            yield from self.gate.excuse(topic.name, stamp)

    def poll(self, wall: float) -> Iterator[Tick]:
        """To be called now and then: the ticks that what was held back completes."""
        return self._pass_on(self.timeline.poll(wall))

    def _pass_on(self, judged: Judged) -> Iterator[Tick]:
        if judged.jump is not None:
            self._jump(judged.jump)
        if self.timeline.refusals:
            self.faults += [StampError(text) for text in self.timeline.refusals]
            self.timeline.refusals.clear()
        for item in judged.items:
            yield from self._hand_over(item)

    def _hand_over(self, item: Item) -> list[Tick]:
        if item.name == SENSOR_GAPS.name:
            gaps = item.content
            named = zip(gaps.sensors, gaps.newest, strict=True)
            newest = {self._sampled[name].name: at for name, at in named if name in self._sampled}
            return self.gate.skip(gaps.stamp, newest)
        try:
            news = self._plausibility.admit(self._topics[item.name], item.content)
        except ImplausibleError as fault:
            self._counts[IMPLAUSIBLE] += 1
            self.faults.append(fault)
            return self.gate.excuse(item.name, item.stamp)
        if news is not None:
            self._counts[JUMPS] += 1
            self.news.append(news)
        return self.gate.push(item.name, item.stamp, item.content)

    def _jump(self, jump: Jump) -> None:
        if not jump.is_back and jump.after - jump.before <= KEEP:
            return
        self._counts[RESETS] += 1
        self.news.append(f"{jump}; restarting")
        self.gate.reset()
        self._plausibility.reset()
        self._on_time_jump(jump)
