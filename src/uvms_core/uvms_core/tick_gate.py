"""Decides when a node runs: when it has all its inputs of one stamp.

Every node is driven by data. A `TickGate` collects the stamped inputs of one node and releases a
tick when the inputs that are due at its stamp are there. In lockstep that makes a run repeatable,
whatever the order in which messages arrive; in real time the trigger alone releases the tick, with
the newest of the other inputs, so that a late node does not stop the others (it waits only for an
input that it has never received). The gate uses neither ROS nor a clock.
"""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

DEPTH = 256
"""Samples an input keeps while it waits: 2.5 s of a 100 Hz sensor."""


class Input(ABC):
    """One stamped input; the subclasses define when it is complete for a tick."""

    def __init__(self) -> None:
        self._items: deque[tuple[int, Any]] = deque(maxlen=DEPTH)

    def push(self, stamp: int, value: Any) -> None:
        """Store a value; stamps of one input come in order."""
        self._items.append((stamp, value))

    def newest(self, stamp: int) -> Any:
        """The newest value at or before the stamp, or None."""
        if self._items and self._items[-1][0] <= stamp:  # the usual case, which is quick
            return self._items[-1][1]
        return next((value for when, value in reversed(self._items) if when <= stamp), None)

    @abstractmethod
    def complete(self, stamp: int) -> bool:
        """Whether everything due at the stamp has arrived."""

    def known(self, stamp: int) -> bool:
        """Whether there is a value to use, even an old one."""
        return self.newest(stamp) is not None

    def take(self, stamp: int) -> Any:
        """The value for the tick; older ones are dropped."""
        items, value = self._items, self.newest(stamp)
        while len(items) > 1 and items[1][0] <= stamp:
            items.popleft()
        return value


class Same(Input):
    """Arrives once per tick, with the stamp of the tick."""

    def complete(self, stamp: int) -> bool:
        """Whether the value of exactly this stamp has arrived."""
        return any(when == stamp for when, _ in self._items)


class Previous(Input):
    """Feedback from the previous tick, `period` nanoseconds ago."""

    def __init__(self, period: int) -> None:
        super().__init__()
        self._period = period

    def complete(self, stamp: int) -> bool:
        """Whether the value of the previous tick has arrived."""
        return any(when == stamp - self._period for when, _ in self._items)

    def known(self, stamp: int) -> bool:
        """Always: at the first tick there is none."""
        return True

    def take(self, stamp: int) -> Any:
        """The newest value before the tick, None at the first."""
        return super().take(stamp - 1)


class Periodic(Input):
    """A sensor at its own rate, due at multiples of `period`: all samples since the last tick."""

    def __init__(self, period: int) -> None:
        super().__init__()
        self._period = period
        self._taken = -1

    def complete(self, stamp: int) -> bool:
        """Whether the sample that is due at or before the stamp has arrived."""
        due = stamp - stamp % self._period
        return due <= self._taken or (bool(self._items) and self._items[-1][0] >= due)

    def known(self, stamp: int) -> bool:
        """Always: a silent sensor does not stop the node."""
        return True

    def take(self, stamp: int) -> tuple[Any, ...]:
        """All samples since the last tick, in order."""
        samples = []
        while self._items and self._items[0][0] <= stamp:
            self._taken, value = self._items.popleft()
            samples.append(value)
        return tuple(samples)


class Covering(Input):
    """A value that holds for a time (`value.end`): the newest with stamp <= tick < end."""

    def complete(self, stamp: int) -> bool:
        """Whether a value covers the stamp."""
        return any(when <= stamp < value.end for when, value in self._items)


@dataclass(frozen=True)
class Tick:
    """A stamp and the inputs that belong to it, by name."""

    stamp: int
    inputs: Mapping[str, Any]

    def __getitem__(self, name: str) -> Any:
        return self.inputs[name]


class TickGate:
    """Releases ticks of a node.

    Args:
        inputs: the node's inputs by name.
        trigger: the input whose stamps are the ticks.
        lockstep: wait for all inputs of the stamp (True), or use the newest (False).
        in_loop: the plant waits for this node's answer, so a newer trigger means that the plant
            timed out on the older tick. A node outside the loop keeps its open ticks instead.
        every: only stamps at multiples of this are ticks (ns), for a trigger that is more frequent.
    """

    def __init__(
        self,
        inputs: Mapping[str, Input],
        trigger: str,
        lockstep: bool,
        in_loop: bool = True,
        every: int = 1,
    ) -> None:
        self._inputs = dict(inputs)
        self._trigger = trigger
        self._lockstep = lockstep
        self._in_loop = in_loop
        self._every = every
        self._open: deque[int] = deque()
        self._broken = True  # no tick before: its feedback is not waited for
        self._last = -1
        self.abandoned = 0
        self.late = 0

    def push(self, name: str, stamp: int, value: Any) -> list[Tick]:
        """Take an input; returns the ticks that it completes, in order."""
        if name == self._trigger and stamp % self._every == 0:
            if stamp <= self._last:
                self.late += 1
                return []
            self._last = stamp
            self._abandon()
            self._open.append(stamp)
        self._inputs[name].push(stamp, value)
        return self._release()

    def _abandon(self) -> None:
        if self._open and self._in_loop:
            self._broken = True
            self.abandoned += len(self._open)
            self._open.clear()

    def _has(self, item: Input, stamp: int) -> bool:
        return item.complete(stamp) or (self._broken and isinstance(item, Previous))

    def _release(self) -> list[Tick]:
        released = []
        while self._open and self._complete(self._open[0]):
            stamp = self._open.popleft()
            self._broken = False
            inputs = {name: item.take(stamp) for name, item in self._inputs.items()}
            released.append(Tick(stamp, inputs))
        return released

    def _complete(self, stamp: int) -> bool:
        inputs = self._inputs.values()
        if self._lockstep:
            return all(self._has(item, stamp) for item in inputs)
        return all(item.known(stamp) for item in inputs)
