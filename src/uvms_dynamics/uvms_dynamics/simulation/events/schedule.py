"""The events of a run in the order of time."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import Any

from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_dynamics.simulation.events.event import Effects, Event
from uvms_dynamics.simulation.events.wrench import nearest_step


@dataclass(frozen=True)
class Happened:
    """An event that began or ended.

    Attributes:
        stamp: of the control tick, of a push of the plant step, ns.
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

    An event happens at the first control tick at or after its time, and acts from that tick on. A
    push begins and ends at the plant step that is nearest.

    Args:
        step: of the plant, ns.
        period: of its control ticks, ns, a multiple of the step.
    """

    def __init__(self, step: int, period: int) -> None:
        self._step, self._period = step, period
        self._heap: list[tuple[int, int, int, bool, Event]] = []
        self._count = 0

    def add(self, event: Event) -> None:
        """It will happen, and end where it does so by itself."""
        self._push(event.at_s, True, event)
        if event.ends_s is not None:
            self._push(event.ends_s, False, event)

    def _push(self, time: float, begins: bool, event: Event) -> None:
        self._count += 1
        asked = to_nanoseconds(time)
        due = -(-asked // self._period) * self._period
        if event.between_ticks:
            due = nearest_step(time, self._step)
        heappush(self._heap, (due, asked, self._count, begins, event))

    @property
    def pending(self) -> tuple[Event, ...]:
        """Events that have not begun."""
        return tuple(event for *_, begins, event in sorted(self._heap) if begins)

    def within(self, began: int, ends: int) -> list[int]:
        """Stamps, ns, strictly between two at which something happens, in order."""
        if not self._heap or self._heap[0][0] >= ends:
            return []
        return sorted({due for due, *_ in self._heap if began < due < ends})

    def run(self, stamp: int, effects: Effects) -> Iterator[Happened]:
        """Let all happen that are due at a stamp."""
        while self._heap and self._heap[0][0] <= stamp:
            _, asked, _, begins, event = heappop(self._heap)
            if begins:
                event.begin(effects)
            else:
                event.end(effects)
            text = event.text() if begins else f"{event.text()}: ends"
            yield Happened(stamp, to_seconds(asked), text)
