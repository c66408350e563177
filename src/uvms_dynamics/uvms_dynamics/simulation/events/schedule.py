"""The events of a run in the order of time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Any

from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_dynamics.simulation.events.event import Effects, Event


@dataclass(frozen=True)
class Happened:
    """An event that began or ended.

    Attributes:
        stamp: of the control tick, ns.
        asked_s: when it was asked for, s.
        text: in words.
    """

    stamp: int
    asked_s: float
    text: str


def status_values(happened: Sequence[Happened]) -> dict[str, Any]:
    """Values of a status that tells of events of one tick: `event_1`, `event_2`, ... and when."""
    texts = {f"event_{k}": event.text for k, event in enumerate(happened, start=1)}
    return {"event_at_s": to_seconds(happened[0].stamp), **texts}


class Schedule:
    """Events that are still to come. Those of one instant happen in the order in which they came.

    An event happens at the first control tick at or after its time, and acts from that tick on.
    """

    def __init__(self) -> None:
        self._heap: list[tuple[int, int, bool, Event]] = []
        self._count = 0

    def add(self, event: Event) -> None:
        """It will happen, and end where it does so by itself."""
        self._push(event.at_s, True, event)
        if event.ends_s is not None:
            self._push(event.ends_s, False, event)

    def _push(self, time: float, begins: bool, event: Event) -> None:
        self._count += 1
        heappush(self._heap, (to_nanoseconds(time), self._count, begins, event))

    @property
    def pending(self) -> tuple[Event, ...]:
        """Events that have not begun."""
        return tuple(event for _, _, begins, event in sorted(self._heap[:]) if begins)

    def run(self, stamp: int, effects: Effects) -> Iterator[Happened]:
        """Let all happen that are due at a tick."""
        while self._heap and self._heap[0][0] <= stamp:
            due, _, begins, event = heappop(self._heap)
            if begins:
                event.begin(effects)
            else:
                event.end(effects)
            text = event.text() if begins else f"{event.text()}: ends"
            yield Happened(stamp, to_seconds(due), text)
