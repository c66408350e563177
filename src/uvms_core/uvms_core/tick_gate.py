"""Decides when a node runs: when it has all its inputs of one stamp.

Every node is driven by data. A `TickGate` collects the stamped inputs of one node and releases a
tick when the inputs that are due at its stamp are there. In lockstep that makes a run repeatable,
whatever the order in which messages arrive; in real time the trigger alone releases the tick, with
the newest of the other inputs, so that a late node does not stop the others (it waits only for an
input that it has never received). The gate uses neither ROS nor a clock.
"""

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from uvms_core.inputs import (
    KEEP,
    Companion,
    CompanionBefore,
    Covering,
    Delayed,
    Input,
    Periodic,
    Previous,
    Same,
    held,
)

__all__ = [
    "KEEP",
    "Companion",
    "CompanionBefore",
    "Covering",
    "Delayed",
    "Input",
    "Periodic",
    "Previous",
    "Same",
    "Tick",
    "TickGate",
    "held",
]


@dataclass(frozen=True)
class Tick:
    """A stamp and the inputs that belong to it, by name.

    Attributes:
        missing: inputs that the tick lacks, since what came cannot be used and the last good value
            is too old; the part cannot step, and puts out what is safe.
    """

    stamp: int
    inputs: Mapping[str, Any]
    missing: tuple[str, ...] = ()

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
        every: only multiples of this are ticks (ns), for a trigger that is more frequent; in real
            time the trigger need not hit them.
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
        self.abandoned = 0
        self.late = 0
        self.duplicates = 0
        self.held = 0
        self._begin()

    def _begin(self) -> None:
        self._open.clear()
        self._broken = True  # no tick before: its feedback is not waited for
        self._last = -1
        self._begun = False
        self._excuses = False
        self._idle: set[int] = set()  # ticks that are safe ones in any case

    def reset(self) -> None:
        """Forget all inputs and open ticks; the counts go on."""
        for item in self._inputs.values():
            item.reset()
        self._begin()

    def push(self, name: str, stamp: int, value: Any) -> list[Tick]:
        """Take an input; returns the ticks that it completes, in order."""
        if not self._begun:
            self._listen_from(stamp)
        tick = self._tick_of(stamp) if name == self._trigger else None
        is_late = tick is not None and not self._is_new(tick)
        if not self._inputs[name].push(stamp, value):
            self.duplicates += 1
        return [] if is_late and not self._open else self._release()

    def skip(self, stamp: int, newest: Mapping[str, int]) -> list[Tick]:
        """At a stamp some samples are not what is due; returns the ticks that go on.

        Args:
            stamp: of the tick, ns.
            newest: by input, the stamp of the newest sample that has come, ns. Nothing later is
                waited for; where the trigger is among them, the tick begins without it.
        """
        if not self._begun:
            self._listen_from(stamp)
        for name, last in newest.items():
            item = self._inputs.get(name)
            if isinstance(item, Periodic):
                item.skip(stamp, last)
            elif isinstance(item, Delayed):
                if self._lockstep:  # else the newest is taken anyway
                    item.skip(stamp, last)
                    self._excuses = True
            elif isinstance(item, Same):  # whoever makes it does not know it yet
                item.excuse(stamp)
                self._excuses = True
                self._idle.add(stamp)
        if self._trigger in newest and newest[self._trigger] < stamp and stamp % self._every == 0:
            self._is_new(stamp)
        return self._release()

    def _listen_from(self, stamp: int) -> None:
        self._begun = True
        for item in self._inputs.values():
            if isinstance(item, Periodic):
                item.begin(stamp)

    def excuse(self, name: str, stamp: int) -> list[Tick]:
        """An input of this stamp came but cannot be used; returns the ticks that go on without.

        They have its last good value, unless that is too old.
        """
        tick = self._tick_of(stamp) if name == self._trigger else None
        if tick is not None and not self._is_new(tick):
            return []
        self._excuses = True
        self.held += 1
        self._inputs[name].excuse(stamp)
        return self._release()

    def _tick_of(self, stamp: int) -> int | None:
        """The tick that a trigger of this stamp begins; None where it begins none.

        A clock of its own does not hit multiples of `every`. In real time the first trigger after
        a multiple begins that tick: nothing that belongs to it comes any more.
        """
        over = stamp % self._every
        if over == 0:
            return stamp
        if self._lockstep:
            return None
        tick = stamp - over
        if self._last < 0:  # it began in the middle of a period
            self._last = tick
        return tick if tick > self._last else None

    def _is_new(self, stamp: int) -> bool:
        if stamp <= self._last:
            self.late += 1
            return False
        self._last = stamp
        self._abandon()
        self._open.append(stamp)
        return True

    @property
    def required(self) -> tuple[str, ...]:
        """Names of the inputs without which there is never a tick."""
        return tuple(
            name
            for name, item in self._inputs.items()
            if not isinstance(item, Periodic | Previous) and not item.is_companion
        )

    def waiting(self) -> list[str]:
        """Names of the inputs that the next tick waits for; the trigger where none is open."""
        if not self._open:
            return [self._trigger]
        stamp = self._open[0]
        has = self._has if self._lockstep else (lambda item, stamp: item.known(stamp))
        return [name for name, item in self._inputs.items() if not has(item, stamp)]

    def _abandon(self) -> None:
        if self._open and self._in_loop:
            self._broken = True
            self.abandoned += len(self._open)
            self._open.clear()

    def _has(self, item: Input, stamp: int) -> bool:
        return item.complete(stamp) or (self._broken and isinstance(item, Previous))

    def _release(self) -> list[Tick]:
        released = []
        while self._open and self._is_due(self._open[0]):
            stamp = self._open.popleft()
            self._idle.discard(stamp)
            self._broken = False
            missing = self._missing(stamp) if self._excuses else ()
            inputs = {name: item.take(stamp) for name, item in self._inputs.items()}
            released.append(Tick(stamp, inputs, missing))
        return released

    def _is_due(self, stamp: int) -> bool:
        """Whether a tick goes on.

        A safe one waits only for what comes from the plant: others may owe theirs to what is
        missing, but what is safe may depend on the joints.
        """
        if stamp not in self._idle:
            return self._complete(stamp)
        late = [item for item in self._inputs.values() if isinstance(item, Delayed)]
        return not self._lockstep or all(item.complete(stamp) for item in late)

    def _missing(self, stamp: int) -> tuple[str, ...]:
        return tuple(name for name, item in self._inputs.items() if item.missing(stamp))

    def _complete(self, stamp: int) -> bool:
        inputs = self._inputs.values()
        if self._lockstep:
            return all(self._has(item, stamp) for item in inputs)
        return all(item.known(stamp) for item in inputs)
